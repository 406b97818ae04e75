"""Between the XML and the scene: elements with their names, frames and files, before any pose is resolved."""

from __future__ import annotations

from dataclasses import dataclass, field

from simkit.diagnostics import Where
from simkit.loaders.sdf.frames import Frame, Scope, base_of
from simkit.loaders.sdf.workspace import SdfFile
from simkit.params import Params
from simkit.pose import IDENTITY, Pose


@dataclass(frozen=True)
class Part:
    """One named element of a model: `scope` is where the names it uses are looked up."""

    name: str
    element: Params
    frame: Frame
    scope: Scope
    file: SdfFile


@dataclass(frozen=True)
class Source:
    """A model or light, written in place or included.

    Attributes:
        pose, relative_to: where it stands, as written by whoever has the last word.
        static: forced by an include; None where it says nothing.
        placement: frame of the model that the pose speaks of; empty for the model frame.
        plugins: those that the include adds.
        merge: whether its content becomes part of the including model.
        where: the place of the model, or of the include.
        pose_where: the place of its pose.
    """

    name: str
    element: Params
    file: SdfFile
    pose: Pose = IDENTITY
    relative_to: str = ""
    static: bool | None = None
    placement: str = ""
    plugins: tuple[Params, ...] = ()
    merge: bool = False
    where: Where = field(default_factory=Where)
    pose_where: Where | None = None


@dataclass
class Draft:
    """A model whose names are known and whose poses are not resolved yet.

    Attributes:
        saved_links: what a saved state of the world says of its links.
    """

    source: Source
    scoped: str
    frame: Frame
    scope: Scope
    links: list[Part] = field(default_factory=list)
    joints: list[Part] = field(default_factory=list)
    frames: list[Part] = field(default_factory=list)
    proxies: list[Frame] = field(default_factory=list)
    merged: list[Scope] = field(default_factory=list)
    models: list[Draft] = field(default_factory=list)
    plugins: list[Params] = field(default_factory=list)
    saved_links: list[Params] = field(default_factory=list)


def read_pose(element: Params, name: str = "pose") -> tuple[Pose, str]:
    """The `<pose>` of an element and the frame it speaks of (empty for the default)."""
    return element.pose(name), base_of(element.child(name))


def pose_place(element: Params) -> Where:
    """The line of an element's pose, or its own."""
    pose = element.child("pose")
    return element.where if pose is None else pose.where


def local_pose(element: Params, scope: Scope, owner: Frame, what: str) -> Pose:
    """The pose of something inside a link (or joint) in that link's frame; `relative_to` may name another frame."""
    pose, base = read_pose(element)
    if not base:
        return pose
    frames = scope.chain(base)
    if frames is None:
        scope.unknown(base, f"{what}: the frame", pose_place(element))
        return pose
    return scope.resolve(owner).inverse() @ scope.pose_of(base) @ pose

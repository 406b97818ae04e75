"""Models that MuJoCo's own format describes: beside what the scene says of them, the specification itself is kept."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from simkit.pose import IDENTITY, Pose

Mass = tuple[float, tuple[float, ...], tuple[float, ...], tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class MjcfGeom:
    """Whose geom it is, and what for.

    Attributes:
        link: scoped name of its link.
        shape: scoped name of the collision, or of the visual where it only shows.
        collides, drawn: what it does; a geom may do both, or neither (it then only weighs).
    """

    link: str
    shape: str
    collides: bool
    drawn: bool


@dataclass(frozen=True, slots=True, eq=False)
class MjcfElements:
    """Which of the file's elements are which of the scene's.

    Attributes:
        bodies: scoped link -> body; `world` for the link that holds what the file has in its world body.
        joints: scoped joint -> joint; empty for a fixed one.
        free: scoped link -> free joint.
        geoms: geom -> its owner.
        lights: scoped light -> (light, its link or empty).
        masses: body -> mass [kg], centre of mass [m], axes of inertia as a quaternion, principal moments [kg·m²].
    """

    bodies: dict[str, str] = field(default_factory=dict)
    joints: dict[str, str] = field(default_factory=dict)
    free: dict[str, str] = field(default_factory=dict)
    geoms: dict[str, MjcfGeom] = field(default_factory=dict)
    lights: dict[str, tuple[str, str]] = field(default_factory=dict)
    masses: dict[str, Mass] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MjcfSource(MjcfElements):
    """Where the engine's own description of a model is, and which of its elements are which of the scene's.

    Attributes:
        document: makes a fresh specification of the whole file (an `mujoco.MjSpec`) in which every element has a name.
        place: where the file's world stands in the world at load time.
        prefix: of all names in the compiled world; empty for a file that is the world itself.
        roots: names of the top-level bodies that are this model's, as in the file.
        base: "auto" keeps the free joints of the file, "fixed" takes them away, "floating" adds what is missing.
        settings: what the file says of the engine itself, by element (`option`, `visual`, ...), with its line.
    """

    document: Callable[[], Any]
    place: Pose = IDENTITY
    prefix: str = ""
    roots: tuple[str, ...] = ()
    base: str = "auto"
    settings: Mapping[str, Any] = field(default_factory=dict)

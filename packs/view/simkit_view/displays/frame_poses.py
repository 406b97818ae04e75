"""Poses in the world of the frames that messages name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from simkit import Pose
from simkit.errors import TransformError
from simkit.msgs.transform_tree import TransformTree
from simkit.pose import IDENTITY

if TYPE_CHECKING:
    from simkit import Simulation

_ROOTS: Final = ("world", "map")  # frames at the origin of the world, as for maps of `simkit map` and for goals
_ROOT_TRANSFORMS: Final = 64  # transforms between a frame and its root; more are a circle


@dataclass(frozen=True, slots=True)
class Placement:
    """Pose in the frame of a link.

    Attributes:
        link: scoped name of the link; empty for the world.
        pose: pose in the frame of the link.
    """

    link: str = ""
    pose: Pose = IDENTITY


class FramePoses:
    """Poses of frames in the world: of links and sensors, and of the frames that transforms connect with these.

    A frame such as `odom` lies where its transform to a link puts it, with the true pose of the link.

    Args:
        sim: simulation with the links.
        tree: transforms.
        aliases: scoped names of links by further frames; its content may change.
    """

    def __init__(self, sim: Simulation, tree: TransformTree, aliases: Mapping[str, str] | None = None) -> None:
        self._sim, self._tree = sim, tree
        self._aliases: Mapping[str, str] = {} if aliases is None else aliases
        self._model: object = None
        self._links: dict[str, str] = {}
        self._sensors: dict[str, tuple[Any, Pose]] = {}

    def find(self, frame: str) -> Placement | None:
        """Return the link of a frame and the frame's pose in it; None if the frame is unknown."""
        self._list_frames()
        name = frame.strip("/")
        if name in self._sensors:
            sensor, offset = self._sensors[name]
            link = sensor.scene.parent
            return Placement(link, self.link_pose(link).inverse() @ sensor.pose @ offset) if link else None
        if (link := self._link_of(name)) is not None:
            return Placement(link)
        if name in _ROOTS or name == self._sim.world.name:
            return Placement()
        try:
            return self._find_by_transforms(name)
        except TransformError:
            return None

    def pose(self, frame: str) -> Pose | None:
        """Return the present pose of a frame in the world; None if the frame is unknown."""
        frame_pose = self.find(frame)
        return None if frame_pose is None else self.pose_of(frame_pose)

    def pose_of(self, placement: Placement) -> Pose:
        """Return the present pose of a placement in the world."""
        return self.link_pose(placement.link) @ placement.pose if placement.link else placement.pose

    def link_pose(self, scoped: str) -> Pose:
        """Return the present pose of a link in the world; that of the world for a link that was removed."""
        link = self._sim.contents.handles.tables["link"].get(scoped)
        return IDENTITY if link is None else link.pose

    def _link_of(self, name: str) -> str | None:
        return self._links.get(name) or self._aliases.get(name)

    def _find_by_transforms(self, name: str) -> Placement | None:
        """Return the placement of a frame by the nearest link that transforms connect with it."""
        parents = self._tree.frames()
        if name not in parents:
            return None
        ancestors = _ancestors(name, parents)
        best: tuple[int, str, str] | None = None
        for other in parents:
            link = self._link_of(other)
            if link is None and other not in _ROOTS:
                continue
            way = _ancestors(other, parents)
            common = next((ancestor for ancestor in way if ancestor in ancestors), None)
            if common is not None:
                length = way.index(common) + ancestors.index(common)
                if best is None or length < best[0]:
                    best = length, other, link or ""
        if best is None:
            return None
        return Placement(best[2], self._tree.latest(best[1], name)[0])

    def _list_frames(self) -> None:
        """List the frames of links and sensors, if the structure has changed."""
        sim = self._sim
        if sim.mj_model is self._model:
            return
        self._model, self._links, self._sensors = sim.mj_model, {}, {}
        for scoped in sim.contents.handles.tables["link"]:
            model, _, last = scoped.split("::", 1)[0], "", scoped.rpartition("::")[2]
            for name in (scoped, scoped.replace("::", "/"), last, f"{model}/{last}"):
                self._links.setdefault(name, scoped)
        for sensor in sim.contents.sensors.values():
            for name, offset in sensor.optical_frames().items():
                self._sensors.setdefault(name.strip("/"), (sensor, offset))
            name = str(sensor.frame_id).strip("/")
            if name not in self._links:
                self._sensors.setdefault(name, (sensor, IDENTITY))


def _ancestors(name: str, parents: Mapping[str, str]) -> list[str]:
    """Return a frame and its ancestors up to the root."""
    names = [name]
    while (name := parents.get(name, "")) and len(names) < _ROOT_TRANSFORMS:
        names.append(name)
    return names

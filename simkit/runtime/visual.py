"""Handle of a visual."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.pose import Pose
from simkit.runtime.handles import Handle

if TYPE_CHECKING:
    from simkit.runtime.link import Link
    from simkit.runtime.simulation import Simulation
    from simkit.scene import SceneVisual


class Visual(Handle):
    """What is drawn of a link for one `<visual>` of the file.

    Attributes:
        scene: as the file has it.
        link: that carries it.
    """

    def __init__(self, sim: Simulation, scene: SceneVisual, link: Link) -> None:
        super().__init__(sim, scene.name, scene.scoped)
        self.scene, self.link = scene, link

    def __repr__(self) -> str:
        return f"<Visual {self.scoped!r}{'' if self.link._there else ' (removed)'}>"

    @property
    def geoms(self) -> tuple[int, ...]:
        """Ids of the engine's geoms that draw it, in the present model; none for a shape that is not drawn."""
        self.link._check()
        drawn: dict[str, tuple[int, ...]] = self._sim.names.drawn(self.link.scoped)
        return drawn.get(self.scoped, ())

    @property
    def pose(self) -> Pose:
        """Pose of the visual's frame in the world."""
        return self.link.pose @ self.scene.pose_link

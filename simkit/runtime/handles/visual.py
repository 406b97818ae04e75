"""Handle of a visual."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.pose import Pose
from simkit.runtime.handles.handle import Handle

if TYPE_CHECKING:
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.runtime.handles.link import Link
    from simkit.scene import SceneVisual


class Visual(Handle):
    """What is drawn of a link for one `<visual>` of the file.

    Attributes:
        scene: as the file has it.
        link: that carries it.
    """

    def __init__(self, handles: EntityHandles, scene: SceneVisual, link: Link) -> None:
        super().__init__(handles, scene.name, scene.scoped)
        self.scene, self.link = scene, link

    def __repr__(self) -> str:
        return f"<Visual {self.scoped!r}{'' if self.link._is_present else ' (removed)'}>"

    @property
    def geoms(self) -> tuple[int, ...]:
        """Ids of the engine's geoms that draw it, in the present model; none for a shape that is not drawn."""
        self.link._check()
        drawn: dict[str, tuple[int, ...]] = self._engine.names.drawn(self.link.scoped)
        return drawn.get(self.scoped, ())

    def set_colour(self, red: float, green: float, blue: float, alpha: float = 1.0) -> None:
        """Paints it, each part from 0 to 1; what it is made of (gloss, glow, a picture it wears) stays."""
        parts = [min(1.0, max(0.0, float(part))) for part in (red, green, blue, alpha)]
        if parts == [0.5, 0.5, 0.5, 1.0]:
            parts[0] = 0.5001  # exactly MuJoCo's default would be taken for "not given"
        geoms = list(self.geoms)
        if geoms:
            self._engine.touch("geom_rgba")[geoms] = parts

    @property
    def pose(self) -> Pose:
        """Pose of the visual's frame in the world."""
        return self.link.pose @ self.scene.pose_link

"""Handle of a light."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.pose import Pose, Vector
from simkit.runtime.handles import Handle

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation
    from simkit.scene import SceneLight


class Light(Handle):
    """A light of the world or on a link."""

    def __init__(self, sim: Simulation, scene: SceneLight) -> None:
        super().__init__(sim, scene.name, scene.scoped)
        self.scene = scene
        self._pose = scene.pose_world
        if scene.link:
            self._pose = sim.scene_link(scene.link).pose_world.inverse() @ scene.pose_world

    @property
    def pose(self) -> Pose:
        """Pose in the world."""
        self._check()
        return self._sim.link(self.scene.link).pose @ self._pose if self.scene.link else self._pose

    def set_pose(self, pose: Pose) -> None:
        """Moves the light; its direction turns with it."""
        self._check()
        self._pose = self._sim.link(self.scene.link).pose.inverse() @ pose if self.scene.link else pose
        self._sim.place_light(self)

    @property
    def direction(self) -> Vector:
        """Unit vector along which it shines, world frame, shape (3,)."""
        return self.pose.rotate(self.scene.direction)

    def get_state(self) -> Pose:
        return self._pose

    def set_state(self, state: Pose) -> None:
        self._pose = state
        self._sim.place_light(self)

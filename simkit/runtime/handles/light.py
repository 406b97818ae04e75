"""Handle of a light."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import mujoco

from simkit.compiler.lights import drawn_fields, drawn_position
from simkit.pose import IDENTITY, Pose, Vector
from simkit.runtime.handles.handle import Handle

if TYPE_CHECKING:
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.scene import SceneLight


@dataclass(frozen=True, slots=True)
class LightState:
    """How a light stands and shines at one time.

    Attributes:
        pose: in the world, or in the frame of the link that carries it.
        on: whether it shines.
        irradiance: of a surface that faces it [W/m²]; None where nothing says it.
    """

    pose: Pose
    on: bool = True
    irradiance: float | None = None


LightCourse = Callable[[int], LightState]
"""How a light stands and shines at a simulated time [ns]."""


@dataclass(frozen=True, slots=True)
class LightMotion:
    """What makes a light stand where it stands: a course of the time, or else a state that stays."""

    state: LightState
    course: LightCourse | None = None

    def at(self, time_ns: int) -> LightState:
        """How the light stands and shines at a time [ns]."""
        return self.state if self.course is None else self.course(time_ns)


class Light(Handle):
    """A light of the world or on a link.

    Attributes:
        scene: what it is like: as the file has it, or as it was changed since.
        motion: what makes it stand where it stands; another object whenever that changes.
    """

    def __init__(self, handles: EntityHandles, scene: SceneLight) -> None:
        super().__init__(handles, scene.name, scene.scoped)
        self.scene = scene
        pose = scene.pose_world
        if scene.link:
            pose = handles.scene_link(scene.link).pose_world.inverse() @ pose
        self.motion = LightMotion(LightState(pose, scene.on, scene.irradiance))

    @property
    def state(self) -> LightState:
        """How it stands and shines now."""
        return self.motion.at(self._engine.time_ns)

    @property
    def pose(self) -> Pose:
        """Pose in the world."""
        self._check()
        pose = self.state.pose
        return self._handles.link(self.scene.link).pose @ pose if self.scene.link else pose

    def set_pose(self, pose: Pose) -> None:
        """Moves the light; its direction turns with it. What moved it before (a sun's course) has no say any more."""
        self._check()
        own = self._handles.link(self.scene.link).pose.inverse() @ pose if self.scene.link else pose
        self.motion = LightMotion(replace(self.state, pose=own))
        self.draw()

    @property
    def direction(self) -> Vector:
        """Unit vector along which it shines, world frame, shape (3,)."""
        return self.pose.rotate(self.scene.direction)

    @property
    def on(self) -> bool:
        """Whether it shines."""
        return self.state.on

    @property
    def irradiance(self) -> float | None:
        """Of a surface that faces it [W/m²], of a lamp at 1 m; None where nothing says it."""
        return self.state.irradiance

    def follow(self, course: LightCourse) -> None:
        """Lets `course(time_ns)`, which may depend on nothing but the time, say how it stands and shines."""
        self._check()
        self.motion = LightMotion(self.state, course)
        self.draw()

    def change(self, scene: SceneLight) -> None:
        """Makes it shine as another description says: colours, fading, cone, direction, shadows; its place stays."""
        self._check()
        for sensor in self._engine.structure.all_sensors():
            sensor.take_held()  # what waits to be looked at was lit by the old one
        self.scene = scene
        self._redraw()
        self.draw()

    def switch(self, on: bool) -> None:
        """Lets it shine or not; where a course says so (a sun's), that has no say any more."""
        self._check()
        self.motion = LightMotion(replace(self.state, on=on))
        self.draw()

    def draw(self) -> None:
        """Writes to MuJoCo's model where the light stands and whether it shines; one far away is drawn from nearer."""
        engine, model = self._engine, self._physics.model
        index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_LIGHT, self.scoped)
        if index >= 0:
            carrier, state = engine.names.links.get(self.scene.link), self.state
            pose = (carrier.offset if carrier else IDENTITY) @ state.pose
            engine.touch("light_pos")[index] = drawn_position(self.scene, pose.position)
            engine.touch("light_dir")[index] = pose.rotate(self.scene.direction)
            if bool(model.light_active[index]) != state.on:
                engine.touch("light_active")[index] = state.on
        self._physics.changed_lights()

    def _redraw(self) -> None:
        """Writes to MuJoCo's model what the compiler would have made of the light as it is described now."""
        index = mujoco.mj_name2id(self._physics.model, mujoco.mjtObj.mjOBJ_LIGHT, self.scoped)
        if index >= 0:
            for field, value in drawn_fields(self.scene, self._engine.world.surroundings.shadows).items():
                self._engine.touch(f"light_{field}")[index] = value

    def get_state(self) -> tuple[LightMotion, SceneLight]:
        return self.motion, self.scene

    def set_state(self, state: tuple[LightMotion, SceneLight]) -> None:
        is_another = state[1] is not self.scene
        self.motion, self.scene = state
        if is_another:
            self._redraw()
        self.draw()

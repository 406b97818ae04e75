"""Handle of a light."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import mujoco

from simkit.argument_checks import check_kind, checked_number, checked_vector, wrong_value
from simkit.compiler.lights import drawn_fields, drawn_position
from simkit.pose import IDENTITY, Pose, Vector, checked_pose
from simkit.runtime.handles.handle import Handle

if TYPE_CHECKING:
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.scene import SceneLight
    from simkit.scene.model import Colour


@dataclass(frozen=True, slots=True)
class LightState:
    """Pose and brightness of a light at one time.

    Attributes:
        pose: pose in the world, or in the frame of the link that carries the light.
        on: True while the light shines.
        irradiance: irradiance of a surface that faces the light [W/m²]; None if not specified.
    """

    pose: Pose
    on: bool = True
    irradiance: float | None = None


LightCourse = Callable[[int], LightState]
"""Function that returns the state of a light at a simulated time [ns]."""


@dataclass(frozen=True, slots=True)
class LightMotion:
    """Motion of a light: a function of time, or a constant state."""

    state: LightState
    course: LightCourse | None = None

    def at(self, time_ns: int) -> LightState:
        """Return the state of the light at a time [ns]."""
        return self.state if self.course is None else self.course(time_ns)


def _checked_colour(colour: object, name: str) -> Colour:
    """Return red, green, blue and alpha from 0 to 1; alpha is 1 if three numbers are given."""
    count = 3 if isinstance(colour, Sequence) and len(colour) == 3 else 4
    r, g, b, a = (*checked_vector(colour, name, count).tolist(), 1.0)[:4]
    if not all(0.0 <= part <= 1.0 for part in (r, g, b, a)):
        raise wrong_value(name, "numbers from 0 to 1", colour)
    return r, g, b, a


_DRAWN_FIELDS: Final = frozenset({"light_pos", "light_dir", "light_active"})
"""Fields of MuJoCo's model that `Light.draw` writes."""


class Light(Handle):
    """Light of the world or on a link.

    Attributes:
        scene: description of the light, with the changes made during the run.
        motion: motion of the light; replaced by another object with every change.
    """

    _internal_names = Handle._internal_names | {"change", "draw", "get_state", "replace_scene", "set_state"}

    def __init__(self, handles: EntityHandles, scene: SceneLight) -> None:
        super().__init__(handles, scene.name, scene.scoped)
        self.scene = scene
        pose = scene.pose_world
        if scene.link:
            pose = handles.scene_link(scene.link).pose_world.inverse() @ pose
        self.motion = LightMotion(LightState(pose, scene.on, scene.irradiance))

    @property
    def state(self) -> LightState:
        """Present state."""
        self.check_present()
        return self.motion.at(self._engine.time_ns)

    @property
    def pose(self) -> Pose:
        """Pose in the world."""
        self.check_present()
        pose = self.state.pose
        return self._handles.link(self.scene.link).pose @ pose if self.scene.link else pose

    def set_pose(self, pose: Pose) -> None:
        """Move the light and its direction. The pose replaces an earlier motion, for example that of a sun."""
        self.check_present()
        pose = checked_pose(pose)
        pose_in_link = self._handles.link(self.scene.link).pose.inverse() @ pose if self.scene.link else pose
        self.motion = LightMotion(replace(self.state, pose=pose_in_link))
        self.draw()

    @property
    def direction(self) -> Vector:
        """Unit vector of the light's direction, world frame, shape (3,)."""
        return self.pose.rotate(self.scene.direction)

    @property
    def on(self) -> bool:
        """True while the light shines; settable."""
        return self.state.on

    @on.setter
    def on(self, on: bool) -> None:
        self.switch(on)
        self._engine.numbers.keep("light", self.scoped, "on", bool(on))

    @property
    def intensity(self) -> float:
        """Factor of the light's colours; settable."""
        self.check_present()
        return self.scene.intensity

    @intensity.setter
    def intensity(self, intensity: float) -> None:
        self._set("intensity", checked_number(intensity, "intensity", 0.0))

    @property
    def diffuse(self) -> Colour:
        """Diffuse colour, RGBA from 0 to 1; settable, also by red, green and blue."""
        self.check_present()
        return self.scene.diffuse

    @diffuse.setter
    def diffuse(self, colour: Sequence[float]) -> None:
        self._set("diffuse", _checked_colour(colour, "diffuse"))

    @property
    def specular(self) -> Colour:
        """Specular colour, RGBA from 0 to 1; settable, also by red, green and blue."""
        self.check_present()
        return self.scene.specular

    @specular.setter
    def specular(self, colour: Sequence[float]) -> None:
        self._set("specular", _checked_colour(colour, "specular"))

    @property
    def cast_shadows(self) -> bool:
        """True if the light casts shadows; settable."""
        self.check_present()
        return self.scene.cast_shadows

    @cast_shadows.setter
    def cast_shadows(self, casts: bool) -> None:
        check_kind(casts, (bool, int), "cast_shadows", "True or False")
        self._set("cast_shadows", bool(casts))

    def _set(self, name: str, value: object) -> None:
        changes: dict[str, Any] = {name: value}
        self.change(replace(self.scene, **changes))
        self._engine.numbers.keep("light", self.scoped, name, value)

    @property
    def irradiance(self) -> float | None:
        """Irradiance of a surface that faces the light [W/m²], for a lamp at 1 m; None if not specified."""
        return self.state.irradiance

    def follow(self, course: LightCourse) -> None:
        """Let the function `course(time_ns)` set the state of the light; it may depend only on the time."""
        self.check_present()
        self.motion = LightMotion(self.state, course)
        self.draw()

    def change(self, scene: SceneLight) -> None:
        """Replace colours, attenuation, cone, direction and shadows by those of another description; the pose stays."""
        self.check_present()
        for sensor in self._engine.structure.all_sensors():
            sensor.take_held()  # pending images belong to the old light
        self.scene = scene
        self._redraw()
        self.draw()

    def replace_scene(self, scene: SceneLight) -> None:
        """Replace the description of a light of the world, whose numbers the compiled model has already."""
        state = LightState(scene.pose_world, scene.on, scene.irradiance)
        self.scene, self.motion = scene, LightMotion(state, self.motion.course)

    def switch(self, on: bool) -> None:
        """Switch the light on or off. The setting replaces an earlier motion, for example that of a sun."""
        self.check_present()
        check_kind(on, (bool, int), "on", "True or False")
        self.motion = LightMotion(replace(self.state, on=on))
        self.draw()

    def draw(self) -> None:
        """Write the light's pose and state to MuJoCo's model; a distant light is drawn from nearer."""
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
        """Write the fields that the compiler derives from the present description to MuJoCo's model."""
        index = mujoco.mj_name2id(self._physics.model, mujoco.mjtObj.mjOBJ_LIGHT, self.scoped)
        if index >= 0:
            for field, value in drawn_fields(self.scene, self._engine.world.surroundings.shadows).items():
                self._engine.touch(f"light_{field}")[index] = value

    def get_state(self) -> tuple[LightMotion, SceneLight]:
        return self.motion, self.scene

    def set_state(self, state: tuple[LightMotion, SceneLight]) -> None:
        is_another = state[1] is not self.scene
        is_same = not is_another and state[0] is self.motion and self.motion.course is None
        if is_same and not _DRAWN_FIELDS & self._engine.originals.keys():
            return  # the light has never moved
        self.motion, self.scene = state
        if is_another:
            self._redraw()
        self.draw()

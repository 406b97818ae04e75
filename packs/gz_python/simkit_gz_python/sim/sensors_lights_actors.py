"""Handles of sensors, lights and actors with the interface of gz-sim's Python classes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta
from typing import Any, TypeVar

from simkit_gz_python.math import Angle, Color, Pose3d, Vector3d
from simkit_gz_python.math.simkit_conversion import PoseLike, gz_pose, gz_vector, simkit_pose
from simkit_gz_python.math.vectors import VectorLike
from simkit_gz_python.sim.entity_handle import EntityHandle
from simkit_gz_python.sim.entity_view import EntityView

T = TypeVar("T")


class Sensor(EntityHandle):
    """Sensor on a link or a joint."""

    KIND = "sensor"

    def parent(self, ecm: EntityView) -> int | None:
        return self._parent(ecm)

    def pose(self, ecm: EntityView) -> Pose3d | None:
        """Return the pose of the sensor in the frame of the parent link or joint."""
        record = self._record(ecm)
        if record is None:
            return None
        owner = ecm.record(record.parent)
        assert owner is not None
        return gz_pose(owner.scene.pose_world.inverse() @ record.scene.pose_world)

    def topic(self, ecm: EntityView) -> str | None:
        """Return the topic on which the readings are published; None if the sensor is not simulated."""
        sensor = self._handle(ecm)
        return str(sensor.topic) if sensor is not None else None


class Actor(EntityHandle):
    """Actor, which only its script moves. The methods `set_…` store a value for later calls, but move nothing."""

    KIND = "actor"

    def pose(self, ecm: EntityView) -> Pose3d | None:
        """Return the world pose of the trajectory's origin."""
        scene = self._scene(ecm)
        return gz_pose(scene.pose_world) if scene is not None else None

    def trajectory_pose(self, ecm: EntityView) -> Pose3d | None:
        """Return the pose from `set_trajectory_pose`, relative to `pose`; None if it was never set."""
        return self._stored(ecm, "trajectory_pose", Pose3d)

    def set_trajectory_pose(self, ecm: EntityView, pose: PoseLike) -> None:
        self._store(ecm, "trajectory_pose", gz_pose(simkit_pose(pose)))

    def world_pose(self, ecm: EntityView) -> Pose3d | None:
        """Return the current pose of the actor in the world."""
        model = ecm.simulation.models.get(self.name(ecm) or "")
        return gz_pose(model.pose) if model is not None else None

    def animation_name(self, ecm: EntityView) -> str | None:
        return self._stored(ecm, "animation_name", str)

    def set_animation_name(self, ecm: EntityView, name: str) -> None:
        self._store(ecm, "animation_name", str(name))

    def animation_time(self, ecm: EntityView) -> timedelta | None:
        return self._stored(ecm, "animation_time", timedelta)

    def set_animation_time(self, ecm: EntityView, time: timedelta | float) -> None:
        """Store the time in the animation: a `timedelta`, or a number [ms] as in gz-sim 8."""
        self._store(ecm, "animation_time", time if isinstance(time, timedelta) else timedelta(milliseconds=time))

    def bone_transforms(self, ecm: EntityView) -> dict[str, Pose3d] | None:
        return self._stored(ecm, "bone_transforms", dict)

    def set_bone_transforms(self, ecm: EntityView, transforms: dict[str, PoseLike]) -> None:
        self._store(ecm, "bone_transforms", {name: gz_pose(simkit_pose(pose)) for name, pose in transforms.items()})

    def _stored(self, ecm: EntityView, name: str, kind: type[T]) -> T | None:
        stored = ecm.values.get((self._entity, name))
        return stored if isinstance(stored, kind) else None

    def _store(self, ecm: EntityView, name: str, value: object) -> None:
        if self.valid(ecm):
            ecm.values[self._entity, name] = value
            ecm.simulation.engine.log.debug(
                "actor %s: %s is stored, but only the script moves it", self.name(ecm), name
            )


class Light(EntityHandle):
    """Light of the world or of a link."""

    KIND = "light"

    def parent(self, ecm: EntityView) -> int | None:
        """Return the number of the parent, which is the world or a link."""
        return self._parent(ecm)

    def pose(self, ecm: EntityView) -> Pose3d | None:
        """Return the pose of the light in the frame of its parent: the world or a link."""
        light = self._handle(ecm)
        return gz_pose(light.state.pose) if light is not None else None

    def set_pose(self, ecm: EntityView, pose: PoseLike) -> None:
        """Set the pose of the light, immediately, in the frame of its parent: the world or a link."""
        light = self._handle(ecm)
        if light is not None:
            carrier = ecm.simulation.link(light.scene.link).pose if light.scene.link else None
            local = simkit_pose(pose)
            light.set_pose(carrier @ local if carrier is not None else local)

    def type(self, ecm: EntityView) -> str | None:
        """Return the type of the light: point, directional or spot."""
        return self._read(ecm, "type", str)

    def diffuse_color(self, ecm: EntityView) -> Color | None:
        return self._read(ecm, "diffuse", lambda rgba: Color(*rgba))

    def specular_color(self, ecm: EntityView) -> Color | None:
        return self._read(ecm, "specular", lambda rgba: Color(*rgba))

    def cast_shadows(self, ecm: EntityView) -> bool | None:
        return self._read(ecm, "cast_shadows", bool)

    def intensity(self, ecm: EntityView) -> float | None:
        return self._read(ecm, "intensity", float)

    def direction(self, ecm: EntityView) -> Vector3d | None:
        """Return the direction of the light in its own frame, as a unit vector."""
        return self._read(ecm, "direction", gz_vector)

    def attenuation_range(self, ecm: EntityView) -> float | None:
        """Return the distance [m] beyond which the light has no effect."""
        return self._part(ecm, "attenuation", 0)

    def attenuation_constant(self, ecm: EntityView) -> float | None:
        return self._part(ecm, "attenuation", 1)

    def attenuation_linear(self, ecm: EntityView) -> float | None:
        """Return the linear attenuation [1/m]."""
        return self._part(ecm, "attenuation", 2)

    def attenuation_quadratic(self, ecm: EntityView) -> float | None:
        """Return the quadratic attenuation [1/m²]."""
        return self._part(ecm, "attenuation", 3)

    def spot_inner_angle(self, ecm: EntityView) -> Angle | None:
        return self._read(ecm, "spot", lambda spot: Angle(spot[0]))

    def spot_outer_angle(self, ecm: EntityView) -> Angle | None:
        return self._read(ecm, "spot", lambda spot: Angle(spot[1]))

    def spot_falloff(self, ecm: EntityView) -> float | None:
        return self._part(ecm, "spot", 2)

    # ------------------------------------------------------------------ changes with immediate effect

    def set_diffuse_color(self, ecm: EntityView, color: Color) -> None:
        self._change(ecm, diffuse=_rgba(color))

    def set_specular_color(self, ecm: EntityView, color: Color) -> None:
        self._change(ecm, specular=_rgba(color))

    def set_cast_shadows(self, ecm: EntityView, cast_shadows: bool) -> None:
        self._change(ecm, cast_shadows=bool(cast_shadows))

    def set_intensity(self, ecm: EntityView, value: float) -> None:
        self._change(ecm, intensity=float(value))

    def set_direction(self, ecm: EntityView, direction: VectorLike) -> None:
        """Set the direction of the light in its own frame; the vector may have any length except zero."""
        vector = Vector3d(direction)
        light = self._handle(ecm)
        if light is not None and vector.length() > 0.0:
            x, y, z = vector / vector.length()
            turned = light.pose.rotate((x, y, z)).tolist()
            self._change(ecm, direction=(x, y, z), direction_world=tuple(turned))

    def set_attenuation_range(self, ecm: EntityView, range: float) -> None:
        """Set the distance [m] beyond which the light has no effect."""
        self._change_part(ecm, "attenuation", 0, range)

    def set_attenuation_constant(self, ecm: EntityView, value: float) -> None:
        self._change_part(ecm, "attenuation", 1, value)

    def set_attenuation_linear(self, ecm: EntityView, value: float) -> None:
        """Set the linear attenuation [1/m]."""
        self._change_part(ecm, "attenuation", 2, value)

    def set_attenuation_quadratic(self, ecm: EntityView, color: float) -> None:
        """Set the quadratic attenuation [1/m²]; as in gz-sim, the parameter has the misleading name `color`."""
        self._change_part(ecm, "attenuation", 3, color)

    def set_spot_inner_angle(self, ecm: EntityView, angle: Angle) -> None:
        self._change_part(ecm, "spot", 0, float(angle.radian()))

    def set_spot_outer_angle(self, ecm: EntityView, angle: Angle) -> None:
        self._change_part(ecm, "spot", 1, float(angle.radian()))

    def set_spot_falloff(self, ecm: EntityView, falloff: float) -> None:
        self._change_part(ecm, "spot", 2, falloff)

    # ------------------------------------------------------------------ helpers

    def _read(self, ecm: EntityView, name: str, convert: Callable[[Any], T]) -> T | None:
        """Return the current value of a property; the value in the file if the light is not simulated."""
        scene, light = self._scene(ecm), self._handle(ecm)
        return convert(getattr(light.scene if light is not None else scene, name)) if scene is not None else None

    def _part(self, ecm: EntityView, name: str, index: int) -> float | None:
        return self._read(ecm, name, lambda values: float(values[index]))

    def _change(self, ecm: EntityView, **fields: object) -> None:
        light = self._handle(ecm)
        if light is not None:
            light.change(replace(light.scene, **fields))

    def _change_part(self, ecm: EntityView, name: str, index: int, value: float) -> None:
        values = self._read(ecm, name, tuple)
        if values is not None:
            changed = tuple(float(value) if i == index else v for i, v in enumerate(values))
            self._change(ecm, **{name: changed})


def _rgba(color: Color) -> tuple[float, float, float, float]:
    return (color.r(), color.g(), color.b(), color.a())

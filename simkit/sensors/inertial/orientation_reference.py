"""Reference frame of an IMU's orientation: `<orientation_reference_frame>` as a rotation."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np

from simkit.diagnostics import NOWHERE, Diagnostics, Where, did_you_mean
from simkit.linear_algebra import matmul, norm
from simkit.params import Params
from simkit.pose import IDENTITY, Pose, Vector, quat_from_rpy, quat_multiply
from simkit.runtime import Simulation
from simkit.scene import SceneModel, SceneSensor

WORLD = "world"
# roll, pitch, yaw [rad] from east-north-up to the named axes
_NAMED_AXES = {"ENU": (0.0, 0.0, 0.0), "NED": (math.pi, 0.0, math.pi / 2), "NWU": (0.0, 0.0, math.pi / 2)}
_GRAVITY_SIGNS = {"GRAV_UP": 1.0, "GRAV_DOWN": -1.0}
_PARALLEL = 1e-6  # [rad] smallest angle between gravity and a direction that defines the x axis


@dataclass(frozen=True, slots=True)
class OrientationReference:
    """The `<orientation_reference_frame>` block.

    Attributes:
        localization: CUSTOM, ENU, NED, NWU, GRAV_UP or GRAV_DOWN.
        rpy: for CUSTOM: roll, pitch, yaw [rad] of the reference in the parent frame.
        x_direction: for GRAV_UP and GRAV_DOWN: direction in the parent frame whose horizontal part is the x axis.
        parent_frame: `world`, a name in the model or in the world, or empty for the sensor's own frame.
        where: line in the file of the element that names the parent frame.
    """

    localization: str
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    x_direction: tuple[float, float, float] = (1.0, 0.0, 0.0)
    parent_frame: str = ""
    where: Where = NOWHERE


def read_reference(imu: Params) -> OrientationReference | None:
    """Read the block; return None, which means the attitude at the start, if the file has no block."""
    block = imu.child("orientation_reference_frame")
    if block is None:
        return None
    localization = block.choice("localization", ("CUSTOM", *_NAMED_AXES, *_GRAVITY_SIGNS), "CUSTOM")
    custom, level = block.child("custom_rpy"), block.child("grav_dir_x")
    turn = block.vector3("custom_rpy", (0.0, 0.0, 0.0))
    direction = block.vector3("grav_dir_x", (1.0, 0.0, 0.0))
    by_gravity = localization in _GRAVITY_SIGNS
    element = level if by_gravity else custom
    if not by_gravity and level is not None:
        level.attribute("parent_frame")
    parent = element.attribute("parent_frame").strip() if element is not None else ""
    return OrientationReference(localization, turn, direction, parent, element.where if element else block.where)


def reference_orientation(reference: OrientationReference | None, sensor: SceneSensor, sim: Simulation) -> Vector:
    """Return the reference as a rotation (w, x, y, z) in the world, from the poses of the file.

    Without a block, or after a diagnostic, the result is the sensor's own attitude.
    """
    attitude = sensor.pose_world.quaternion
    if reference is None:
        return attitude
    diagnostics = sensor.params.diagnostics
    if sim.world.gazebo_quirks and _is_unsupported_by_gazebo(reference, diagnostics):
        return attitude
    if reference.localization in _NAMED_AXES:
        return quat_multiply(_heading(sim), quat_from_rpy(*_NAMED_AXES[reference.localization]))
    parent = _find_parent_frame(reference, sensor, sim, diagnostics)
    if parent is None:
        return attitude
    if reference.localization == "CUSTOM":
        # Gazebo applies the heading here too, so the parent frame `world` means east-north-up
        start = _heading(sim) if reference.parent_frame == WORLD else parent.quaternion
        return quat_multiply(start, quat_from_rpy(*reference.rpy))
    up = -_GRAVITY_SIGNS[reference.localization] * np.array(sim.world.gravity)
    levelled = _level_rotation(up, parent.rotate(reference.x_direction))
    if levelled is None:
        if up.any():
            message = f"orientation reference {reference.localization}: <grav_dir_x> is parallel to gravity"
            hint = "its horizontal part is the x axis; choose another direction"
        else:
            message = f"orientation reference {reference.localization}: the world has no gravity"
            hint = "use ENU, NED, NWU or CUSTOM, which need no gravity"
        diagnostics.error("SK-SENSOR-071", message, reference.where, hint)
        return attitude
    return levelled


def _is_unsupported_by_gazebo(reference: OrientationReference, diagnostics: Diagnostics) -> bool:
    """Report references that Gazebo replaces by the attitude at the start; return True for those."""
    localization, parent = reference.localization, reference.parent_frame
    is_custom = localization == "CUSTOM"
    if localization in _NAMED_AXES or (is_custom and parent == WORLD):
        return False
    if is_custom and not parent and not any(reference.rpy):
        return True  # the file itself requests the attitude at the start
    name = f"CUSTOM in {parent or 'the frame of the sensor'}" if is_custom else localization
    message = f"orientation reference {name} is replaced by the attitude at the start, as in Gazebo"
    diagnostics.warning("SK-SENSOR-002", message, reference.where, "remove <gazebo_quirks> to use this reference")
    return True


def _heading(sim: Simulation) -> Vector:
    """Return the rotation of east-north-up in the world: `<heading_deg>` rotates it about z."""
    coordinates = sim.world.spherical_coordinates
    return quat_from_rpy(0.0, 0.0, coordinates.heading if coordinates else 0.0)


def _level_rotation(up: Vector, direction: Vector) -> Vector | None:
    """Return a rotation with z along `up` and x along the part of `direction` orthogonal to it.

    The result is None if `up` is zero or parallel to `direction`.
    """
    size = norm(up)
    if not size:
        return None
    z = up / size
    x = direction - z * matmul(z, direction)
    if norm(x) <= _PARALLEL * norm(direction):
        return None
    x /= norm(x)
    rotation = np.empty(4)
    mujoco.mju_mat2Quat(rotation, np.column_stack((x, np.cross(z, x), z)).reshape(9))
    return rotation


# ---------------------------------------------------------------------- frames by name


def _find_parent_frame(
    reference: OrientationReference, sensor: SceneSensor, sim: Simulation, diagnostics: Diagnostics
) -> Pose | None:
    """Return the pose of the parent frame in the world at load; None after an error."""
    name = reference.parent_frame
    if not name:
        return sensor.pose_world
    if name == WORLD:
        return IDENTITY
    known = dict(_named_frames(sim))
    scope = sensor.parent.split("::")[:-1]
    # as in SDF, the search begins in the model of the sensor's link and continues outwards
    for depth in range(len(scope), -1, -1):
        frame = known.get("::".join((*scope[:depth], name)))
        if frame is not None:
            return frame
    model = "::".join((*scope, ""))
    nearby = [scoped.removeprefix(model) for scoped in known if scoped.startswith(model)]
    message = f"found parent_frame {name!r}; expected 'world', or the name of a link, joint, frame or model"
    diagnostics.error("SK-SENSOR-070", message, reference.where, did_you_mean(name, [WORLD, *nearby, *known]))
    return None


def _named_frames(sim: Simulation) -> Iterator[tuple[str, Pose]]:
    """Yield the scoped name and pose of everything that a file can name."""
    for frame in sim.world.frames:
        yield frame.scoped, frame.pose_world
    for top in sim.engine.structure.models.values():
        for model in top.all_models():
            yield model.scoped, model.pose_world
            yield from _model_frames(model)


def _model_frames(model: SceneModel) -> Iterator[tuple[str, Pose]]:
    yield f"{model.scoped}::__model__", model.pose_world
    for elements in (model.frames, model.joints, model.links):
        for element in elements:
            yield element.scoped, element.pose_world

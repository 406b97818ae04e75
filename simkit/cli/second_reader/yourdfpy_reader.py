"""Reading of a URDF file by yourdfpy, a reader that shares no code with simkit's."""

from __future__ import annotations

import io
import logging
import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from simkit.cli.second_reader.robot_reading import MOVING, Part, RobotReading, Value, limit_values, mimic_text
from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul
from simkit.scene.model import MOST_LEADERS

_IDENTITY = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))


class SecondReaderError(Exception):
    """The second reader cannot read a file; the message has its exception."""


def yourdfpy_reading(text: bytes) -> RobotReading:
    """Return yourdfpy's reading of a URDF file, without its meshes.

    Missing values get the defaults of the URDF format, and the direction of an axis becomes a unit vector, because
    yourdfpy leaves both to its callers. yourdfpy computes the frames at given positions of all joints. The positions of
    joints that mimic others come from the laws that it reads: yourdfpy itself does not move a joint that mimics a
    mimicking joint, and moves others wrongly in a robot with a planar or floating joint.

    Raises:
        SecondReaderError: yourdfpy cannot read the file.
        ImportError: yourdfpy is not installed.
    """
    import yourdfpy

    with _silent():
        try:
            robot = yourdfpy.URDF.load(io.BytesIO(text), build_scene_graph=False, load_meshes=False).robot
            parts = _parts(robot)
            laws = {joint.name: joint.mimic for joint in robot.joints if joint.mimic is not None}
            for joint in robot.joints:
                joint.mimic = None
                if joint.type in MOVING:
                    joint.axis = joint.axis / math.hypot(*joint.axis)
            urdf = yourdfpy.URDF(robot=robot, build_scene_graph=True, load_meshes=False)
        except Exception as error:  # noqa: BLE001 - an invalid file may raise any exception
            raise _read_error(error) from None
    if urdf.base_link is None:
        raise SecondReaderError("it finds no root link")
    moving = [joint.name for joint in robot.joints if joint.type in MOVING]

    def frames(positions: Mapping[str, float]) -> dict[str, tuple[float, ...]]:
        with _silent():
            try:
                # yourdfpy 0.0.59 needs numbers of NumPy
                every = {name: np.float64(_position(name, laws, positions, MOST_LEADERS)) for name in moving}
                urdf.update_cfg(every)
                return _link_frames(urdf)
            except SecondReaderError:
                raise
            except Exception as error:  # noqa: BLE001 - an invalid file may raise any exception
                raise _read_error(error) from None

    return RobotReading(urdf.base_link, parts, frames)


def _link_frames(urdf: Any) -> dict[str, tuple[float, ...]]:
    """Return the poses of all links, in the order of the file, from the transforms of all joints.

    The transform from the root to a link takes yourdfpy minutes in a chain of hundreds of links.
    """
    children: dict[str, list[str]] = {}
    for joint in urdf.robot.joints:
        children.setdefault(joint.parent, []).append(joint.child)
    frames, waiting = {urdf.base_link: np.asarray(_IDENTITY)}, [urdf.base_link]
    while waiting:
        parent = waiting.pop()
        for child in children.get(parent, ()):
            if child not in frames:
                frames[child] = matmul(frames[parent], urdf.get_transform(child, parent))
                waiting.append(child)
    apart = next((name for name in urdf.link_map if name not in frames), None)
    if apart is not None:
        raise SecondReaderError(f"no joint connects the link {apart!r} to its root link {urdf.base_link!r}")
    return {name: _pose_numbers(frames[name]) for name in urdf.link_map}


def _read_error(error: Exception) -> SecondReaderError:
    return SecondReaderError(f"{type(error).__name__}: {' '.join(str(error).split())}")


@contextmanager
def _silent() -> Iterator[None]:
    """Keep yourdfpy's messages from the terminal; simkit reports what differs."""
    logger = logging.getLogger("yourdfpy")
    level = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        logger.setLevel(level)


def _position(name: str, laws: Mapping[str, Any], positions: Mapping[str, float], left: int) -> float:
    law = laws.get(name)
    if law is None or left == 0:
        return positions.get(name, 0.0)
    return float(law.multiplier * _position(law.joint, laws, positions, left - 1) + law.offset)


def _pose_numbers(matrix: Any) -> tuple[float, ...]:
    rows = (_IDENTITY if matrix is None else matrix)[:3]
    return (*(float(row[3]) for row in rows), *(float(v) for row in rows for v in row[:3]))


def _parts(robot: Any) -> dict[Part, Mapping[str, Value]]:
    parts: dict[Part, Mapping[str, Value]] = {}
    for link in robot.links:
        parts[Part("link", link.name)] = _mass_values(link.inertial)
        for kind, shapes in (("collision", link.collisions), ("visual", link.visuals)):
            parts |= {Part(kind, link.name, index): _shape_values(shape) for index, shape in enumerate(shapes)}
    for joint in robot.joints:
        parts[Part("joint", joint.name)] = _joint_values(joint)
    return parts


def _mass_values(inertial: Any) -> dict[str, Value]:
    if inertial is None or not inertial.mass:
        return {"mass": (0.0,)}
    origin = _pose_numbers(inertial.origin)
    inertia = (0.0,) * 6 if inertial.inertia is None else _rotated(inertial.inertia, origin)
    return {"mass": (inertial.mass,), "centre of mass": origin[:3], "inertia": inertia}


def _rotated(inertia: Any, origin: Sequence[float]) -> tuple[float, ...]:
    """Return ixx, iyy, izz, ixy, ixz, iyz in the link's axes: R·I·Rᵀ with the rotation R of the inertial frame."""
    rows = [origin[3:6], origin[6:9], origin[9:12]]

    def element(i: int, j: int) -> float:
        return float_sum(rows[i][k] * float(inertia[k][m]) * rows[j][m] for k in range(3) for m in range(3))

    return tuple(element(i, j) for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))


def _joint_values(joint: Any) -> dict[str, Value]:
    values: dict[str, Value] = {
        "type": joint.type,
        "parent link": joint.parent,
        "child link": joint.child,
        "origin": _pose_numbers(joint.origin),
    }
    if joint.type in (*MOVING, "planar"):
        length = math.hypot(*joint.axis)
        values["axis"] = tuple(float(v) / length for v in joint.axis)
    if joint.type in MOVING:
        values |= _limits(joint)
        dynamics, mimic = joint.dynamics, joint.mimic
        for name in ("damping", "friction"):
            values[name] = (float(getattr(dynamics, name, None) or 0.0),)
        law = None if mimic is None else mimic_text(mimic.joint, mimic.multiplier, mimic.offset)
        values["mimic"] = law or "none"
    return values


def _limits(joint: Any) -> dict[str, Value]:
    """Return limits as the format defines them: positions are 0 by default, and a negative effort is unlimited."""
    limit = joint.limit
    if limit is None:
        return limit_values(-math.inf, math.inf, math.inf, math.inf)
    lower, upper = (0.0 if v is None else v for v in (limit.lower, limit.upper))
    if joint.type == "continuous":
        lower, upper = -math.inf, math.inf
    effort, velocity = (math.inf if v is None or v < 0 else v for v in (limit.effort, limit.velocity))
    return limit_values(lower, upper, effort, velocity)


def _shape_values(shape: Any) -> dict[str, Value]:
    geometry, values = shape.geometry, {"origin": _pose_numbers(shape.origin)}
    if geometry.box is not None:
        return {**values, "shape": "box", "size": tuple(map(float, geometry.box.size))}
    if geometry.sphere is not None:
        return {**values, "shape": "sphere", "size": (geometry.sphere.radius,)}
    if geometry.cylinder is not None:
        return {**values, "shape": "cylinder", "size": (geometry.cylinder.radius, geometry.cylinder.length)}
    scale = geometry.mesh.scale
    scales = (
        (scale,) * 3 if isinstance(scale, float) else (1.0, 1.0, 1.0) if scale is None else tuple(map(float, scale))
    )
    return {**values, "shape": "mesh", "mesh": geometry.mesh.filename, "scale": scales}

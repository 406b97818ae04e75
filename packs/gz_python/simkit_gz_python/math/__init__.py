"""Replacement of gz-math's Python module: `gz.math7`, `gz.math`, `ignition.math6`, … import this package.

Numbers, vectors, poses and masses have the names and tolerances of gz-math. The package does not need a simulation.
"""

from __future__ import annotations

from typing import NoReturn

from simkit_gz_python.math.angle import Angle
from simkit_gz_python.math.axis_aligned_box import AxisAlignedBox
from simkit_gz_python.math.color import Color, Temperature
from simkit_gz_python.math.inertia import Inertiald, MassMatrix3d
from simkit_gz_python.math.matrices import Matrix3d, Matrix4d
from simkit_gz_python.math.missing_names import missing_name_error
from simkit_gz_python.math.pid import PID, RollingMean
from simkit_gz_python.math.pose import Pose3d
from simkit_gz_python.math.quaternion import Quaterniond
from simkit_gz_python.math.scalars import (
    clamp,
    equal,
    fixnan,
    greater_or_near_equal,
    is_even,
    is_odd,
    is_power_of_two,
    isnan,
    less_or_near_equal,
    mean,
    parse_float,
    parse_int,
    precision,
    round_up_multiple,
    round_up_power_of_two,
    sgn,
    signum,
    sort2,
    sort3,
    variance,
)
from simkit_gz_python.math.spherical_coordinates import SphericalCoordinates
from simkit_gz_python.math.vectors import (
    Vector2d,
    Vector2f,
    Vector2i,
    Vector3d,
    Vector3f,
    Vector3i,
    Vector4d,
    Vector4f,
    Vector4i,
)

# gz-math has these names for single precision; here they are the types of double precision
Quaternionf, Pose3f, Matrix3f, Matrix4f = Quaterniond, Pose3d, Matrix3d, Matrix4d
MassMatrix3f, Inertialf = MassMatrix3d, Inertiald

__all__ = ["PID", "Angle", "AxisAlignedBox", "Color", "RollingMean", "SphericalCoordinates", "Temperature"]
__all__ += ["Vector2d", "Vector2f", "Vector2i", "Vector3d", "Vector3f", "Vector3i", "Vector4d", "Vector4f", "Vector4i"]
__all__ += ["Inertiald", "Inertialf", "MassMatrix3d", "MassMatrix3f", "Matrix3d", "Matrix3f", "Matrix4d", "Matrix4f"]
__all__ += ["Pose3d", "Pose3f", "Quaterniond", "Quaternionf"]
__all__ += ["clamp", "equal", "fixnan", "greater_or_near_equal", "is_even", "is_odd", "is_power_of_two", "isnan"]
__all__ += ["less_or_near_equal", "mean", "parse_float", "parse_int", "precision", "round_up_multiple"]
__all__ += ["round_up_power_of_two", "sgn", "signum", "sort2", "sort3", "variance"]


def __getattr__(name: str) -> NoReturn:
    raise missing_name_error("gz.math", name, __all__)

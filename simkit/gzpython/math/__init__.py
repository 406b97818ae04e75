"""gz-math's types in Python, for modules written for it: `gz.math7`, `gz.math`, `ignition.math6`, … are this package.

Names, meanings and tolerances are those of gz-math's own binding. Numbers have double precision throughout.
"""

from __future__ import annotations

from typing import Any, Final

from simkit.gzpython.math.angle import Angle
from simkit.gzpython.math.control import PID, RollingMean
from simkit.gzpython.math.earth import SphericalCoordinates
from simkit.gzpython.math.inertia import Inertiald, MassMatrix3d
from simkit.gzpython.math.look import AxisAlignedBox, Color, Temperature
from simkit.gzpython.math.matrices import Matrix3d, Matrix4d
from simkit.gzpython.math.pose import Pose3d
from simkit.gzpython.math.rotation import Quaterniond
from simkit.gzpython.math.scalars import (
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
from simkit.gzpython.math.vectors import (
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

# the single-precision twins of what has no twin of its own
Quaternionf, Pose3f, Matrix3f, Matrix4f = Quaterniond, Pose3d, Matrix3d, Matrix4d
MassMatrix3f, Inertialf = MassMatrix3d, Inertiald

__all__ = [
    "PID",
    "Angle",
    "AxisAlignedBox",
    "Color",
    "Inertiald",
    "Inertialf",
    "MassMatrix3d",
    "MassMatrix3f",
    "Matrix3d",
    "Matrix3f",
    "Matrix4d",
    "Matrix4f",
    "Pose3d",
    "Pose3f",
    "Quaterniond",
    "Quaternionf",
    "RollingMean",
    "SphericalCoordinates",
    "Temperature",
    "Vector2d",
    "Vector2f",
    "Vector2i",
    "Vector3d",
    "Vector3f",
    "Vector3i",
    "Vector4d",
    "Vector4f",
    "Vector4i",
    "clamp",
    "equal",
    "fixnan",
    "greater_or_near_equal",
    "is_even",
    "is_odd",
    "is_power_of_two",
    "isnan",
    "less_or_near_equal",
    "mean",
    "parse_float",
    "parse_int",
    "precision",
    "round_up_multiple",
    "round_up_power_of_two",
    "sgn",
    "signum",
    "sort2",
    "sort3",
    "variance",
]

LEFT_OUT: Final = {
    "Rand": "random.Random(seed), which two runs with one seed draw the same from",
    "StopWatch": "info.sim_time",
    "DiffDriveOdometry": "the topic of the DiffDrive plugin",
    "MecanumDriveOdometry": "the topic of an OdometryPublisher plugin",
    "Matrix6d": "numpy",
    "Frustum": "numpy",
    "Kmeans": "numpy",
    "Line2d": "numpy",
    "Line3d": "numpy",
    "Plane": "numpy",
    "Planed": "numpy",
    "OrientedBoxd": "AxisAlignedBox",
    "Boxd": "AxisAlignedBox",
    "Sphered": "numpy",
    "Cylinderd": "numpy",
    "Capsuled": "numpy",
    "Ellipsoidd": "numpy",
    "Triangled": "numpy",
    "Triangle3d": "numpy",
    "Spline": "numpy",
    "RotationSpline": "Quaterniond.squad",
    "Polynomial3d": "numpy",
    "Intervald": "a pair of numbers",
    "Region3d": "AxisAlignedBox",
    "SignalStats": "mean and variance",
    "Vector3Stats": "mean and variance",
    "Filter": "a few lines of arithmetic",
    "OnePole": "a few lines of arithmetic",
    "BiQuad": "a few lines of arithmetic",
    "MovingWindowFilter": "RollingMean",
    "GaussMarkovProcess": "random.Random(seed).gauss",
    "SemanticVersion": "packaging.version",
    "Material": "the density as a number",
    "Helpers": "the functions of this module and of Python's math",
}
"""What gz-math has and this package does not, with what to use."""


def __getattr__(name: str) -> Any:
    if name in LEFT_OUT:
        raise ImportError(f"simkit's gz.math has no {name}; use {LEFT_OUT[name]}", name="gz.math")
    raise AttributeError(f"module 'gz.math' has no attribute {name!r}")

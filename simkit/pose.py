"""Rigid poses. Quaternions are (w, x, y, z); angles rad; lengths m."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NoReturn

import numpy as np
import numpy.typing as npt

from simkit.argument_checks import checked_number, checked_vector, shown, wrong_value
from simkit.elementary_functions import ARRAYS, FLOATS, Arithmetic, Numbers
from simkit.errors import ArgumentTypeError
from simkit.linear_algebra import dot

Vector = npt.NDArray[np.float64]
VectorLike = Sequence[float] | Vector
_set = object.__setattr__


def _floats(values: VectorLike) -> list[float]:
    # arithmetic on Python floats is several times faster than on NumPy scalars, with the same bits
    return values.tolist() if isinstance(values, np.ndarray) else [float(v) for v in values]


def wrap_angle(angle: float) -> float:
    """Return the equal angle [rad] from -π to π; exact.

    Raises:
        ValueError: the angle is infinite.
    """
    return math.remainder(angle, math.tau)


def quat_multiply(a: VectorLike, b: VectorLike) -> Vector:
    """Return the Hamilton product of two (w, x, y, z) quaternions, shape (4,)."""
    return np.array(hamilton_product(_floats(a), _floats(b)))


def hamilton_product(a: Iterable[Numbers], b: Iterable[Numbers]) -> tuple[Numbers, Numbers, Numbers, Numbers]:
    """Return the Hamilton product of two quaternions (w, x, y, z), each of four numbers or of four arrays."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def quat_conjugate(q: VectorLike) -> Vector:
    """Return the conjugate of a (w, x, y, z) quaternion."""
    w, x, y, z = _floats(q)
    return np.array((w, -x, -y, -z))


def quat_rotate(q: VectorLike, v: VectorLike) -> Vector:
    """Rotate the vector `v` by the unit quaternion `q` (w, x, y, z); shape (3,)."""
    w, x, y, z = _floats(q)
    vx, vy, vz = _floats(v)
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return np.array((vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx))


def quat_from_rpy(roll: float, pitch: float, yaw: float) -> Vector:
    """Return the quaternion (w, x, y, z) of Rz(yaw)·Ry(pitch)·Rx(roll) [rad], the order of SDF, URDF and ROS."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return np.array(
        (
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        )
    )


def rpy_from_quat(q: VectorLike) -> Vector:
    """Return roll, pitch and yaw [rad] of a unit quaternion (w, x, y, z), shape (3,)."""
    return np.array(_angles(FLOATS, *_floats(q)))


def rpy_of_quaternions(q: VectorLike) -> Vector:
    """Return roll, pitch and yaw [rad] of unit quaternions, shape (n, 4), or of one, as an array (n, 3) or (3,)."""
    if isinstance(q, np.ndarray) and q.ndim == 2:
        return np.stack(_angles(ARRAYS, *q.T), axis=1)
    return rpy_from_quat(q)


def _angles(
    of: Arithmetic[Numbers], w: Numbers, x: Numbers, y: Numbers, z: Numbers
) -> tuple[Numbers, Numbers, Numbers]:
    sin_pitch = of.maximum(-1.0, of.minimum(1.0, 2 * (w * y - z * x)))
    return (
        of.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
        of.arcsin(sin_pitch),
        of.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
    )


def quat_to_matrix(q: VectorLike) -> Vector:
    """Return the rotation matrix of a unit quaternion (w, x, y, z), shape (3, 3)."""
    w, x, y, z = _floats(q)
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
    )


def _rotate_argument(q: Vector, vector: VectorLike) -> Vector:
    """Return `quat_rotate(q, vector)`; an argument of a caller that is not a vector is an error of simkit."""
    try:
        return quat_rotate(q, vector)
    except Exception:
        checked_vector(vector, "the vector")
        raise


def _raise_pose_error(position: object, quaternion: object) -> NoReturn:
    checked_vector(position, "the position of a pose")
    checked_vector(quaternion, "the quaternion (w, x, y, z) of a pose", 4)
    raise wrong_value("the quaternion of a pose", "4 numbers with a finite norm that is not zero", quaternion)


class Pose:
    """Immutable rigid pose. If pose b is in the frame of a, `a @ b` is the same pose in the parent frame of a.

    Attributes:
        position: translation [m], shape (3,).
        quaternion: unit quaternion (w, x, y, z), shape (4,).
    """

    __slots__ = ("position", "quaternion")
    position: Vector
    quaternion: Vector

    def __init__(self, position: VectorLike = (0.0, 0.0, 0.0), quaternion: VectorLike = (1.0, 0.0, 0.0, 0.0)) -> None:
        try:
            p = np.array(position, dtype=np.float64)
            q = np.array(quaternion, dtype=np.float64)
        except Exception:  # noqa: BLE001 (an object of the caller may raise any error)
            _raise_pose_error(position, quaternion)
        if p.shape != (3,) or q.shape != (4,):
            _raise_pose_error(position, quaternion)
        norm = math.sqrt(dot(q, q))
        x, y, z = p.tolist()
        if not (1e-12 < norm < math.inf and math.isfinite(x) and math.isfinite(y) and math.isfinite(z)):
            _raise_pose_error(p, q)
        if abs(norm - 1.0) > 1e-15:
            q = q / norm
        p.setflags(write=False)
        q.setflags(write=False)
        _set(self, "position", p)
        _set(self, "quaternion", q)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("a Pose cannot be changed; make a new one")

    @classmethod
    def from_rpy(cls, x: float, y: float, z: float, roll: float, pitch: float, yaw: float) -> Pose:
        """Create a pose from a position [m] and fixed-axis roll, pitch and yaw [rad]."""
        try:
            quaternion = quat_from_rpy(roll, pitch, yaw)
        except Exception:  # a text, an infinite angle
            for name, angle in (("roll", roll), ("pitch", pitch), ("yaw", yaw)):
                checked_number(angle, name, unit="rad")
            raise
        return cls((x, y, z), quaternion)

    @property
    def rpy(self) -> Vector:
        """Roll, pitch, yaw [rad], shape (3,)."""
        return rpy_from_quat(self.quaternion)

    @property
    def matrix(self) -> Vector:
        """Rotation matrix, shape (3, 3)."""
        return quat_to_matrix(self.quaternion)

    def __matmul__(self, other: Pose) -> Pose:
        if other is IDENTITY:
            return self
        if self is IDENTITY:
            return other
        # `transform` and `quat_multiply` without intermediate arrays: a load multiplies thousands of poses
        if not isinstance(other, Pose):
            return self.__rmatmul__(other)  # type: ignore[unreachable]  # for callers without types
        aw, ax, ay, az = self.quaternion.tolist()
        bw, bx, by, bz = other.quaternion.tolist()
        px, py, pz = self.position.tolist()
        x, y, z = other.position.tolist()
        tx, ty, tz = 2 * (ay * z - az * y), 2 * (az * x - ax * z), 2 * (ax * y - ay * x)
        return _make_pose(
            (
                px + (x + aw * tx + ay * tz - az * ty),
                py + (y + aw * ty + az * tx - ax * tz),
                pz + (z + aw * tz + ax * ty - ay * tx),
            ),
            (
                aw * bw - ax * bx - ay * by - az * bz,
                aw * bx + ax * bw + ay * bz - az * by,
                aw * by - ax * bz + ay * bw + az * bx,
                aw * bz + ax * by - ay * bx + az * bw,
            ),
        )

    __array_ufunc__ = None  # an array on the left leaves the product to `__rmatmul__`

    def __rmatmul__(self, other: object) -> Pose:
        return checked_pose(other)

    def inverse(self) -> Pose:
        """Return the pose of the parent's frame in this frame."""
        w, x, y, z = self.quaternion.tolist()
        vx, vy, vz = self.position.tolist()
        x, y, z = -x, -y, -z
        tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
        return _make_pose(
            (-(vx + w * tx + y * tz - z * ty), -(vy + w * ty + z * tx - x * tz), -(vz + w * tz + x * ty - y * tx)),
            (w, x, y, z),
        )

    def rotate(self, vector: VectorLike) -> Vector:
        """Rotate a vector, such as a velocity, from the axes of this frame to those of the parent; shape (3,)."""
        return _rotate_argument(self.quaternion, vector)

    def transform(self, point: VectorLike) -> Vector:
        """Transform a point [m] from this frame to the parent's frame; shape (3,)."""
        return self.position + _rotate_argument(self.quaternion, point)

    def as_list(self) -> list[float]:
        """Return the pose as [x, y, z, qw, qx, qy, qz], positions in m."""
        return [float(v) for v in (*self.position, *self.quaternion)]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Pose):
            return NotImplemented
        return bool((self.position == other.position).all() and (self.quaternion == other.quaternion).all())

    def __hash__(self) -> int:
        return hash((*self.position.tolist(), *self.quaternion.tolist()))

    def __deepcopy__(self, memo: dict[int, object]) -> Pose:
        return self

    def __reduce__(self) -> tuple[type[Pose], tuple[list[float], list[float]]]:
        return (Pose, (self.position.tolist(), self.quaternion.tolist()))

    def __repr__(self) -> str:
        return f"Pose(position={tuple(self.position.tolist())}, quaternion={tuple(self.quaternion.tolist())})"


def _make_pose(position: tuple[float, float, float], quaternion: tuple[float, float, float, float]) -> Pose:
    """Create `Pose(position, quaternion)` faster, with the same bits."""
    p, q = np.array(position), np.array(quaternion)
    norm = math.sqrt(dot(q, q))
    if not (1e-12 < norm < math.inf and all(map(math.isfinite, position))):
        return Pose(position, quaternion)  # raises with the reason
    if abs(norm - 1.0) > 1e-15:
        q = q / norm
    p.flags.writeable = q.flags.writeable = False
    pose = Pose.__new__(Pose)
    _set(pose, "position", p)
    _set(pose, "quaternion", q)
    return pose


def checked_pose(value: object) -> Pose:
    """Return a pose, or raise ArgumentTypeError for any other value; a pose has finite numbers."""
    if not isinstance(value, Pose):
        raise ArgumentTypeError(f"a pose is a simkit.Pose, such as simkit.Pose((0, 0, 1)), got {shown(value)}")
    return value


IDENTITY = Pose()

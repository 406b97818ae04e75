"""Quaternions of gz-math: (w, x, y, z); Euler angles are roll, pitch, yaw about fixed axes."""

from __future__ import annotations

import math
from typing import Any, Final, Protocol

from simkit.float_sum import float_sum
from simkit_gz_python.math.scalars import DEFAULT_TOLERANCE, round_half_away
from simkit_gz_python.math.value_base import (
    ClassConstant,
    Components,
    CppArgument,
    Operand,
    component_getter,
    component_setter,
)
from simkit_gz_python.math.vectors import EQUALITY_TOLERANCE, Vector3d, VectorLike, components_of

_POLE: Final = 1e-15
_NEARLY_ONE_AXIS: Final = 1e-3


class RotationMatrix(Protocol):
    """Rotation matrix with the elements `m(row, column)`: a `Matrix3d`, or a similar type of another library."""

    def __call__(self, row: int, column: int) -> float: ...


class Quaterniond(Components):
    """Rotation as a quaternion.

    The arguments are `()`, `(w, x, y, z)`, `(roll, pitch, yaw)`, `(axis, angle)`, `(rpy vector)`, `(rotation matrix)`
    or `(quaternion)`.
    """

    IDENTITY = ClassConstant()
    ZERO = ClassConstant(0, 0, 0, 0)

    def __init__(self, *values: CppArgument) -> None:
        self._v = [1.0, 0.0, 0.0, 0.0]
        if len(values) == 4:
            self.set(*values)
        elif len(values) == 3:
            self.set_from_euler(*values)
        elif len(values) == 2:
            self.set_from_axis_angle(*values)
        elif len(values) == 1:
            self._assign(values[0])
        elif values:
            raise TypeError(f"expected 0 to 4 values for a quaternion, got {len(values)}")

    def _assign(self, value: CppArgument) -> None:
        if callable(getattr(value, "w", None)):
            self.set(value.w(), value.x(), value.y(), value.z())
        elif callable(getattr(value, "determinant", None)):
            self.set_from_matrix(value)
        else:
            self.set_from_euler(value)

    # ------------------------------------------------------------------ components

    w, set_w = component_getter("_v", 0), component_setter("_v", 0)
    x, set_x = component_getter("_v", 1), component_setter("_v", 1)
    y, set_y = component_getter("_v", 2), component_setter("_v", 2)
    z, set_z = component_getter("_v", 3), component_setter("_v", 3)

    def set(self, w: float, x: float, y: float, z: float) -> None:
        self._v = [float(w), float(x), float(y), float(z)]

    # ------------------------------------------------------------------ from and to other forms

    def set_from_axis_angle(self, *values: CppArgument) -> None:
        """Set the rotation from (axis, angle) or (x, y, z, angle) [rad]; a zero axis gives the identity."""
        x, y, z = components_of(values[0], 3) if len(values) == 2 else values[:3]
        square = x * x + y * y + z * z
        if square <= DEFAULT_TOLERANCE:
            self._v = [1.0, 0.0, 0.0, 0.0]
            return
        half = 0.5 * values[-1]
        scale = math.sin(half) / math.sqrt(square)
        self._v = [math.cos(half), x * scale, y * scale, z * scale]
        self.normalize()

    def set_from_euler(self, *values: CppArgument) -> None:
        """Set the rotation from roll, pitch, yaw [rad]: Rz(yaw)·Ry(pitch)·Rx(roll)."""
        roll, pitch, yaw = components_of(values[0], 3) if len(values) == 1 else values
        cr, sr = math.cos(roll / 2), math.sin(roll / 2)
        cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
        cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
        self._v = [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
        self.normalize()

    @staticmethod
    def euler_to_quaternion(*values: CppArgument) -> Quaterniond:
        """Create a rotation from roll, pitch, yaw [rad]."""
        quaternion = Quaterniond()
        quaternion.set_from_euler(*values)
        return quaternion

    def euler(self) -> Vector3d:
        """Return roll, pitch, yaw [rad].

        At a pitch of ±π/2 only the sum or difference of roll and yaw is defined; yaw is then 0.
        """
        w, x, y, z = self.normalized()._v
        ww, xx, yy, zz = w * w, x * x, y * y, z * z
        sine = -2.0 * (x * z - w * y) / (ww + xx + yy + zz)
        pitch = math.asin(max(-1.0, min(1.0, sine)))
        if abs(abs(sine) - 1.0) < _POLE:
            sum_sine = math.copysign(2.0, sine) * (x * y - z * w)
            return Vector3d(math.atan2(sum_sine, ww - xx + yy - zz), pitch, 0.0)
        roll = math.atan2(2.0 * (y * z + w * x), ww - xx - yy + zz)
        return Vector3d(roll, pitch, math.atan2(2.0 * (x * y + w * z), ww + xx - yy - zz))

    def roll(self) -> float:
        return float(self.euler().x())

    def pitch(self) -> float:
        return float(self.euler().y())

    def yaw(self) -> float:
        return float(self.euler().z())

    def axis_angle(self) -> tuple[Vector3d, float]:
        """Return the unit axis and the angle [rad]; the x axis and 0 for the identity."""
        w, x, y, z = self._v
        square = x * x + y * y + z * z
        if square <= DEFAULT_TOLERANCE**2:
            return Vector3d(1, 0, 0), 0.0
        return Vector3d(x, y, z) / math.sqrt(square), 2.0 * math.acos(max(-1.0, min(1.0, w)))

    def set_from_matrix(self, matrix: RotationMatrix) -> None:
        """Set the rotation from a rotation matrix."""
        m = [[float(matrix(i, j)) for j in range(3)] for i in range(3)]
        trace = m[0][0] + m[1][1] + m[2][2]
        if trace > 0.0:
            w = math.sqrt(1.0 + trace) / 2
            s = 1.0 / (4 * w)
            self._v = [w, (m[2][1] - m[1][2]) * s, (m[0][2] - m[2][0]) * s, (m[1][0] - m[0][1]) * s]
            return
        i = max(range(3), key=lambda k: m[k][k])
        j, k = (i + 1) % 3, (i + 2) % 3
        largest = math.sqrt(1.0 + m[i][i] - m[j][j] - m[k][k]) / 2
        s = 1.0 / (4 * largest)
        vector = [0.0, 0.0, 0.0]
        vector[i], vector[j], vector[k] = largest, (m[j][i] + m[i][j]) * s, (m[k][i] + m[i][k]) * s
        self._v = [(m[k][j] - m[j][k]) * s, *vector]

    def set_from_2_axes(self, first: VectorLike, second: VectorLike) -> None:
        """Set the smallest rotation that turns the first vector into the direction of the second vector."""
        a, b = Vector3d(first).normalized(), Vector3d(second).normalized()
        cosine = a.dot(b)
        if cosine < -1.0 + DEFAULT_TOLERANCE:
            self.set_from_axis_angle(a.perpendicular().normalized(), math.pi)
            return
        self.set(1.0 + cosine, *a.cross(b))
        self.normalize()

    # ------------------------------------------------------------------ algebra

    def inverse(self) -> Quaterniond:
        """Return the inverse rotation; the identity for a zero quaternion."""
        w, x, y, z = self._v
        square = w * w + x * x + y * y + z * z
        if square <= DEFAULT_TOLERANCE**2:
            return Quaterniond()
        return Quaterniond(w / square, -x / square, -y / square, -z / square)

    def invert(self) -> None:
        self._v = self.normalized().inverse()._v

    def normalize(self) -> None:
        """Scale to length 1; a zero quaternion becomes the identity."""
        length = math.sqrt(float_sum(v * v for v in self._v))
        if length <= DEFAULT_TOLERANCE:
            self._v = [1.0, 0.0, 0.0, 0.0]
        else:
            w, x, y, z = self._v
            self._v = [w / length, x / length, y / length, z / length]

    def normalized(self) -> Quaterniond:
        unit = Quaterniond(self)
        unit.normalize()
        return unit

    def log(self) -> Quaterniond:
        """Return the logarithm of a unit quaternion: w = 0, and half the rotation vector as x, y, z."""
        w, x, y, z = self._v
        scale = 1.0
        if abs(w) < 1.0:
            angle = math.acos(w)
            sine = math.sin(angle)
            scale = angle / sine if abs(sine) >= _NEARLY_ONE_AXIS else 1.0
        return Quaterniond(0.0, x * scale, y * scale, z * scale)

    def exp(self) -> Quaterniond:
        """Return the exponential of a quaternion with w = 0, the inverse of `log`."""
        _, x, y, z = self._v
        angle = math.sqrt(x * x + y * y + z * z)
        sine = math.sin(angle)
        scale = sine / angle if abs(sine) >= _NEARLY_ONE_AXIS else 1.0
        return Quaterniond(math.cos(angle), x * scale, y * scale, z * scale)

    def scale(self, factor: float) -> None:
        """Multiply the rotation angle by a factor; the axis stays the same."""
        axis, angle = self.axis_angle()
        self.set_from_axis_angle(axis, angle * factor)

    def dot(self, other: Quaterniond) -> float:
        return float_sum(a * b for a, b in zip(self._v, other._v, strict=True))

    def rotate_vector(self, vector: VectorLike) -> Vector3d:
        """Rotate a vector."""
        x, y, z = components_of(vector, 3)
        product = self * Quaterniond(0.0, x, y, z) * self.inverse()
        return Vector3d(*product._v[1:])

    def rotate_vector_reverse(self, vector: VectorLike) -> Vector3d:
        """Rotate a vector by the inverse rotation."""
        return self.inverse().rotate_vector(vector)

    def x_axis(self) -> Vector3d:
        return self.rotate_vector((1.0, 0.0, 0.0))

    def y_axis(self) -> Vector3d:
        return self.rotate_vector((0.0, 1.0, 0.0))

    def z_axis(self) -> Vector3d:
        return self.rotate_vector((0.0, 0.0, 1.0))

    def integrate(self, angular_velocity: VectorLike, dt: float) -> Quaterniond:
        """Return the rotation after a constant angular velocity [rad/s], in fixed axes, for `dt` [s]."""
        half = Vector3d(angular_velocity) * (dt * 0.5)
        angle = half.length()
        sinc = math.sin(angle) / angle if angle > 1e-8 else 1.0 - angle * angle / 6.0
        turned: Quaterniond = Quaterniond(math.cos(angle), *(half * sinc)) * self
        return turned

    @staticmethod
    def slerp(t: float, first: Quaterniond, second: Quaterniond, shortest_path: bool = False) -> Quaterniond:
        """Interpolate between two rotations at constant speed, with `t` from 0 to 1."""
        cosine, target = first.dot(second), second
        if cosine < 0.0 and shortest_path:
            cosine, target = -cosine, -second
        if abs(cosine) < 1.0 - 1e-3:
            sine = math.sqrt(1.0 - cosine * cosine)
            angle = math.atan2(sine, cosine)
            shares = math.sin((1.0 - t) * angle) / sine, math.sin(t * angle) / sine
        else:
            shares = 1.0 - t, t
        between = first._times(shares[0]) + target._times(shares[1])
        return between if abs(cosine) < 1.0 - 1e-3 else between.normalized()

    @staticmethod
    def squad(
        t: float, first: Quaterniond, a: Quaterniond, b: Quaterniond, second: Quaterniond, shortest_path: bool = False
    ) -> Quaterniond:
        """Interpolate between the first and the second rotation along a spline with the control rotations a and b."""
        outer = Quaterniond.slerp(t, first, second, shortest_path)
        return Quaterniond.slerp(2.0 * t * (1.0 - t), outer, Quaterniond.slerp(t, a, b))

    # ------------------------------------------------------------------ operators

    def _numbers_of(self, other: Operand) -> list[float] | None:
        return other._v if isinstance(other, Quaterniond) else None

    def __neg__(self) -> Quaterniond:
        return Quaterniond(*(-a for a in self._v))

    def __mul__(self, other: CppArgument) -> Any:
        if isinstance(other, (int, float)):
            return self._times(other)
        if not callable(getattr(other, "w", None)):
            return self.rotate_vector(other)
        aw, ax, ay, az = self._v
        bw, bx, by, bz = other.w(), other.x(), other.y(), other.z()
        return Quaterniond(
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        )

    def _times(self, factor: float) -> Quaterniond:
        return Quaterniond(*(a * factor for a in self._v))

    def equal(self, other: Quaterniond, tolerance: float = EQUALITY_TOLERANCE) -> bool:
        """Check whether every component is within a tolerance."""
        return self._is_near(other._v, tolerance)

    def __eq__(self, other: object) -> bool:
        return self.equal(other) if isinstance(other, Quaterniond) else NotImplemented

    def is_finite(self) -> bool:
        return all(map(math.isfinite, self._v))

    def correct(self) -> None:
        """Set the identity if a component is NaN or infinite."""
        if not self.is_finite():
            self._v = [1.0, 0.0, 0.0, 0.0]

    def round(self, digits: int) -> None:
        power = 10.0**digits
        self.set(*(round_half_away(v * power) / power for v in self._v))

    def __repr__(self) -> str:
        return repr(self.euler())

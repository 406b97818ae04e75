"""Vectors, rotations, frames, twists and wrenches [m, rad, N] of KDL; their methods have KDL's names.

A frame is a pose: the rotation `M` and the origin `p`. A twist has the velocity of its reference point and the angular
velocity. A wrench has a force, and the torque about its reference point.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final, Self

__all__ = ["Equal", "Frame", "Rotation", "Twist", "Vector", "Wrench"]

EPSILON: Final = 1e-6
"""Difference below which KDL takes two numbers as equal."""


class _Values:
    """Object of KDL with a fixed number of values, which can be changed, compared, copied and printed."""

    def _values(self) -> list[float]:
        raise NotImplementedError

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and Equal(self, other)

    def __hash__(self) -> int:
        return hash(tuple(self._values()))

    def __copy__(self) -> Self:
        return type(self)(self)  # type: ignore[call-arg]

    def __deepcopy__(self, memo: Any) -> Self:
        return self.__copy__()

    def __repr__(self) -> str:
        return f"[{','.join(f'{value:12g}' for value in self._values())}]"


class Vector(_Values):
    """Vector; `*` of two vectors is the cross product.

    Args:
        x: first component, or a vector.
        y: second component.
        z: third component.
    """

    __slots__ = ("_xyz",)

    def __init__(self, x: float | Vector = 0.0, y: float = 0.0, z: float = 0.0) -> None:
        self._xyz: list[float] = list(x._xyz) if isinstance(x, Vector) else [float(x), float(y), float(z)]

    @staticmethod
    def Zero() -> Vector:
        """Return the zero vector."""
        return Vector()

    def _values(self) -> list[float]:
        return list(self._xyz)

    def _component(self, index: int, value: float | None) -> Any:
        if value is None:
            return self._xyz[index]
        self._xyz[index] = float(value)
        return None

    def x(self, value: float | None = None) -> Any:
        """Return the first component, or set it."""
        return self._component(0, value)

    def y(self, value: float | None = None) -> Any:
        """Return the second component, or set it."""
        return self._component(1, value)

    def z(self, value: float | None = None) -> Any:
        """Return the third component, or set it."""
        return self._component(2, value)

    def __getitem__(self, index: int) -> float:
        if not 0 <= index < 3:
            raise IndexError("Vector index out of range")
        return self._xyz[index]

    def __setitem__(self, index: int, value: float) -> None:
        if not 0 <= index < 3:
            raise IndexError("Vector index out of range")
        self._xyz[index] = float(value)

    def __iter__(self) -> Iterator[float]:
        return iter(self._values())

    def __add__(self, other: Vector) -> Vector:
        return Vector(*(a + b for a, b in zip(self, other, strict=True))) if _is(other, Vector) else NotImplemented

    def __sub__(self, other: Vector) -> Vector:
        return Vector(*(a - b for a, b in zip(self, other, strict=True))) if _is(other, Vector) else NotImplemented

    def __iadd__(self, other: Vector) -> Self:
        self._xyz = (self + other)._values()
        return self

    def __isub__(self, other: Vector) -> Self:
        self._xyz = (self - other)._values()
        return self

    def __neg__(self) -> Vector:
        return Vector(*(-a for a in self))

    def __mul__(self, other: Any) -> Vector:
        if isinstance(other, Vector):
            (ax, ay, az), (bx, by, bz) = self._xyz, other._xyz
            return Vector(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
        return Vector(*(a * other for a in self)) if _is_number(other) else NotImplemented

    def __rmul__(self, other: Any) -> Vector:
        return Vector(*(a * other for a in self)) if _is_number(other) else NotImplemented

    def __truediv__(self, other: float) -> Vector:
        return self * (1.0 / other) if _is_number(other) else NotImplemented

    def ReverseSign(self) -> None:
        """Change the sign of all components."""
        self._xyz = (-self)._values()

    def Norm(self, eps: float = EPSILON) -> float:
        """Return the length."""
        return math.sqrt(math.fsum(a * a for a in self._xyz))

    def Normalize(self, eps: float = EPSILON) -> float:
        """Change the length to 1 and return the length before; a vector shorter than `eps` becomes (1, 0, 0)."""
        length = self.Norm()
        if length < eps:
            self._xyz = [1.0, 0.0, 0.0]
            return 0.0
        self._xyz = [a / length for a in self._xyz]
        return length


class _VectorPair(_Values):
    """Two vectors that change together: a twist or a wrench."""

    def __init__(self, first: Any = None, second: Vector | None = None) -> None:
        values = first._values() if isinstance(first, type(self)) else [*(first or Vector()), *(second or Vector())]
        self._first, self._second = Vector(*values[:3]), Vector(*values[3:])

    @classmethod
    def Zero(cls) -> Self:
        """Return the twist or wrench with zeros."""
        return cls()

    def _values(self) -> list[float]:
        return [*self._first, *self._second]

    def _vector_of(self, index: int) -> Vector:
        if not 0 <= index < 6:
            raise IndexError(f"{type(self).__name__} index out of range")
        return self._first if index < 3 else self._second

    def __getitem__(self, index: int) -> float:
        return self._vector_of(index)[index % 3]

    def __setitem__(self, index: int, value: float) -> None:
        self._vector_of(index)[index % 3] = value

    def __add__(self, other: Self) -> Self:
        return self._like(self._first + other._first, self._second + other._second)

    def __sub__(self, other: Self) -> Self:
        return self._like(self._first - other._first, self._second - other._second)

    def __iadd__(self, other: Self) -> Self:
        self._first += other._first
        self._second += other._second
        return self

    def __isub__(self, other: Self) -> Self:
        self._first -= other._first
        self._second -= other._second
        return self

    def __neg__(self) -> Self:
        return self._like(-self._first, -self._second)

    def __mul__(self, factor: float) -> Self:
        return self._like(self._first * factor, self._second * factor) if _is_number(factor) else NotImplemented

    __rmul__ = __mul__

    def __truediv__(self, divisor: float) -> Self:
        return self._like(self._first / divisor, self._second / divisor)

    def _like(self, first: Vector, second: Vector) -> Self:
        return type(self)(first, second)

    def ReverseSign(self) -> None:
        """Change the sign of all components."""
        self._first.ReverseSign()
        self._second.ReverseSign()


class Twist(_VectorPair):
    """Velocity `vel` of a reference point [m/s] and angular velocity `rot` [rad/s]."""

    @property
    def vel(self) -> Vector:
        """Velocity of the reference point."""
        return self._first

    @vel.setter
    def vel(self, value: Vector) -> None:
        self._first = Vector(value)

    @property
    def rot(self) -> Vector:
        """Angular velocity."""
        return self._second

    @rot.setter
    def rot(self, value: Vector) -> None:
        self._second = Vector(value)

    def RefPoint(self, base: Vector) -> Twist:
        """Return the twist with another reference point, at `base` from the present one."""
        return Twist(self.vel + self.rot * base, self.rot)


class Wrench(_VectorPair):
    """Force `force` [N] and torque `torque` about a reference point [N m]."""

    @property
    def force(self) -> Vector:
        """Force."""
        return self._first

    @force.setter
    def force(self, value: Vector) -> None:
        self._first = Vector(value)

    @property
    def torque(self) -> Vector:
        """Torque about the reference point."""
        return self._second

    @torque.setter
    def torque(self, value: Vector) -> None:
        self._second = Vector(value)

    def RefPoint(self, base: Vector) -> Wrench:
        """Return the wrench with another reference point, at `base` from the present one."""
        return Wrench(self.force, self.torque + self.force * base)


class Rotation(_Values):
    """Rotation matrix.

    Args:
        numbers: nothing for no rotation, a rotation, the nine numbers row by row, or the three unit vectors.
    """

    __slots__ = ("_rows",)

    def __init__(self, *numbers: Any) -> None:
        if not numbers:
            values = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
        elif len(numbers) == 1 and isinstance(numbers[0], Rotation):
            values = numbers[0]._values()
        elif len(numbers) == 3 and all(isinstance(column, Vector) for column in numbers):
            values = [column[row] for row in range(3) for column in numbers]
        elif len(numbers) == 9:
            values = [float(number) for number in numbers]
        else:
            raise TypeError("Rotation() takes a Rotation, three Vectors or nine numbers")
        self._rows = [values[0:3], values[3:6], values[6:9]]

    def _values(self) -> list[float]:
        return [value for row in self._rows for value in row]

    def __repr__(self) -> str:
        return "[" + ";\n ".join(",".join(f"{value:12g}" for value in row) for row in self._rows) + "]"

    @staticmethod
    def Identity() -> Rotation:
        """Return the rotation by nothing."""
        return Rotation()

    @staticmethod
    def RotX(angle: float) -> Rotation:
        """Return the rotation about x."""
        return Rotation.Rot2(Vector(1.0, 0.0, 0.0), angle)

    @staticmethod
    def RotY(angle: float) -> Rotation:
        """Return the rotation about y."""
        return Rotation.Rot2(Vector(0.0, 1.0, 0.0), angle)

    @staticmethod
    def RotZ(angle: float) -> Rotation:
        """Return the rotation about z."""
        return Rotation.Rot2(Vector(0.0, 0.0, 1.0), angle)

    @staticmethod
    def Rot(rotvec: Vector, angle: float) -> Rotation:
        """Return the rotation about an axis of any length; see `Vector.Normalize` for an axis of length 0."""
        axis = Vector(rotvec)
        axis.Normalize()
        return Rotation.Rot2(axis, angle)

    @staticmethod
    def Rot2(rotvec: Vector, angle: float) -> Rotation:
        """Return the rotation about an axis of length 1."""
        x, y, z = rotvec
        c, s = math.cos(angle), math.sin(angle)
        t = 1.0 - c
        return Rotation(
            c + t * x * x, t * x * y - s * z, t * x * z + s * y,
            t * x * y + s * z, c + t * y * y, t * y * z - s * x,
            t * x * z - s * y, t * y * z + s * x, c + t * z * z,
        )  # fmt: skip

    @staticmethod
    def RPY(roll: float, pitch: float, yaw: float) -> Rotation:
        """Return the rotation about the fixed axes x, y and z, in this order."""
        result: Rotation = Rotation.RotZ(yaw) * Rotation.RotY(pitch) * Rotation.RotX(roll)
        return result

    @staticmethod
    def EulerZYX(alpha: float, beta: float, gamma: float) -> Rotation:
        """Return the rotation about the moving axes z, y and x, in this order."""
        return Rotation.RPY(gamma, beta, alpha)

    @staticmethod
    def EulerZYZ(alpha: float, beta: float, gamma: float) -> Rotation:
        """Return the rotation about the moving axes z, y and z, in this order."""
        result: Rotation = Rotation.RotZ(alpha) * Rotation.RotY(beta) * Rotation.RotZ(gamma)
        return result

    @staticmethod
    def Quaternion(x: float, y: float, z: float, w: float) -> Rotation:
        """Return the rotation of a quaternion of length 1."""
        return Rotation(
            w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),
            2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x),
            2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z,
        )  # fmt: skip

    def DoRotX(self, angle: float) -> None:
        """Rotate further about the own axis x."""
        self._rows = (self * Rotation.RotX(angle))._rows

    def DoRotY(self, angle: float) -> None:
        """Rotate further about the own axis y."""
        self._rows = (self * Rotation.RotY(angle))._rows

    def DoRotZ(self, angle: float) -> None:
        """Rotate further about the own axis z."""
        self._rows = (self * Rotation.RotZ(angle))._rows

    def GetRPY(self) -> tuple[float, float, float]:
        """Return roll, pitch and yaw; the roll is 0 at a pitch of ±90°."""
        (xx, xy, _), (yx, yy, _), (zx, zy, zz) = self._rows
        pitch = math.atan2(-zx, math.hypot(xx, yx))
        if abs(pitch) > math.pi / 2 - 1e-12:
            return 0.0, pitch, math.atan2(-xy, yy)
        return math.atan2(zy, zz), pitch, math.atan2(yx, xx)

    def GetEulerZYX(self) -> tuple[float, float, float]:
        """Return the angles of `EulerZYX`."""
        roll, pitch, yaw = self.GetRPY()
        return yaw, pitch, roll

    def GetEulerZYZ(self) -> tuple[float, float, float]:
        """Return the angles of `EulerZYZ`; the third one is 0 where the axes z are parallel."""
        (xx, _, xz), (yx, _, yz), (zx, zy, zz) = self._rows
        if abs(zz) > 1.0 - 1e-12:
            return (math.atan2(yx, xx), 0.0, 0.0) if zz > 0.0 else (math.atan2(-yx, -xx), math.pi, 0.0)
        return math.atan2(yz, xz), math.atan2(math.hypot(zx, zy), zz), math.atan2(zy, -zx)

    def GetQuaternion(self) -> tuple[float, float, float, float]:
        """Return x, y, z and w; w, or else the largest other number, is positive."""
        m = self._rows
        trace = m[0][0] + m[1][1] + m[2][2]
        if trace > 1e-12:
            w = 0.5 * math.sqrt(trace + 1.0)
            return (m[2][1] - m[1][2]) / (4 * w), (m[0][2] - m[2][0]) / (4 * w), (m[1][0] - m[0][1]) / (4 * w), w
        i = max(range(3), key=lambda axis: m[axis][axis])
        j, k = (i + 1) % 3, (i + 2) % 3
        largest = 0.5 * math.sqrt(1.0 + m[i][i] - m[j][j] - m[k][k])
        result = [0.0, 0.0, 0.0, (m[k][j] - m[j][k]) / (4 * largest)]
        result[i] = largest
        result[j] = (m[i][j] + m[j][i]) / (4 * largest)
        result[k] = (m[i][k] + m[k][i]) / (4 * largest)
        return result[0], result[1], result[2], result[3]

    def GetRotAngle(self, eps: float = EPSILON) -> tuple[float, Vector]:
        """Return the angle from 0 to π and the axis; the axis z for no rotation."""
        m = self._rows
        twice = Vector(m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1])
        trace = m[0][0] + m[1][1] + m[2][2]
        if max(map(abs, twice)) >= eps:
            return math.atan2(twice.Norm(), trace - 1.0), twice / twice.Norm()
        if trace > 1.0:
            return 0.0, Vector(0.0, 0.0, 1.0)
        i = max((2, 1, 0), key=lambda axis: m[axis][axis])
        axis = Vector(*((m[i][j] + m[j][i]) / 4.0 for j in range(3)))
        axis[i] = (m[i][i] + 1.0) / 2.0
        return math.pi, axis / math.sqrt(axis[i])

    def GetRot(self) -> Vector:
        """Return the axis with the angle as its length."""
        angle, axis = self.GetRotAngle()
        return axis * angle

    def Inverse(self, value: Any = None) -> Any:
        """Return the inverse rotation, or a vector, twist or wrench rotated by it."""
        inverse = Rotation(*(self._rows[row][column] for column in range(3) for row in range(3)))
        return inverse if value is None else inverse * value

    def SetInverse(self) -> None:
        """Invert this rotation."""
        self._rows = self.Inverse()._rows

    def _unit(self, column: int, value: Vector | None) -> Any:
        if value is None:
            return Vector(*(row[column] for row in self._rows))
        for row, number in zip(self._rows, value, strict=True):
            row[column] = number
        return None

    def UnitX(self, value: Vector | None = None) -> Any:
        """Return the axis x, or set it."""
        return self._unit(0, value)

    def UnitY(self, value: Vector | None = None) -> Any:
        """Return the axis y, or set it."""
        return self._unit(1, value)

    def UnitZ(self, value: Vector | None = None) -> Any:
        """Return the axis z, or set it."""
        return self._unit(2, value)

    def __getitem__(self, index: tuple[int, int]) -> float:
        row, column = index
        if not (0 <= row < 3 and 0 <= column < 3):
            raise IndexError("Rotation index out of range")
        return self._rows[row][column]

    def __setitem__(self, index: tuple[int, int], value: float) -> None:
        row, column = index
        if not (0 <= row < 3 and 0 <= column < 3):
            raise IndexError("Rotation index out of range")
        self._rows[row][column] = float(value)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Vector):
            x, y, z = other
            return Vector(*(row[0] * x + row[1] * y + row[2] * z for row in self._rows))
        if isinstance(other, _VectorPair):
            return type(other)(self * other._first, self * other._second)
        if isinstance(other, Rotation):
            return Rotation(*(self * other._unit(column, None) for column in range(3)))
        return NotImplemented


class Frame(_Values):
    """Pose: the rotation `M` and the origin `p`.

    Args:
        first: rotation, origin or frame; None for no rotation.
        second: origin after a rotation.
    """

    __slots__ = ("_origin", "_rotation")

    def __init__(self, first: Any = None, second: Vector | None = None) -> None:
        rotation, origin = first, second
        if isinstance(first, Frame):
            rotation, origin = first.M, first.p
        elif isinstance(first, Vector):
            rotation, origin = None, first
        self._rotation = Rotation() if rotation is None else Rotation(rotation)
        self._origin = Vector() if origin is None else Vector(origin)

    @property
    def M(self) -> Rotation:
        """Rotation."""
        return self._rotation

    @M.setter
    def M(self, value: Rotation) -> None:
        self._rotation = Rotation(value)

    @property
    def p(self) -> Vector:
        """Origin."""
        return self._origin

    @p.setter
    def p(self, value: Vector) -> None:
        self._origin = Vector(value)

    def _values(self) -> list[float]:
        return [*self.M._values(), *self.p]

    def __repr__(self) -> str:
        return f"[{self.M!r}\n{self.p!r}]"

    @staticmethod
    def Identity() -> Frame:
        """Return the frame at the origin without rotation."""
        return Frame()

    @staticmethod
    def DH(a: float, alpha: float, d: float, theta: float) -> Frame:
        """Return the frame of Denavit-Hartenberg parameters: about and along z, then along and about x."""
        turned = Frame(Rotation.RotZ(theta), Vector(0.0, 0.0, d))
        return turned * Frame(Rotation.RotX(alpha), Vector(a, 0.0, 0.0))  # type: ignore[no-any-return]

    @staticmethod
    def DH_Craig1989(a: float, alpha: float, d: float, theta: float) -> Frame:
        """Return the frame of Craig's Denavit-Hartenberg parameters: along and about x, then about and along z."""
        moved = Frame(Rotation.RotX(alpha), Vector(a, 0.0, 0.0))
        return moved * Frame(Rotation.RotZ(theta), Vector(0.0, 0.0, d))  # type: ignore[no-any-return]

    def Inverse(self, value: Any = None) -> Any:
        """Return the inverse frame, or a vector, twist or wrench moved by it."""
        turned = self.M.Inverse()
        inverse = Frame(turned, -(turned * self.p))
        return inverse if value is None else inverse * value

    def Integrate(self, twist: Twist, frequency: float) -> None:
        """Move by a twist in the own axes for 1 / `frequency` seconds."""
        turn = Rotation.Rot(twist.rot, twist.rot.Norm() / frequency)
        moved = self * Frame(turn, twist.vel / frequency)
        self.M, self.p = moved.M, moved.p

    def __getitem__(self, index: tuple[int, int]) -> float:
        row, column = index
        if not (0 <= row < 3 and 0 <= column < 4):
            raise IndexError("Frame index out of range")
        return self.p[row] if column == 3 else self.M[row, column]

    def __setitem__(self, index: tuple[int, int], value: float) -> None:
        row, column = index
        if not (0 <= row < 3 and 0 <= column < 4):
            raise IndexError("Frame index out of range")
        if column == 3:
            self.p[row] = value
        else:
            self.M[row, column] = value

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Vector):
            return self.M * other + self.p
        if isinstance(other, Twist):
            rot = self.M * other.rot
            return Twist(self.M * other.vel + self.p * rot, rot)
        if isinstance(other, Wrench):
            force = self.M * other.force
            return Wrench(force, self.M * other.torque + self.p * force)
        if isinstance(other, Frame):
            return Frame(self.M * other.M, self.M * other.p + self.p)
        return NotImplemented


def _is(value: object, kind: type) -> bool:
    return isinstance(value, kind)


def _is_number(value: object) -> bool:
    return hasattr(value, "__float__")


def Equal(first: Any, second: Any, eps: float = EPSILON) -> bool:
    """Check whether the numbers of two objects of the same class differ by less than `eps`."""
    return all(abs(a - b) < eps for a, b in zip(first._values(), second._values(), strict=True))

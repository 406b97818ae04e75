"""Chains and trees of segments of KDL, values of their joints, and Jacobians; their methods have KDL's names."""

from __future__ import annotations

import enum
from collections.abc import Iterator
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from simkit_nodes.ros_modules.PyKDL.frames import Frame, Rotation, Twist, Vector

__all__ = [
    "Chain",
    "Jacobian",
    "JntArray",
    "Joint",
    "Segment",
    "Tree",
]

Floats = npt.NDArray[np.float64]


class JointType(enum.Enum):
    """Motions of joints: about or along an axis of the frame, or about or along any axis."""

    RotAxis = 0
    RotX = 1
    RotY = 2
    RotZ = 3
    TransAxis = 4
    TransX = 5
    TransY = 6
    TransZ = 7
    Fixed = 8


_AXES: Final = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}


class Joint:
    """Joint: its position is `scale` times the value of the joint, plus `offset`.

    Args:
        values: name, which may be missing; origin and axis for `RotAxis` and `TransAxis`; type; then scale, offset,
            inertia, damping and stiffness. A joint is copied, and no value means a fixed joint.
        numbers: the last five by keyword.
    """

    RotAxis, RotX, RotY, RotZ = JointType.RotAxis, JointType.RotX, JointType.RotY, JointType.RotZ
    TransAxis, TransX, TransY, TransZ = JointType.TransAxis, JointType.TransX, JointType.TransY, JointType.TransZ
    Fixed = JointType.Fixed

    def __init__(self, *values: Any, **numbers: float) -> None:
        if len(values) == 1 and isinstance(values[0], Joint):
            self.__dict__.update(values[0].__dict__)
            return
        rest = list(values)
        self._name = rest.pop(0) if rest and isinstance(rest[0], str) else "NoName"
        self._origin, self._axis = Vector(), Vector()
        if rest and isinstance(rest[0], Vector):
            self._origin, self._axis = Vector(rest.pop(0)), Vector(rest.pop(0))
            self._axis.Normalize()
        self._type: JointType = rest.pop(0) if rest else JointType.Fixed
        if self._type.name[-1] in _AXES:
            self._axis = Vector(*_AXES[self._type.name[-1]])
        names = ("scale", "offset", "inertia", "damping", "stiffness")
        factors = dict(zip(names, rest, strict=False)) | numbers
        self._scale, self._offset = factors.get("scale", 1.0), factors.get("offset", 0.0)

    def pose(self, q: float) -> Frame:
        """Return the frame of the joint at a value."""
        value = self._scale * q + self._offset
        if self._type is JointType.Fixed:
            return Frame()
        if self._type.name.startswith("Rot"):
            return Frame(Rotation.Rot2(self._axis, value), self._origin)
        return Frame(self._origin + self._axis * value)

    def twist(self, qdot: float) -> Twist:
        """Return the twist of the joint at a velocity."""
        motion = self._axis * (self._scale * qdot)
        if self._type is JointType.Fixed:
            return Twist()
        return Twist(Vector(), motion) if self._type.name.startswith("Rot") else Twist(motion, Vector())

    def JointAxis(self) -> Vector:
        """Return the axis."""
        return Vector(self._axis)

    def JointOrigin(self) -> Vector:
        """Return a point of the axis."""
        return Vector(self._origin)

    def getName(self) -> str:
        """Return the name."""
        return self._name

    def getType(self) -> JointType:
        """Return the type."""
        return self._type

    def getTypeName(self) -> str:
        """Return the name of the type."""
        return self._type.name if self._type is not JointType.Fixed else "None"

    def __repr__(self) -> str:
        return f"{self._name}:[{self.getTypeName()}, axis: {self._axis!r}, origin{self._origin!r}]"


class Segment:
    """Joint with the rigid link that it moves.

    Args:
        values: name, which may be missing; joint, fixed if it is missing; frame of the tip at the value 0 of the
            joint; inertia, which has no effect. A segment is copied.
    """

    def __init__(self, *values: Any) -> None:
        if len(values) == 1 and isinstance(values[0], Segment):
            self.__dict__.update(values[0].__dict__)
            return
        rest = list(values)
        self._name = rest.pop(0) if rest and isinstance(rest[0], str) else "NoName"
        self._joint = Joint(rest.pop(0)) if rest else Joint()
        tip = rest.pop(0) if rest else Frame()
        self._tip = self._joint.pose(0.0).Inverse() * tip

    def pose(self, q: float) -> Frame:
        """Return the frame of the tip at a value of the joint."""
        return self._joint.pose(q) * self._tip  # type: ignore[no-any-return]

    def twist(self, q: float, qdot: float) -> Twist:
        """Return the twist of the tip at a value and a velocity of the joint, in the axes of the base."""
        return self._joint.twist(qdot).RefPoint(self._joint.pose(q).M * self._tip.p)

    def getFrameToTip(self) -> Frame:
        """Return the frame of the tip at the value 0."""
        return self.pose(0.0)

    def getName(self) -> str:
        """Return the name."""
        return self._name

    def getJoint(self) -> Joint:
        """Return the joint."""
        return self._joint

    def __repr__(self) -> str:
        return f"{self._name}:[{self._joint!r},\n tip: \n{self.getFrameToTip()!r}]"


class Chain:
    """Segments, each of which begins at the tip of the one before.

    Args:
        chain: chain to copy.
    """

    def __init__(self, chain: Chain | None = None) -> None:
        self._segments: list[Segment] = list(chain._segments) if chain is not None else []

    def addSegment(self, segment: Segment) -> None:
        """Add a segment at the end."""
        self._segments.append(Segment(segment))

    def addChain(self, chain: Chain) -> None:
        """Add the segments of a chain."""
        self._segments += chain._segments

    def getNrOfJoints(self) -> int:
        """Return the number of joints that are not fixed."""
        return sum(segment.getJoint().getType() is not JointType.Fixed for segment in self._segments)

    def getNrOfSegments(self) -> int:
        """Return the number of segments."""
        return len(self._segments)

    def getSegment(self, index: int) -> Segment:
        """Return a segment."""
        return self._segments[index]

    def _with_values(self, q: JntArray) -> Iterator[tuple[Segment, float, int | None]]:
        """Yield the segments with the value and the number of their joints; None for a fixed joint."""
        joint = 0
        for segment in self._segments:
            if segment.getJoint().getType() is JointType.Fixed:
                yield segment, 0.0, None
            else:
                yield segment, q[joint], joint
                joint += 1

    def __repr__(self) -> str:
        return "[" + "".join(f"{segment!r}\n" for segment in self._segments) + "]"


class Tree:
    """Segments, each of which begins at the tip of another one or at the root.

    Args:
        root_name: name of the root.
    """

    def __init__(self, root_name: str = "root") -> None:
        self._root, self._segments = root_name, dict[str, tuple[Segment, str]]()

    def addSegment(self, segment: Segment, hook_name: str) -> bool:
        """Add a segment at the tip of another one; return False if that is missing, or if the name exists."""
        name = segment.getName()
        if name in self._segments or (hook_name != self._root and hook_name not in self._segments):
            return False
        self._segments[name] = (Segment(segment), hook_name)
        return True

    def addChain(self, chain: Chain, hook_name: str) -> bool:
        """Add the segments of a chain; see `addSegment`."""
        for number in range(chain.getNrOfSegments()):
            if not self.addSegment(chain.getSegment(number), hook_name):
                return False
            hook_name = chain.getSegment(number).getName()
        return True

    def getNrOfJoints(self) -> int:
        """Return the number of joints that are not fixed."""
        return sum(segment.getJoint().getType() is not JointType.Fixed for segment, _ in self._segments.values())

    def getNrOfSegments(self) -> int:
        """Return the number of segments."""
        return len(self._segments)

    def getChain(self, chain_root: str, chain_tip: str) -> Chain:
        """Return the chain from a segment to another one that follows it.

        Raises:
            RuntimeError: the tip does not follow the root.
        """
        names, name = list[str](), chain_tip
        while name != chain_root:
            if name not in self._segments:
                raise RuntimeError(f"no chain from {chain_root!r} to {chain_tip!r}")
            names.append(name)
            name = self._segments[name][1]
        chain = Chain()
        for name in reversed(names):
            chain.addSegment(self._segments[name][0])
        return chain


class JntArray:
    """Values of joints.

    Args:
        size: number of joints, or an array to copy.
    """

    def __init__(self, size: int | JntArray = 0) -> None:
        self._array: Floats = size._array.copy() if isinstance(size, JntArray) else np.zeros(size)

    def rows(self) -> int:
        """Return the number of joints."""
        return len(self._array)

    def columns(self) -> int:
        """Return 1."""
        return 1

    def resize(self, size: int) -> None:
        """Change the number of joints; new ones are 0."""
        values = self._array[:size]
        self._array = np.zeros(size)
        self._array[: len(values)] = values

    def _checked(self, index: int) -> int:
        if not 0 <= index < len(self._array):
            raise IndexError("JntArray index out of range")
        return index

    def __getitem__(self, index: int) -> float:
        return float(self._array[self._checked(index)])

    def __setitem__(self, index: int, value: float) -> None:
        self._array[self._checked(index)] = value

    def __isub__(self, other: JntArray) -> JntArray:
        self._array -= other._array
        return self

    def _values(self) -> list[float]:
        return [float(value) for value in self._array]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, JntArray) and np.allclose(self._array, other._array, rtol=0.0, atol=1e-6)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return "[" + "".join(f"{value:12g}" for value in self._array) + "]"


class Jacobian:
    """Twists of the tip, one column for each joint.

    Args:
        nr_columns: number of joints, or a Jacobian to copy.
    """

    def __init__(self, nr_columns: int | Jacobian = 0) -> None:
        is_copy = isinstance(nr_columns, Jacobian)
        self._matrix: Floats = nr_columns._matrix.copy() if is_copy else np.zeros((6, nr_columns))  # type: ignore[union-attr, arg-type]

    def rows(self) -> int:
        """Return 6."""
        return 6

    def columns(self) -> int:
        """Return the number of joints."""
        return int(self._matrix.shape[1])

    def resize(self, nr_columns: int) -> None:
        """Change the number of joints; all numbers become 0."""
        self._matrix = np.zeros((6, nr_columns))

    def getColumn(self, index: int) -> Twist:
        """Return the twist of a joint."""
        column = self._matrix[:, index]
        return Twist(Vector(*column[:3]), Vector(*column[3:]))

    def setColumn(self, index: int, t: Twist) -> None:
        """Set the twist of a joint."""
        self._matrix[:, index] = t._values()

    def _transform(self, function: Any) -> None:
        for column in range(self.columns()):
            self.setColumn(column, function(self.getColumn(column)))

    def changeRefPoint(self, base: Vector) -> None:
        """Move the reference point; see `Twist.RefPoint`."""
        self._transform(lambda twist: twist.RefPoint(base))

    def changeBase(self, rot: Rotation) -> None:
        """Rotate all twists."""
        self._transform(lambda twist: rot * twist)

    def changeRefFrame(self, frame: Frame) -> None:
        """Move all twists to another frame."""
        self._transform(lambda twist: frame * twist)

    def __getitem__(self, index: tuple[int, int]) -> float:
        return float(self._matrix[index])

    def __setitem__(self, index: tuple[int, int], value: float) -> None:
        self._matrix[index] = value

    def __isub__(self, other: Jacobian) -> Jacobian:
        self._matrix -= other._matrix
        return self

    def __repr__(self) -> str:
        rows = ("".join(f"{value:12g}" for value in row) + "\n" for row in self._matrix)
        return "[" + "".join(rows) + "]"

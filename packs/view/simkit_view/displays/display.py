"""Base of the displays: what they take and how frames are found."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import ClassVar, Final, Protocol

import numpy as np

from simkit import Pose
from simkit.errors import SimkitError
from simkit.extend import counted
from simkit.msgs import Message
from simkit.pose import IDENTITY
from simkit_view.displays.drawing import Arrays, Colour, Drawing, Floats
from simkit_view.displays.frame_poses import Placement

Finder = Callable[[str], Placement | None]
"""Function that returns the placement of a frame; None for an unknown frame."""
MeshReader = Callable[[str], Arrays]
"""Function that returns the corners and colours of a mesh file by its URI; it raises SimkitError."""

_ZERO_NORM: Final = 1e-9


class DisplayTools(Protocol):
    """Functions that displays use.

    Attributes:
        find: function that returns the link of a frame and the frame's pose in it.
        world_pose: function that returns the present pose of a placement in the world.
        read_mesh: function that reads a mesh file by its URI.
    """

    @property
    def find(self) -> Finder: ...

    @property
    def world_pose(self) -> Callable[[Placement], Pose]: ...

    @property
    def read_mesh(self) -> MeshReader: ...


class Display:
    """Display of the messages of one topic.

    Args:
        topic: name of the topic.
        tools: functions for frames and meshes.

    Attributes:
        types: types of the messages.
        has_changed: True if the drawing differs from the last one.
    """

    types: ClassVar[tuple[str, ...]] = ()

    def __init__(self, topic: str, tools: DisplayTools) -> None:
        self.topic, self.tools = topic, tools
        self.has_changed = False

    def take(self, message: Message, time_ns: int) -> None:
        """Store a message that was received at a simulated time [ns]; frames are where they are now."""
        raise NotImplementedError

    def draw(self, drawing: Drawing, time_ns: int) -> None:
        """Draw the present content."""
        raise NotImplementedError

    def expires(self, time_ns: int) -> bool:
        """Check whether something disappears up to a time [ns]."""
        return False

    def fixed(self, frame: str) -> Placement | None:
        """Return the present placement of a frame in the world; None if the frame is unknown."""
        frame_pose = self.tools.find(frame)
        return None if frame_pose is None else Placement("", self.tools.world_pose(frame_pose))


class NewestMessage(Display):
    """Display of the newest message, where its frame was when the message arrived."""

    def __init__(self, topic: str, tools: DisplayTools) -> None:
        super().__init__(topic, tools)
        self._message: Message | None = None
        self._at: Placement | None = None

    def take(self, message: Message, time_ns: int) -> None:
        self._message, self._at, self.has_changed = message, self._place(message), True

    def draw(self, drawing: Drawing, time_ns: int) -> None:
        if self._message is None:
            return
        if self._at is None:
            self._at = self._place(self._message)
        if self._at is None:
            drawing.tell(unknown_frame(frame_of(self._message)))
            return
        self.draw_message(drawing, self._message, self._at)

    def expires(self, time_ns: int) -> bool:
        return self._message is not None and self._at is None  # the frame may be known now

    def draw_message(self, drawing: Drawing, message: Message, at: Placement) -> None:
        """Draw a message at the placement of its frame."""
        raise NotImplementedError

    def _place(self, message: Message) -> Placement | None:
        return self.fixed(frame_of(message))


def frame_of(message: Message) -> str:
    """Return the frame of a message; that of the world for a message without a header."""
    return str(message.header.frame_id) if hasattr(message, "header") else "world"


def unknown_frame(frame: str) -> str:
    """Return the problem of a message whose frame is unknown."""
    return f"the frame {frame!r:.80} is unknown" if frame else "the message names no frame"


def pose_of(message: Message, drawing: Drawing) -> Pose | None:
    """Return the pose of a `geometry_msgs/msg/Pose`; one without a rotation is upright; None, told, if it has NaN."""
    place, turn = message.position, message.orientation
    quaternion = (turn.w, turn.x, turn.y, turn.z)
    norm = math.hypot(*quaternion)
    if not math.isfinite(norm) or not all(map(math.isfinite, (place.x, place.y, place.z))):
        drawing.tell("poses with NaN or infinite values are not drawn")
        return None
    if norm < _ZERO_NORM:
        drawing.tell("a quaternion of zeros is drawn without a rotation")
        return Pose((place.x, place.y, place.z))
    try:
        return Pose((place.x, place.y, place.z), quaternion)
    except SimkitError:
        drawing.tell("poses with NaN or infinite values are not drawn")
        return None


def pose_rows(poses: Sequence[Message], most: int, drawing: Drawing) -> tuple[Floats, Floats]:
    """Return positions, shape (n, 3), and rotation matrices, shape (n, 3, 3), of poses; of too many, every n-th."""
    if (step := 1 + (len(poses) - 1) // most) > 1:
        drawing.tell(f"of {counted(len(poses), 'pose')} every {step}th is drawn")
        poses = poses[::step]
    rows = np.array(
        [(p.position.x, p.position.y, p.position.z, q.w, q.x, q.y, q.z) for p in poses for q in (p.orientation,)],
        np.float64,
    ).reshape(-1, 7)
    is_finite = np.isfinite(rows).all(axis=1)
    if not is_finite.all():
        drawing.tell("poses with NaN or infinite values are not drawn")
    rows = rows[is_finite]
    norms = np.linalg.norm(rows[:, 3:], axis=1, keepdims=True)
    rows[:, 3:] = np.where(norms > _ZERO_NORM, rows[:, 3:] / np.maximum(norms, _ZERO_NORM), (1.0, 0.0, 0.0, 0.0))
    return rows[:, :3], _matrices(rows[:, 3:])


def _matrices(q: Floats) -> Floats:
    w, x, y, z = q.T
    columns = (
        *(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        *(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        *(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack(columns, axis=1).reshape(-1, 3, 3)


def draw_arrow(
    drawing: Drawing, at: Placement, pose: Pose, sizes: tuple[float, float, float, float], colour: Colour
) -> None:
    """Draw an arrow along the x axis of a pose.

    Args:
        drawing: drawing.
        at: frame of the pose.
        pose: pose of the arrow's begin.
        sizes: length of the shaft, diameter of the shaft, length of the head, diameter of the head [m].
        colour: RGBA.
    """
    shaft, thin, head, wide = sizes
    half = math.sqrt(0.5)
    along = pose @ Pose(IDENTITY.position, (half, 0.0, half, 0.0))  # turns z to x
    for shape, centre, length, diameter in (
        ("cylinder", shaft / 2, shaft, thin),
        ("cone", shaft + head / 2, head, wide),
    ):
        place = along.transform((0.0, 0.0, centre))
        row = np.array([*place, *along.quaternion, diameter, diameter, length, *colour])
        drawing.shapes(shape, at, row)

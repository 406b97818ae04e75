"""Display of interactive markers: their drawings, and the handles by which a page moves them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Pose
from simkit.msgs import Message
from simkit.pose import quat_rotate
from simkit.run_spec import JsonObject
from simkit_view.displays.display import Display, DisplayTools, pose_of, unknown_frame
from simkit_view.displays.drawing import Drawing
from simkit_view.displays.frame_poses import Placement
from simkit_view.displays.marker_display import draw_marker

UPDATE: Final = "/update"
FEEDBACK: Final = "/feedback"
_INITIAL_SERVICE: Final = "/get_interactive_markers"
_MENU, _BUTTON, _MOVE_AXIS, _MOVE_PLANE, _ROTATE_AXIS, _MOVE_ROTATE = 1, 2, 3, 4, 5, 6
_MOVE_3D, _ROTATE_3D, _MOVE_ROTATE_3D = 7, 8, 9
_FIXED: Final = 1  # orientation of a control that does not turn with its marker
_ALL: Final = (True, True, True)
_MOST: Final = 1000  # markers
_GREY: Final = (0.5, 0.7, 0.9, 0.6)
_BALL: Final = 0.25  # diameter of the ball of a marker without a drawing, by its scale
_TEXT_HEIGHT: Final = 0.15  # of the description, by the scale of the marker
_TEXT_PLACE: Final = 0.7  # of the description above the marker, by its scale


@dataclass(slots=True)
class _Interactive:
    """Interactive marker.

    Attributes:
        message: message; its pose and header may be older than these.
        header: header of the newest pose.
        pose: newest pose, in the frame of the header.
        at: placement of that frame; None while the frame is unknown.
    """

    message: Message
    header: Message
    pose: Message
    at: Placement | None


class InteractiveMarkerDisplay(Display):
    """Interactive markers of a server, with the changes that it publishes.

    Drawn are the markers of the controls and the description. A marker whose controls have no markers is a ball.
    """

    types = ("visualization_msgs/msg/InteractiveMarkerUpdate",)

    def __init__(self, topic: str, tools: DisplayTools) -> None:
        super().__init__(topic, tools)
        self._markers: dict[str, _Interactive] = {}
        self._problems: dict[str, None] = {}
        self.initial_service = topic.removesuffix(UPDATE) + _INITIAL_SERVICE

    def take_initial(self, response: Message) -> None:
        """Store the markers of a server that were there before the first update."""
        for marker in response.markers:
            if marker.name not in self._markers:
                self._add(marker)

    def take(self, message: Message, time_ns: int) -> None:
        self.has_changed = True
        for marker in message.markers:
            self._add(marker)
        for change in message.poses:
            known = self._markers.get(str(change.name))
            if known is not None:
                known.pose, known.header, known.at = change.pose, change.header, self._place(change.header)
        for name in message.erases:
            self._markers.pop(str(name), None)

    def _add(self, marker: Message) -> None:
        if marker.name not in self._markers and len(self._markers) >= _MOST:
            self._problems[f"only {_MOST} interactive markers are drawn"] = None
            return
        self._markers[str(marker.name)] = _Interactive(marker, marker.header, marker.pose, self._place(marker.header))
        self.has_changed = True

    def _place(self, header: Message) -> Placement | None:
        """Return the placement of a marker's frame, which the marker follows if its header has no time."""
        stamp = header.stamp
        follows = stamp.sec == 0 and stamp.nanosec == 0
        frame = str(header.frame_id)
        return self.tools.find(frame) if follows else self.fixed(frame)

    def expires(self, time_ns: int) -> bool:
        return any(marker.at is None for marker in self._markers.values())

    def pose_in_frame(self, name: str, pose: Pose) -> tuple[Message, str, Pose] | None:
        """Return a marker's message, its frame, and a pose of the world in this frame; None for an unknown marker."""
        known = self._markers.get(name)
        if known is None or known.at is None:
            return None
        return known.message, str(known.header.frame_id), self.tools.world_pose(known.at).inverse() @ pose

    def draw(self, drawing: Drawing, time_ns: int) -> None:
        for problem in self._problems:
            drawing.tell(problem)
        for name, known in self._markers.items():
            if known.at is None:
                known.at = self._place(known.header)
            pose = None if known.at is None else pose_of(known.pose, drawing)
            if known.at is None:
                drawing.tell(unknown_frame(str(known.header.frame_id)))
            elif pose is not None:
                self._draw_marker(drawing, name, known.message, Placement(known.at.link, known.at.pose @ pose))

    def _draw_marker(self, drawing: Drawing, name: str, message: Message, at: Placement) -> None:
        scale, has_drawing = float(message.scale) or 1.0, False
        for control in message.controls:
            for number, marker in enumerate(control.markers):
                frame = str(marker.header.frame_id)
                place = at if not frame else self.tools.find(frame)
                if place is None:
                    drawing.tell(unknown_frame(frame))
                    continue
                has_drawing = True
                draw_marker(drawing, marker, place, f"{name}/{control.name}/{number}", self.tools)
        if not has_drawing:
            size = _BALL * scale
            drawing.shapes("sphere", at, np.array([0, 0, 0, 1, 0, 0, 0, size, size, size, *_GREY], np.float64))
        if message.description:
            text = str(message.description), _TEXT_HEIGHT * scale, (1.0, 1.0, 1.0, 1.0)
            drawing.text(at, (0.0, 0.0, _TEXT_PLACE * scale), *text)
        drawing.handle(at, _handle(name, message))


def _handle(name: str, message: Message) -> JsonObject:
    """Return what a page may do with a marker: axes of motions and rotations, a button, and the entries of its menu."""
    move, turn = np.zeros(3, bool), np.zeros(3, bool)
    for control in message.controls:
        mode, axis = int(control.interaction_mode), _axis(control.orientation)
        move |= {_MOVE_AXIS: axis, _MOVE_PLANE: ~axis, _MOVE_ROTATE: ~axis}.get(
            mode, mode in (_MOVE_3D, _MOVE_ROTATE_3D)
        )
        turn |= {_ROTATE_AXIS: axis, _MOVE_ROTATE: axis}.get(mode, mode in (_ROTATE_3D, _MOVE_ROTATE_3D))
    modes = {int(control.interaction_mode) for control in message.controls}
    is_fixed = any(control.orientation_mode == _FIXED for control in message.controls)
    entries = [[int(e.id), int(e.parent_id), str(e.title)] for e in message.menu_entries]
    return {
        "name": name,
        "description": str(message.description) or name,
        "move": move.tolist(),
        "turn": turn.tolist(),
        "space": "world" if is_fixed else "local",
        "button": _BUTTON in modes,
        "menu": entries,
    }


def _axis(orientation: Message) -> npt.NDArray[np.bool_]:
    """Return which axis of its marker the x axis of a control is closest to, shape (3,)."""
    q = orientation.w, orientation.x, orientation.y, orientation.z
    ahead = np.abs(quat_rotate(q, (1.0, 0.0, 0.0))) if any(q) else np.array((1.0, 0.0, 0.0))
    found = np.zeros(3, np.bool_)
    found[int(np.argmax(ahead))] = True
    return found


def control_for(message: Message, event: str) -> str:
    """Return the name of the control that an event belongs to; empty for none."""
    wanted = {"menu_select": (_MENU,), "button_click": (_BUTTON,)}.get(
        event, tuple(range(_MOVE_AXIS, _MOVE_ROTATE_3D + 1))
    )
    names = [str(c.name) for c in message.controls if int(c.interaction_mode) in wanted]
    return names[0] if names else str(message.controls[0].name) if len(message.controls) else ""

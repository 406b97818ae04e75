"""Display of `visualization_msgs/Marker` and `MarkerArray`, as RViz draws them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from simkit import Pose
from simkit.errors import SimkitError
from simkit.extend import counted
from simkit.linear_algebra import norm
from simkit.msgs import Message
from simkit.pose import IDENTITY
from simkit_view.displays.display import Display, DisplayTools, draw_arrow, pose_of, unknown_frame
from simkit_view.displays.drawing import Colour, Drawing, Floats
from simkit_view.displays.frame_poses import Placement

_ADD, _DELETE, _DELETE_ALL = 0, 2, 3
_NS: Final = 1_000_000_000
_MOST: Final = 10_000  # markers
_MOST_POINTS: Final = 199_998  # points of one marker, whole lines and triangles; those at the end are left out
_HEAD_SHARE: Final = 0.23  # of the length of an arrow, as in RViz
_HEAD_RATIO: Final = 2.0  # diameter of the head by that of the shaft
_TEXT_HEIGHT: Final = 1.0


@dataclass(slots=True)
class _Marker:
    """Marker with its placement.

    Attributes:
        message: message.
        at: placement of the marker's frame; None while the frame is unknown.
        end_ns: time at which the marker disappears [ns]; None for never.
    """

    message: Message
    at: Placement | None
    end_ns: int | None


class MarkerDisplay(Display):
    """Markers by their namespaces and ids, with lifetimes, deletions and frames that markers follow."""

    types = ("visualization_msgs/msg/MarkerArray", "visualization_msgs/msg/Marker")

    def __init__(self, topic: str, tools: DisplayTools) -> None:
        super().__init__(topic, tools)
        self._markers: dict[tuple[str, int], _Marker] = {}
        self._problems: dict[str, None] = {}
        self._time_ns = 0

    def take(self, message: Message, time_ns: int) -> None:
        if time_ns < self._time_ns:  # a reset: what was shown belongs to another run
            self._markers.clear()
        self._time_ns = time_ns
        if not self._markers:
            self._problems.clear()
        array = message
        self.has_changed = True
        for marker in array.markers if hasattr(array, "markers") else (array,):
            self._take_marker(marker, time_ns)

    def _take_marker(self, marker: Message, time_ns: int) -> None:
        key = str(marker.ns), int(marker.id)
        if marker.action == _ADD:
            if key not in self._markers and len(self._markers) >= _MOST:
                self._problems[f"only {_MOST} markers are drawn"] = None
                return
            lifetime = marker.lifetime.sec * _NS + marker.lifetime.nanosec
            end = time_ns + lifetime if lifetime > 0 else None
            self._markers[key] = _Marker(marker, self._place(marker), end)
        elif marker.action == _DELETE:
            self._markers.pop(key, None)
        elif marker.action == _DELETE_ALL:
            for entry in [k for k in self._markers if marker.ns in ("", k[0])]:
                del self._markers[entry]
        else:
            self._problems[f"the action {marker.action} of a marker is unknown"] = None

    def _place(self, marker: Message) -> Placement | None:
        frame = str(marker.header.frame_id)
        return self.tools.find(frame) if marker.frame_locked else self.fixed(frame)

    def expires(self, time_ns: int) -> bool:
        return any(m.at is None or (m.end_ns is not None and m.end_ns <= time_ns) for m in self._markers.values())

    def draw(self, drawing: Drawing, time_ns: int) -> None:
        for key in [k for k, m in self._markers.items() if m.end_ns is not None and m.end_ns <= time_ns]:
            del self._markers[key]
        for problem in self._problems:
            drawing.tell(problem)
        for (ns, number), marker in self._markers.items():
            if marker.at is None:
                marker.at = self._place(marker.message)
            if marker.at is None:
                drawing.tell(unknown_frame(str(marker.message.header.frame_id)))
                continue
            draw_marker(drawing, marker.message, marker.at, f"{ns}/{number}", self.tools)


def draw_marker(drawing: Drawing, message: Message, at: Placement, name: str, tools: DisplayTools) -> None:
    """Draw a `visualization_msgs/msg/Marker` in a frame; what cannot be drawn is told with its name."""
    pose = pose_of(message.pose, drawing)
    if pose is None:
        return
    kind = int(message.type)
    if kind not in _KINDS:
        drawing.tell(f"marker {name}: the type {kind} is unknown")
        return
    colour = _colour(message.color)
    if not all(map(math.isfinite, colour)):
        drawing.tell(f"marker {name}: its colour has NaN or infinite values")
        return
    if colour[3] <= 0 and not len(message.colors) and not (kind == _MESH and message.mesh_use_embedded_materials):
        drawing.tell(f"marker {name} is fully transparent: its color.a is 0")
        return
    scale = np.array([message.scale.x, message.scale.y, message.scale.z], np.float64)
    if kind in _SIZED and (scale[: _SIZED[kind]] == 0).any():
        drawing.tell(f"marker {name}: its scale {scale.tolist()} has a 0")
        return
    placed = Placement(at.link, at.pose @ pose)
    _KINDS[kind](drawing, message, placed, scale, colour, tools)


def _colour(colour: Message) -> Colour:
    return colour.r, colour.g, colour.b, colour.a


def _points(message: Message) -> Floats:
    points = message.points[:_MOST_POINTS]
    return np.array([(p.x, p.y, p.z) for p in points], np.float64).reshape(-1, 3)


def _colours(message: Message, colour: Colour, count: int) -> Floats:
    """Return the colour of each point: its own ones if each point has one."""
    if len(message.colors) != len(message.points):
        return np.broadcast_to(np.array(colour), (count, 4))
    return np.array([_colour(message_colour) for message_colour in message.colors[:count]], np.float64).reshape(-1, 4)


def _draw_arrow(drawing: Drawing, message: Message, at: Placement, scale: Floats, colour: Colour, _: object) -> None:
    points = _points(message)
    if len(points) == 1 or len(points) > 2:
        drawing.tell("an arrow has no points, or a begin and an end")
        return
    if len(points) == 0:
        length, width, height = (float(v) for v in scale)
        thin = math.sqrt(abs(width * height)) or abs(width)
        head = _HEAD_SHARE * length
        draw_arrow(drawing, at, IDENTITY, (length - head, thin / _HEAD_RATIO, head, thin), colour)
        return
    vector = points[1] - points[0]
    length = norm(vector)
    if not math.isfinite(length) or length == 0:
        drawing.tell("an arrow without a length is not drawn")
        return
    head = min(float(scale[2]) or _HEAD_SHARE * length, length)
    sizes = length - head, float(scale[0]), head, float(scale[1]) or _HEAD_RATIO * float(scale[0])
    draw_arrow(drawing, at, Pose(points[0], _turn_to(vector / length)), sizes, colour)


def _turn_to(direction: Floats) -> tuple[float, float, float, float]:
    """Return the quaternion of the shortest rotation from the x axis to a direction."""
    x, y, z = (float(v) for v in direction)
    if x < -1 + 1e-12:
        return 0.0, 0.0, 0.0, 1.0
    return 1 + x, 0.0, -z, y


def _shape(name: str) -> Callable[..., None]:
    def draw(drawing: Drawing, _message: Message, at: Placement, scale: Floats, colour: Colour, _: object) -> None:
        drawing.shapes(name, at, np.array([0, 0, 0, 1, 0, 0, 0, *scale, *colour], np.float64))

    return draw


def _shape_list(name: str) -> Callable[..., None]:
    def draw(drawing: Drawing, message: Message, at: Placement, scale: Floats, colour: Colour, _: object) -> None:
        points = _points(message)
        rows = np.zeros((len(points), 14))
        rows[:, :3], rows[:, 3], rows[:, 7:10] = points, 1.0, scale
        rows[:, 10:] = _colours(message, colour, len(points))
        drawing.shapes(name, at, rows)

    return draw


def _draw_strip(drawing: Drawing, message: Message, at: Placement, scale: Floats, colour: Colour, _: object) -> None:
    points = _points(message)
    drawing.strip(at, points, _colours(message, colour, len(points)), float(scale[0]))


def _draw_lines(drawing: Drawing, message: Message, at: Placement, scale: Floats, colour: Colour, _: object) -> None:
    points = _points(message)
    if len(points) % 2:
        drawing.tell("a line list has an odd number of points")
    drawing.lines(at, points, _colours(message, colour, len(points)), float(scale[0]))


def _draw_points(drawing: Drawing, message: Message, at: Placement, scale: Floats, colour: Colour, _: object) -> None:
    points = _points(message)
    drawing.points(at, points, _colours(message, colour, len(points)), float(max(scale[0], scale[1])))


def _draw_text(drawing: Drawing, message: Message, at: Placement, scale: Floats, colour: Colour, _: object) -> None:
    drawing.text(at, (0.0, 0.0, 0.0), str(message.text), float(scale[2]) or _TEXT_HEIGHT, colour)


def _draw_triangles(
    drawing: Drawing, message: Message, at: Placement, scale: Floats, colour: Colour, _: object
) -> None:
    points = _points(message)
    if len(points) % 3:
        drawing.tell(f"a triangle list has {counted(len(points), 'point')}, which is not a multiple of 3")
        return
    colours = _colours(message, colour, len(points))
    if 3 * len(message.colors) == len(message.points):
        colours = np.array(
            [_colour(message_colour) for message_colour in message.colors[: len(points) // 3]], np.float64
        )
        colours = colours.repeat(3, axis=0)
    drawing.triangles(at, points * np.where(scale == 0, 1.0, scale), colours)


def _draw_mesh(
    drawing: Drawing, message: Message, at: Placement, scale: Floats, colour: Colour, tools: DisplayTools
) -> None:
    uri = str(message.mesh_resource)
    try:
        parts = dict(tools.read_mesh(uri))
    except SimkitError as error:
        drawing.tell(f"the mesh {uri!r:.120} cannot be drawn: {error.args[0] if error.args else error!s:.300}")
        return
    if message.mesh_use_embedded_materials:
        colour = (1.0, 1.0, 1.0, colour[3] or 1.0)
    else:
        parts, uri = {**parts, "colours": np.full_like(parts["colours"], 255)}, f"{uri} in one colour"
    drawing.mesh(at, uri, parts, np.array([0, 0, 0, 1, 0, 0, 0, *scale, *colour], np.float64))


_MESH: Final = 10
_SIZED: Final = {1: 3, 2: 3, 3: 3, 4: 1, 5: 1, 6: 3, 7: 3, 8: 2, _MESH: 3}  # numbers of the scale that must not be 0
_KINDS: Final[dict[int, Callable[..., None]]] = {
    0: _draw_arrow,
    1: _shape("cube"),
    2: _shape("sphere"),
    3: _shape("cylinder"),
    4: _draw_strip,
    5: _draw_lines,
    6: _shape_list("cube"),
    7: _shape_list("sphere"),
    8: _draw_points,
    9: _draw_text,
    _MESH: _draw_mesh,
    11: _draw_triangles,
    12: _draw_strip,
}
"""Function for each type of marker."""

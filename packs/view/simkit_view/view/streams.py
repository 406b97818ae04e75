"""Streams: data that pages ask for, besides the states. A stream reads nothing while no page shows it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Final, TypeVar

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.errors import SimkitError
from simkit.linear_algebra import matmul
from simkit.msgs import Message
from simkit.run_spec import JsonObject
from simkit.runtime.communication.transform_buffer import TransformBuffer
from simkit_view.displays.frame_poses import FramePoses
from simkit_view.view.graph_streams import GRAPH_STREAMS
from simkit_view.view.packet import Arrays, Stream, make_packet
from simkit_view.view.series_stream import SERIES_STREAMS
from simkit_view.view.topic_display import DisplayList, TopicDisplay
from simkit_view.view.topic_streams import TOPIC_STREAMS

if TYPE_CHECKING:
    from simkit import Pose, Simulation

_MOST_LIDARS: Final = 16  # lidars in one packet: 100 scans a frame take longer than the frame
_MOST_POINTS: Final = 60_000  # points of a cloud; of a larger one every n-th is sent
_MOST_CONTACTS: Final = 500
_JPEG_QUALITY: Final = 80
_SINGLE_LAYER: Final = 1


StreamMaker = Callable[[str], Stream]
"""Function that returns the source of a stream; its argument is the name of the stream after the colon."""


Number = TypeVar("Number", bound=np.generic)


class LidarStream:
    """Ends of the rays of lidars, in the world at the time of their samples.

    Options: names of the lidars. A lidar with several layers sends only the rays that hit something; the rays of a
    single layer without a range are NaN, so that neighbours stay neighbours.
    """

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim = sim
        self._seen: dict[str, tuple[int, npt.NDArray[np.generic], npt.NDArray[np.generic]]] = {}

    def packet(self, options: Sequence[object]) -> bytes | None:
        names = dict.fromkeys(name for option in options for name in _texts(option))
        sensors, is_new = self._sim.contents.sensors, False
        for name in list(names)[:_MOST_LIDARS]:
            sensor: Any = sensors.get(name)
            if sensor is not None and hasattr(sensor, "ray_ends"):
                is_new |= self._read(name, sensor)
        shown = [name for name in self._seen if name in names]
        is_new |= len(shown) < len(self._seen)
        self._seen = {name: self._seen[name] for name in shown}
        if not is_new:
            return None
        rows = [[name, len(self._seen[name][2])] for name in shown]
        points = [self._seen[name][2] for name in shown]
        arrays = {
            "points": np.concatenate(points) if points else np.zeros((0, 3)),
            "origins": np.array([self._seen[name][1] for name in shown]).reshape(-1, 3),
        }
        return make_packet({"kind": "lidar", "lidars": rows, "time": self._sim.time}, arrays)

    def _read(self, name: str, sensor: Any) -> bool:
        """Read a lidar; return True if it has a new sample."""
        index = sensor.count
        if name in self._seen and self._seen[name][0] == index:
            return False
        ends = sensor.ray_ends()
        if ends is None:
            return False
        if sensor.options.vertical.samples > _SINGLE_LAYER:
            ends = _thinned(ends[np.isfinite(ends[:, 0])])
        pose: Pose = sensor.pose
        self._seen[name] = (index, pose.position, matmul(ends, pose.matrix.T) + pose.position)
        return True

    def close(self) -> None:
        self._seen.clear()


class RangeStream:
    """Ranges of the sonars [m], by the order of the option; infinite ranges are -1. Options: names of the sonars."""

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim, self._sent = sim, b""

    def packet(self, options: Sequence[object]) -> bytes | None:
        names = dict.fromkeys(name for option in options for name in _texts(option))
        ranges = {}
        for name in names:
            sensor: Any = self._sim.contents.sensors.get(name)
            message = None if sensor is None else sensor.latest
            if message is not None and hasattr(message, "range"):
                ranges[name] = float(message.range) if np.isfinite(message.range) else -1.0
        packet = make_packet({"kind": "ranges", "ranges": ranges}, {})
        if packet == self._sent:
            return None
        self._sent = packet
        return packet

    def close(self) -> None:
        """Nothing is open."""


class ContactStream:
    """Contacts: position, normal and force on the second collision [N], all in the world."""

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim, self._tick = sim, -1

    def packet(self, options: Sequence[object]) -> bytes | None:
        sim = self._sim
        if sim.tick == self._tick:
            return None
        self._tick = sim.tick
        model, data = sim.mj_model, sim.engine.physics.fresh()
        count = min(data.ncon, _MOST_CONTACTS)
        normals = data.contact.frame[:count, :3]
        forces, local = np.zeros((count, 3)), np.zeros(6)
        for contact in range(count):
            mujoco.mj_contactForce(model, data, contact, local)
            forces[contact] = matmul(data.contact.frame[contact].reshape(3, 3).T, local[:3])
        arrays = {"position": data.contact.pos[:count], "normal": normals, "force": forces}
        return make_packet({"kind": "contacts", "time": sim.time}, arrays)

    def close(self) -> None:
        """Nothing is open."""


class JointStream:
    """Positions of the joints that the scene lists: rad or m; NaN for joints with several axes."""

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim, self._sent = sim, b""
        self._joints = [j for j in sim.contents.handles.tables["joint"].values() if j.dof > 0]

    def packet(self, options: Sequence[object]) -> bytes | None:
        values = np.array([float(j.position) if j.dof == 1 else np.nan for j in self._joints], np.float32)
        packet = make_packet({"kind": "joints"}, {"position": values})
        if packet == self._sent:
            return None
        self._sent = packet
        return packet

    def close(self) -> None:
        """Nothing is open."""


class ImageStream:
    """Picture of a camera as the sensor sees it, JPEG; `image:NAME`. Rendering it costs the run time."""

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim, self._name = sim, name
        self._seen: object = None

    def packet(self, options: Sequence[object]) -> bytes | None:
        import cv2

        stream, sensor = f"image:{self._name}", self._sim.contents.sensors.get(self._name)
        if sensor is None or not sensor.needs_renderer:
            return self._error(stream, f"no camera {self._name!r}")
        try:
            if self._seen is None:
                sensor.check_available()
            message = sensor.latest
            if message is None or message is self._seen:
                return None
            pixels = _as_bytes(msgs.image(message))
        except SimkitError as error:
            return self._error(stream, str(error))
        self._seen = message
        order = pixels[:, :, ::-1] if pixels.ndim == 3 else pixels
        jpeg = cv2.imencode(".jpg", np.ascontiguousarray(order), [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])[1]
        return make_packet({"kind": stream, "time": self._sim.time}, {"jpeg": jpeg.reshape(-1)})

    def _error(self, stream: str, text: str) -> bytes | None:
        if self._seen == text:
            return None
        self._seen = text
        return make_packet({"kind": stream, "error": text}, {})

    def close(self) -> None:
        """Nothing is open."""


class CloudStream:
    """Points of a `PointCloud2` in the world, with colours where it has them; `cloud:TOPIC`."""

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim, self._topic = sim, name
        self._subscription = sim.subscribe(name, keep=1)
        self._tree = TransformBuffer(sim.communication.bus, lambda: sim.time_ns).open()
        self._frames = FramePoses(sim, self._tree)
        self._seen: object = None

    def packet(self, options: Sequence[object]) -> bytes | None:
        message: Message = self._subscription.latest
        if message is None or message is self._seen:
            return None
        self._seen = message
        points = msgs.points(message)
        place = np.stack([points[axis] for axis in "xyz"], axis=1).astype(np.float64)
        usable = np.flatnonzero(np.isfinite(place).all(axis=1))
        usable = _thinned(usable)
        pose = self._frames.pose(message.header.frame_id)
        if pose is None:
            text = f"the frame {message.header.frame_id!r:.80} is unknown"
            return make_packet({"kind": f"cloud:{self._topic}", "error": text}, {})
        arrays = {"points": matmul(place[usable], pose.matrix.T) + pose.position}
        if "rgb" in (points.dtype.names or ()):
            packed = np.ascontiguousarray(points["rgb"][usable]).view(np.uint32)
            arrays["colours"] = np.stack([packed >> 16, packed >> 8, packed], axis=1).astype(np.uint8)
        return make_packet({"kind": f"cloud:{self._topic}", "time": self._sim.time}, arrays)

    def close(self) -> None:
        self._subscription.close()
        self._tree.close()


STREAMS: Final[dict[str, Callable[[Simulation, str], Stream]]] = {
    "lidar": LidarStream,
    "ranges": RangeStream,
    "contacts": ContactStream,
    "joints": JointStream,
    "image": ImageStream,
    "cloud": CloudStream,
    **SERIES_STREAMS,
    **TOPIC_STREAMS,
    **GRAPH_STREAMS,
    "displays": DisplayList,
    "display": TopicDisplay,
}
"""Streams by the first part of their name; the part after a colon is the second argument."""

LASTING: Final = ("display", "driving")
"""Streams that go on when the structure changes, because they keep messages that do not come again."""


_NO_POINTS: Final = np.zeros((0, 3))
CLEARED: Final[dict[str, tuple[JsonObject, Arrays]]] = {
    "lidar": ({"lidars": []}, {"points": _NO_POINTS, "origins": _NO_POINTS}),
    "cloud": ({}, {"points": _NO_POINTS}),
    "image": ({"error": "the camera has not taken a picture yet"}, {}),
    "display": ({"problems": [], "groups": []}, {}),
}
"""Streams that begin anew after a reset, with the packet that clears what the page shows of before it."""


def make_stream(sim: Simulation, name: str) -> Stream | None:
    """Return the source of a stream; None if there is no such stream."""
    kind, _, argument = name.partition(":")
    return STREAMS[kind](sim, argument) if kind in STREAMS else None


def _texts(option: object) -> list[str]:
    return [item for item in option if isinstance(item, str)] if isinstance(option, list) else []


def _thinned(values: npt.NDArray[Number]) -> npt.NDArray[Number]:
    return values[:: 1 + len(values) // _MOST_POINTS]


def _as_bytes(pixels: npt.NDArray[np.generic]) -> npt.NDArray[np.uint8]:
    """Return pixels of any type as bytes; depths and temperatures from their smallest to their largest value."""
    if pixels.dtype == np.uint8:
        return pixels.astype(np.uint8, copy=False)
    values = pixels.astype(np.float64)
    usable = values[np.isfinite(values)]
    low, high = (usable.min(), usable.max()) if usable.size else (0.0, 1.0)
    scaled = np.nan_to_num((values - low) / max(high - low, 1e-9), nan=0.0, posinf=1.0, neginf=0.0)
    as_bytes: npt.NDArray[np.uint8] = (255 * np.clip(scaled, 0, 1)).astype(np.uint8)
    return as_bytes

"""Numbers of message fields over time, for the plots of the page."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.errors import SimkitError
from simkit.linear_algebra import matmul
from simkit.msgs.definition_parser import ARRAY, BASE, NAME, SEQUENCE, FieldNode
from simkit.msgs.field_units import unit_of
from simkit.msgs.message_text import NUMBER_CODES, field_nodes
from simkit.recording.charts.fields import Curve, curves_of
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage
from simkit_view.view.packet import Arrays, Stream, make_packet

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

    from simkit import Simulation, Subscription
    from simkit.msgs import Message

PERIOD: Final = 0.1
"""Least wall time between two packets of a stream [s]."""
_MOST_NEW: Final = 80  # samples of a packet; of more messages, every second, fourth, … is read
_RESENT: Final = 3 * _MOST_NEW  # samples that are sent again, because a slow page does not get each packet
_MOST_FIELDS: Final = 64
_LONGEST_FIELD: Final = 300
_MOST_PATHS: Final = 250
_SPREAD: Final = 9  # items of a fixed array that are listed one by one
_DEEPEST: Final = 8
TRUTH: Final = ("x", "y", "z", "roll", "pitch", "yaw", "vx", "vy", "vz", "forward", "left", "yaw_rate")
"""True values of a model: pose and velocity in the world, velocity along the model's own axes, and yaw rate."""
_TRUTH_UNITS: Final = ("m", "m", "m", "rad", "rad", "rad", "m/s", "m/s", "m/s", "m/s", "m/s", "rad/s")


# ---------------------------------------------------------------------- fields of a type


def field_paths(type_name: str, store: Typestore) -> list[str]:
    """Return the paths of the numbers of a type; `[]` stands for the index of an array."""
    paths: list[str] = []
    for path in _paths((NAME, type_name), store, "", 0):
        paths.append(path)
        if len(paths) >= _MOST_PATHS:
            break
    return paths


def _paths(node: FieldNode, store: Typestore, path: str, depth: int) -> Iterator[str]:
    kind, detail = int(node[0]), node[1]
    if depth > _DEEPEST:
        return
    if kind == BASE:
        if detail[0] in NUMBER_CODES or detail[0] in ("bool", "byte"):
            yield path
    elif kind == NAME:
        fields = field_nodes(detail, store)
        names = [name for name, _ in fields]
        if names == ["sec", "nanosec"] and path:
            yield path
            return
        if names == ["x", "y", "z", "w"]:
            yield from (f"{path}.{angle}".lstrip(".") for angle in ("roll", "pitch", "yaw"))
        for name, inner in fields:
            yield from _paths(inner, store, f"{path}.{name}".lstrip("."), depth + 1)
    elif kind in (ARRAY, SEQUENCE):
        inner, size = detail
        if kind == ARRAY and size <= _SPREAD:
            for index in range(size):
                yield from _paths(inner, store, f"{path}[{index}]", depth + 1)
        else:
            yield from _paths(inner, store, f"{path}[]", depth + 1)


def resolve_fields(
    topic: str, type_name: str, fields: Sequence[str], store: Typestore
) -> tuple[list[tuple[str, Curve]], dict[str, str]]:
    """Return the curves of fields with the field of each curve, and the errors of wrong fields."""
    curves: list[tuple[str, Curve]] = []
    errors: dict[str, str] = {}
    for field in fields:
        try:
            text = f"{topic}{field}" if field.startswith("[") else f"{topic}.{field}"
            field_curves = curves_of(text, {topic: type_name}, lambda _: store, "the simulation", unit_of)
        except SimkitError as error:
            errors[field] = str(error).partition(" ")[2]
            continue
        curves += [(field, curve) for curve in field_curves]
        if len(curves) > _MOST_FIELDS:
            errors[field] = f"a topic can have at most {_MOST_FIELDS} curves"
            del curves[_MOST_FIELDS:]
    return curves, errors


def wanted_fields(options: Sequence[object]) -> list[str]:
    """Return the fields that the options of all pages name."""
    lists = [option.get("fields") for option in options if isinstance(option, dict)]
    texts = (f for fields in lists if isinstance(fields, list) for f in fields if isinstance(f, str))
    return list(dict.fromkeys(f for f in texts if 0 < len(f) <= _LONGEST_FIELD))[:_MOST_FIELDS]


def stamp_of(message: Message) -> float:
    """Return the stamp in the header of a message [s]; NaN without one."""
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    return math.nan if stamp is None else float(msgs.stamp_ns(stamp) * 1e-9)


# ---------------------------------------------------------------------- packets


Row = tuple[float, float, Sequence[float]]
"""Time and stamp [s] of a sample, and its values."""


def series_packet(name: str, rows: Sequence[Row], curves: Sequence[Mapping[str, object]], **head: object) -> bytes:
    """Return the packet of samples.

    Times, stamps and values are differences from a base value in the head: a 32-bit number has only 7 digits.
    """
    times = np.array([row[0] for row in rows])
    stamps = np.array([row[1] for row in rows])
    values = np.array([row[2] for row in rows], dtype=np.float64).reshape(len(rows), len(curves))
    finite = np.isfinite(values)
    bases = [float(values[np.argmax(finite[:, k]), k]) if finite[:, k].any() else 0.0 for k in range(len(curves))]
    begin = float(times[0]) if len(rows) else 0.0
    shown = [{**curve, "base": base} for curve, base in zip(curves, bases, strict=True)]
    with np.errstate(over="ignore", invalid="ignore"):
        arrays: Arrays = {
            "times": times - begin,
            "stamps": stamps - begin,
            "values": (values - bases).astype(np.float32),
        }
    return make_packet({"kind": name, **head, "begin": begin, "curves": shown}, arrays)


def curve_dicts(curves: Sequence[tuple[str, Curve]]) -> list[dict[str, object]]:
    """Return the description of curves for the page."""
    return [{"field": field, "path": c.path, "unit": c.unit, "is_angle": c.is_angle} for field, c in curves]


class SampleRows:
    """Newest samples of a stream with their numbers, from which a page notices those that it has already.

    Args:
        name: name of the stream.
    """

    def __init__(self, name: str) -> None:
        self._name, self._rows = name, deque[Row](maxlen=_RESENT)
        self._count, self._sent, self._due = 0, -1, 0.0
        self._source = time.monotonic_ns()

    def is_due(self) -> bool:
        """Check whether the next packet may be made."""
        now = time.perf_counter()
        if now < self._due:
            return False
        self._due = now + PERIOD
        return True

    def add(self, row: Row) -> None:
        """Add a sample; one of an earlier time is the first after a reset."""
        if self._rows and row[0] < self._rows[-1][0]:
            self._rows.clear()
        self._rows.append(row)
        self._count += 1

    def clear(self) -> None:
        """Drop all samples, because the curves have changed."""
        self._rows.clear()
        self._sent = -1

    def packet(self, curves: Sequence[Mapping[str, object]], errors: Mapping[str, str]) -> bytes | None:
        """Return a packet; None if there is nothing new."""
        if self._sent == self._count:
            return None
        self._sent = self._count
        first = self._count - len(self._rows)
        return series_packet(
            self._name, list(self._rows), curves, source=self._source, first=first, errors=dict(errors)
        )


class SeriesStream:
    """Numbers of fields of one topic; `series:TOPIC`. Options: `fields`, a list of paths.

    At most about 800 messages a second are read, evenly chosen, so that a topic with 1 kHz costs little.
    """

    def __init__(self, sim: Simulation, topic: str) -> None:
        self._sim, self._topic = sim, topic
        self._rows = SampleRows(f"series:{topic}")
        self._tap: Subscription | None = None
        self._fields: list[str] = []
        self._curves: list[tuple[str, Curve]] = []
        self._errors: dict[str, str] = {}
        self._pending: list[tuple[float, LazyMessage | Row]] = []  # time, and a message or a sample
        self._stride = self._skipped = 1

    def packet(self, options: Sequence[object]) -> bytes | None:
        if not self._rows.is_due():
            return None
        fields = wanted_fields(options)
        if fields != self._fields:
            self._choose(fields)
        pending, self._pending, self._stride = self._pending, [], 1
        for now, reading in pending:
            row = reading if isinstance(reading, tuple) else self._row(now, reading)
            if row is not None:
                self._rows.add(row)
        return self._rows.packet(curve_dicts(self._curves), self._errors)

    def _choose(self, fields: list[str]) -> None:
        """Resolve the fields, and begin to receive the topic."""
        bus = self._sim.communication.bus
        type_name = bus.all_topics().get(self._topic)
        if type_name is None:
            errors = dict.fromkeys(fields, f"no topic {self._topic!r:.80}")
            if errors != self._errors:
                self._errors = errors
                self._rows.clear()
            return
        self._fields = fields
        self._pending.clear()
        self._rows.clear()
        self._curves, self._errors = resolve_fields(self._topic, type_name, fields, msgs.type_store())
        if self._tap is None and self._curves:
            self._tap = bus.tap(self._topic, self._receive, takes_later=True, settle=self._settle)

    def _receive(self, message: Message | LazyMessage) -> None:
        now = self._sim.time
        if self._pending and now < self._pending[-1][0]:
            self._pending.clear()  # after a reset
        self._skipped += 1
        if self._skipped < self._stride:
            return
        self._skipped = 0
        is_kept = isinstance(message, LazyMessage) and message.can_wait
        reading = message if is_kept else self._row(now, message)  # a publisher may change its message afterwards
        if reading is not None:
            self._pending.append((now, reading))
        if len(self._pending) > _MOST_NEW:
            del self._pending[1::2]
            self._stride *= 2

    def _row(self, now: float, message: Message | LazyMessage) -> Row | None:
        made = message.get() if isinstance(message, LazyMessage) else message
        if made is NO_MESSAGE or not self._curves or made.__msgtype__ != self._curves[0][1].type_name:
            return None
        return now, stamp_of(made), [curve.read(made) for _, curve in self._curves]

    def _settle(self) -> None:
        """Make the samples of waiting messages, because their source data change."""
        rows = [(now, f if isinstance(f, tuple) else self._row(now, f)) for now, f in self._pending]
        self._pending = [(now, row) for now, row in rows if row is not None]

    def close(self) -> None:
        if self._tap is not None:
            self._tap.close()


class TruthStream:
    """True poses and velocities of models; `truth`. Options: `fields`, a list of `MODEL.VALUE` (see `TRUTH`)."""

    def __init__(self, sim: Simulation, _: str) -> None:
        self._sim, self._rows = sim, SampleRows("truth")
        self._fields: list[str] = []
        self._readers: list[tuple[str, int]] = []
        self._curves: list[dict[str, object]] = []
        self._errors: dict[str, str] = {}
        self._tick = -1

    def packet(self, options: Sequence[object]) -> bytes | None:
        fields = wanted_fields(options)
        if fields != self._fields:
            self._choose(fields)
        sim = self._sim
        if sim.tick != self._tick and self._readers:
            self._tick = sim.tick
            values = {name: true_values(sim, name) for name, _ in self._readers}
            self._rows.add((sim.time, math.nan, [values[name][index] for name, index in self._readers]))
        return self._rows.packet(self._curves, self._errors) if self._rows.is_due() else None

    def _choose(self, fields: list[str]) -> None:
        self._fields, self._tick, self._readers, self._errors = fields, -1, [], {}
        self._curves = []
        self._rows.clear()
        for field in fields:
            name, _, value = field.rpartition(".")
            if name not in self._sim.models or value not in TRUTH:
                self._errors[field] = f"found {field!r:.80}; expected MODEL.VALUE with one of {', '.join(TRUTH)}"
                continue
            index = TRUTH.index(value)
            self._readers.append((name, index))
            is_angle = value in ("roll", "yaw")
            self._curves.append({"field": field, "path": field, "unit": _TRUTH_UNITS[index], "is_angle": is_angle})

    def close(self) -> None:
        """Nothing is open."""


def true_values(sim: Simulation, name: str) -> list[float]:
    """Return the values of `TRUTH` of a model; the velocity is that of its first link."""
    model = sim.models[name]
    pose = model.pose
    link = next(iter(model.links.values()), None)
    linear = np.zeros(3) if link is None else np.asarray(link.linear_velocity)
    turning = 0.0 if link is None else float(link.angular_velocity[2])
    in_body = matmul(pose.matrix.T, linear)
    return [*map(float, (*pose.position, *pose.rpy, *linear, in_body[0], in_body[1])), turning]


SERIES_STREAMS: Final[dict[str, Callable[[Simulation, str], Stream]]] = {"series": SeriesStream, "truth": TruthStream}
"""Streams for plots."""

"""Run records created from a few arrays."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from simkit.run_spec import RunSpec, Tolerance
from simkit.testing.run_record.record import Column, Pictures, RunRecord, States, Stream

SCAN = "sensor_msgs/msg/LaserScan"
IMU = "sensor_msgs/msg/Imu"
ODOM = "nav_msgs/msg/Odometry"
JOINTS = "sensor_msgs/msg/JointState"
CONTACTS = "ros_gz_interfaces/msg/Contacts"
IMAGE = "sensor_msgs/msg/Image"
MACHINE = {"simkit": "1", "mujoco": "4.0.0", "numpy": "2.0", "processor features": "AVX2"}
OTHER_MACHINE = {**MACHINE, "mujoco": "4.0.1"}


def times(count: int, rate: float, first: float = 0.0) -> Any:
    """Return the times of messages at a rate [ns]."""
    return np.round((first + np.arange(count) / rate) * 1e9).astype(np.int64)


def stream(
    topic: str,
    type_name: str,
    when: Any,
    columns: Mapping[str, Any],
    words: Mapping[str, list[str]] | None = None,
    pictures: Pictures | None = None,
) -> Stream:
    """Return a stream with hashes of its numbers."""
    made = {path: c if isinstance(c, Column) else Column(np.asarray(c)) for path, c in columns.items()}
    found = Stream(topic, type_name, np.asarray(when, np.int64), made, dict(words or {}), pictures)
    return hashed(found)


def hashed(found: Stream, of: Stream | None = None) -> Stream:
    """Add hashes to a stream as if the messages had no other fields."""
    exact = of or found
    whole = hashlib.sha256()
    chunks = []
    for second in range(int(exact.times_ns[-1] // 1_000_000_000) + 1 if len(exact.times_ns) else 0):
        here = exact.times_ns // 1_000_000_000 == second
        chunk = hashlib.sha256()
        for path in sorted(exact.columns):
            column = exact.columns[path]
            for index in np.flatnonzero(here):
                chunk.update(np.ascontiguousarray(column.of(int(index))).tobytes())
        for path in sorted(exact.words):
            chunk.update("".join(exact.words[path]).encode())
        if exact.pictures is not None:
            seen = exact.pictures.hashes
            chunk.update((exact.pictures.tiles if seen is None else seen)[here].tobytes())
        chunks.append(chunk.hexdigest())
        whole.update(chunk.digest())
    found.chunks, found.digest = chunks, whole.hexdigest()
    return found


def rounded(found: Stream, step: float) -> Stream:
    """Return a stream as a golden run stores it: rounded numbers, and hashes of the exact numbers."""
    columns = {
        path: Column(np.rint(c.values / step) * step, c.lengths, step) if c.values.dtype.kind == "f" else c
        for path, c in found.columns.items()
    }
    return hashed(replace(found, columns=columns), found)


def states(
    shift: float = 0.0, first: int = 1000, names: tuple[str, ...] = ("cart position x", "arm velocity")
) -> States:
    """Return two seconds of physics that differ by `shift` from tick `first` on."""
    rng = np.random.default_rng(0)
    marks = rng.integers(0, 256, 2000).astype(np.uint8)
    ticks = np.arange(0, 2001, 250)
    values = np.outer(ticks * 1e-3, np.linspace(1.0, 2.0, len(names))) + 1.0
    if shift:
        marks[first - 1 :] ^= 0x55
        values[ticks >= first, 0] += shift
    nothing = np.zeros((len(ticks), 0))
    return States(1e-3, marks, np.zeros(2000, np.uint8), ticks, list(names), values, [], nothing, "")


def record(
    *streams: Stream, machine: Mapping[str, str] = MACHINE, tolerances: tuple[Tolerance, ...] = (), **more: Any
) -> RunRecord:
    """Return the record of a run with these streams."""
    options = {key: more.pop(key) for key in ("state", "model") if key in more}
    scenario = RunSpec("world.sdf", 2.0, tolerances=tolerances, **options)
    return RunRecord(scenario, dict(machine), {s.topic: s for s in streams}, more.pop("states", states()), **more)

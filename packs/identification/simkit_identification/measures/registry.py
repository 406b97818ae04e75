"""Registry of measures: the functions that measure a stream, by type of its messages."""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Iterator
from typing import Final

from simkit_identification.measures import inertial, motion, ranges, signals, timing
from simkit_identification.measures.context import Context
from simkit_identification.measures.measure import Measure
from simkit_identification.measures.recording import Stream

MeasureFunction = Callable[[Stream, Context], Iterator[Measure]]

MEASURES: Final[tuple[tuple[str, MeasureFunction], ...]] = (
    ("*", timing.timing),
    ("*", timing.latency),
    ("*", signals.values),
    ("sensor_msgs/msg/Imu", inertial.allan),
    ("sensor_msgs/msg/MagneticField", inertial.allan),
    ("sensor_msgs/msg/Imu", inertial.covariances),
    ("*", ranges.arrays),
    ("*", motion.paths),
    ("*", motion.speed_at_commands),
    ("*", motion.delays),
)
"""Shell pattern of the types, and the function that yields their measures, in the order of the rows."""


def measures_of(stream: Stream, context: Context) -> dict[str, Measure]:
    """Return all measures of a stream by quantity."""
    found: dict[str, Measure] = {}
    for types, function in MEASURES:
        if fnmatch.fnmatchcase(stream.type_name, types):
            for measure in function(stream, context):
                found.setdefault(measure.quantity, measure)
    return found

"""Surroundings of a measurement."""

from __future__ import annotations

from dataclasses import dataclass

from simkit_identification.measures.recording import SignalRecording


@dataclass(frozen=True)
class Context:
    """Surroundings of a measurement.

    Attributes:
        recording: recording of the stream.
        duration: time that both recordings have [s].
        still: intervals in which the robot is still [s]; None if unknown.
    """

    recording: SignalRecording
    duration: float
    still: list[tuple[float, float]] | None

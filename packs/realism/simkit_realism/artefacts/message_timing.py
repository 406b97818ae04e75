"""Times of messages as real drivers have them: late messages, gaps, and the clock of the time stamps."""

from __future__ import annotations

import math

from simkit import Params
from simkit.elementary_functions import log
from simkit.extend import MessageArtefact, Sensor, SpecBuilder
from simkit.sensors.sample_times import MAX_LATENCY
from simkit_realism.histogram import HistogramReader

_LONGEST_GAP = 1e6  # [frames]
_NS = 1e9


class LatencyHistogram(MessageArtefact):
    """`<simkit:latency_histogram>`: each message arrives late by a time drawn from a recorded histogram.

    The drawn time is added to `<latency>` and `<latency_jitter>`. A message arrives at the first step at or after its
    time.

    Args:
        params: the element: `file`, or `values` [s] and `weights`; `bin_width` [s], over which each value is spread;
            `keep_order`, whether a late message delays those after it.
        sensor: any sensor.
    """

    elements = ("any/latency_histogram",)

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._reader = HistogramReader(params, "seconds", 0.0, MAX_LATENCY)
        self.keeps_order = params.boolean("keep_order", True)
        if not self._reader.is_given:
            params.error("SK-PARAM-001", "<latency_histogram> needs <values> or <file>")

    def build(self, builder: SpecBuilder) -> None:
        self._reader.find(builder)

    def prepare(self) -> None:
        self._stream = self.stream("latency", 2)

    def delay(self, index: int) -> float:
        assert self._reader.histogram is not None
        share, place = self._stream.uniform(index).tolist()
        return max(0.0, self._reader.histogram.value(0.5 * (share + 1.0), place))


class Gaps(MessageArtefact):
    """`<simkit:gaps>`: bursts of messages that never arrive.

    At least one message arrives between two gaps. The number of the messages that are still missing is a state that
    advances with every sample.

    Args:
        params: the element: `probability` that a gap begins after a message that arrives; `mean_length` [frames]
            of a geometric distribution of lengths, or a histogram of lengths: `file`, or `values` [frames] and
            `weights`.
        sensor: any sensor.

    Attributes:
        state: number of missing messages, this one included; 0 if the message arrives.
    """

    elements = ("any/gaps",)
    evolves = True

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.probability = params.number("probability", 0.0, required=True, minimum=0.0, maximum=1.0)
        self._reader = HistogramReader(params, "frames", 1, _LONGEST_GAP, is_whole=True)
        self.mean_length = params.number("mean_length", 1.0, minimum=1.0, maximum=_LONGEST_GAP)
        if self._reader.is_given and params.has("mean_length"):
            message = "<mean_length> is not used: the histogram defines the lengths"
            params.block("mean_length").error("SK-SENSOR-245", message, "remove one of the two")
        self.state = 0

    def build(self, builder: SpecBuilder) -> None:
        self._reader.find(builder)

    def prepare(self) -> None:
        self._stream = self.stream("gaps", 2)
        self.sensor.register_noise(self)

    def restart(self) -> None:
        self.state = 0

    def set_interval(self, interval: float) -> None:
        """Do nothing: gaps are counted in samples."""

    def evolve(self, index: int, dt: float) -> None:
        if self.state > 0:
            self.state -= 1
            return
        begins, share = (0.5 * (self._stream.uniform(index) + 1.0)).tolist()
        self.state = self._length(share) if begins < self.probability else 0

    def _length(self, share: float) -> int:
        """Return the length of a gap [frames] at a share of the distribution, from 0 to 1."""
        if self._reader.histogram is not None:
            return int(self._reader.histogram.value(share))
        if self.mean_length <= 1.0:
            return 1
        logs = log(max(1.0 - share, 1e-300)) / log(1.0 - 1.0 / self.mean_length)
        return 1 + min(int(logs), int(_LONGEST_GAP))

    def is_lost(self, index: int) -> bool:
        return self.state > 0


class StampClock(MessageArtefact):
    """`<simkit:clock>`: clock of the time stamps, which differs from the simulated time.

    The stamp of a message at t is t + `offset` + `drift`·t. The ground truth keeps the time of the measurement.

    Args:
        params: the element: `offset` [s], `drift` [s/s], and `stamp`: `measurement`, or `arrival` for a driver that
            stamps a message when it arrives.
        sensor: any sensor.
    """

    elements = ("any/clock",)

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.offset_ns = round(params.number("offset", 0.0, minimum=-1e6, maximum=1e6) * _NS)
        self.drift = params.number("drift", 0.0, minimum=-0.5, maximum=0.5)
        self.is_arrival = params.choice("stamp", ("measurement", "arrival"), "measurement") == "arrival"

    def stamp(self, measured_ns: int, arrived_ns: int) -> int:
        time_ns = arrived_ns if self.is_arrival else measured_ns
        # a stamp before the epoch would be invalid in ROS 2
        return max(0, time_ns + self.offset_ns + math.floor(self.drift * time_ns + 0.5))

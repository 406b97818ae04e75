"""Loss of a signal on its way, and probability that a packet arrives.

The formulas are those of gz-sim: `RFComms.cc` (log-normal fading, QPSK) and `AcousticComms.cc` (sonar equation, BPSK).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from simkit.extend import Options, number, text

_CLOSEST = 1e-9  # distance below which the loss no longer decreases [m]
_SOURCE_LEVEL = 170.8  # of 1 W, at 1 m from the source [dB]


class RangeOptions(Options):
    """Options of `<range_config>`."""

    max_range: float = number(50.0, "m", minimum=-1e12, maximum=1e12)
    fading_exponent: float = number(2.5, minimum=0.0, maximum=1e3)
    l0: float = number(40.0, "dB", minimum=-1e3, maximum=1e3)
    sigma: float = number(10.0, "dB", minimum=0.0, maximum=1e3)
    rssi_1: float = number(-15.0, "dBm", minimum=-1e3, maximum=1e3)


class RadioOptions(Options):
    """Options of `<radio_config>`."""

    capacity: float = number(54e6, "bit/s", minimum=0.0, maximum=1e15)
    tx_power: float = number(27.0, "dBm", minimum=-1e3, maximum=1e3)
    noise_floor: float = number(-90.0, "dBm", minimum=-1e3, maximum=1e3)
    modulation: str = text("QPSK")


@dataclass(frozen=True)
class RadioChannel:
    """Radio channel between two antennas.

    Attributes:
        max_range: distance up to which a signal is received [m]; 0 or less for no limit.
        exponent: exponent of the fading.
        loss: loss at 1 m [dB].
        sigma: standard deviation of the received power [dB].
        power: transmitted power [dBm].
        noise_floor: noise at the receiver [dBm].
    """

    max_range: float
    exponent: float
    loss: float
    sigma: float
    power: float
    noise_floor: float

    def received_power(self, distance: float, drawn: float) -> float:
        """Return the received power [dBm], with a normal number for the fading; -inf out of range."""
        if 0.0 < self.max_range < distance:
            return -math.inf
        path = self.loss + 10.0 * self.exponent * math.log10(max(distance, _CLOSEST))
        return self.power - path + self.sigma * drawn

    def loss_probability(self, received: float, size: int) -> float:
        """Return the probability that a packet of `size` bytes is lost."""
        ratio = 10.0 ** min((received - self.noise_floor) / 10.0, 300.0)
        return _packet_loss(math.erfc(math.sqrt(ratio)), size)


def read_channel(reach: RangeOptions, radio: RadioOptions) -> RadioChannel:
    """Return the channel of two blocks."""
    return RadioChannel(
        reach.max_range, reach.fading_exponent, reach.l0, reach.sigma, radio.tx_power, radio.noise_floor
    )


def acoustic_loss_probability(distance: float, size: int, power: float, noise: float, efficiency: float) -> float:
    """Return the probability that a packet of sound is lost.

    Args:
        distance: distance that the sound has covered [m].
        size: bytes of the packet.
        power: power of the source [W].
        noise: level of the noise [dB].
        efficiency: spectral efficiency [bit/s/Hz].
    """
    level = _SOURCE_LEVEL + 10.0 * math.log10(power) - 20.0 * math.log10(max(distance, _CLOSEST)) - noise
    return _packet_loss(0.5 * math.erfc(level / efficiency), size)


def _packet_loss(bit_error_rate: float, size: int) -> float:
    if bit_error_rate >= 1.0:
        return 1.0
    return -math.expm1(size * math.log1p(-bit_error_rate))

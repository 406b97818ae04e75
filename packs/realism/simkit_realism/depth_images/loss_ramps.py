"""Probabilities that a pixel has no return, which grow with a quantity such as the angle of incidence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit import Params

Numbers = npt.NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class LossRamp:
    """Probability of a loss: 0 up to `start`, `probability` from `end` on, linear between them.

    Attributes:
        start, end: values of the quantity; `end` may be below `start`.
        probability: probability at and beyond `end`.
    """

    start: float
    end: float
    probability: float

    def of(self, values: npt.NDArray[np.generic]) -> Numbers:
        """Return the probability for each value."""
        width = self.end - self.start
        losses = values.astype(np.float32)
        if width == 0:  # a step
            return np.where(losses >= np.float32(self.start), np.float32(self.probability), np.float32(0.0))
        losses -= np.float32(self.start)
        losses *= np.float32(1.0 / width)
        np.clip(losses, 0.0, 1.0, out=losses)
        losses *= np.float32(self.probability)
        return losses

    def kept(self, values: npt.NDArray[np.generic]) -> Numbers:
        """Return the probability that there is no loss, for each value."""
        losses = self.of(values)
        kept: Numbers = np.subtract(np.float32(1.0), losses, out=losses)
        return kept


def read_ramp(params: Params, name: str, minimum: float, maximum: float) -> LossRamp | None:
    """Read a ramp from a child with `<start>`, `<end>` and `<probability>`; return None without the child."""
    block = params.child(name)
    if block is None:
        return None
    start = block.number("start", required=True, minimum=minimum, maximum=maximum)
    end = block.number("end", required=True, minimum=minimum, maximum=maximum)
    return LossRamp(start, end, block.number("probability", 1.0, minimum=0.0, maximum=1.0))

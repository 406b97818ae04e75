"""Labels: numbers that models and visuals wear, for cameras that tell what is seen."""

from __future__ import annotations

from typing import Final

from simkit.runtime.worn import Worn

LARGEST_LABEL: Final = 255


class Labels(Worn[int]):
    """Label by scoped name of a model or a visual; may be changed at any time.

        sim.labels["shelf"] = 40                    # the model and all that is in it
        sim.labels["shelf::base::handle"] = 41      # one visual
        del sim.labels["shelf"]

    A visual wears its own label, else that of the innermost model around it that has one. A model that is removed
    takes its labels along; snapshots and reset bring back what was.
    """

    read_by = "reads_labels"

    def checked(self, value: int) -> int:
        number = int(value)
        if number != value or not 0 <= number <= LARGEST_LABEL:
            raise ValueError(f"a label is a whole number from 0 to {LARGEST_LABEL}, got {value}")
        return number

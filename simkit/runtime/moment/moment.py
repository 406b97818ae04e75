"""Explanation of a simulation at one time."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass

from simkit.number_text import counted
from simkit.runtime.moment.moment_contents import MomentContents
from simkit.runtime.moment.sentences import findings, report


@dataclass(frozen=True, slots=True, repr=False)
class Moment(MomentContents):
    """State of a simulation at one time, in numbers; `print(moment)` prints it in sentences."""

    @property
    def findings(self) -> list[str]:
        """Sentences about what slides, has reached a limit, or slips."""
        return findings(self)

    def as_dict(self) -> dict[str, object]:
        """Return the contents and the findings as a JSON object; NaN and infinity become None."""
        fields = {field.name: _plain(getattr(self, field.name)) for field in dataclasses.fields(self)}
        pairs = [{**_row(pair), "slides": pair.slides} for pair in self.contacts]
        return {**fields, "contacts": pairs, "findings": self.findings}

    def report(self, *, brief: bool = False) -> list[str]:
        """Return the explanation as lines of text.

        Args:
            brief: only the findings, or that there are none.
        """
        return report(self, brief=brief)

    def __str__(self) -> str:
        return "\n".join(self.report())

    def __repr__(self) -> str:
        counts = {"contact": self.contacts, "joint": self.joints, "constraint": self.constraints, "wheel": self.wheels}
        texts = [counted(len(items), noun) for noun, items in counts.items() if items]
        found = counted(len(self.findings), "finding")
        return f"<Moment t={self.time:g} s: {', '.join((*texts, found))}>"


def _row(item: object) -> dict[str, object]:
    assert dataclasses.is_dataclass(item)
    return {field.name: _plain(getattr(item, field.name)) for field in dataclasses.fields(item)}


def _plain(value: object) -> object:
    if isinstance(value, (tuple, list)):
        return [_plain(item) for item in value]
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if dataclasses.is_dataclass(value):
        return _row(value)
    return None if isinstance(value, float) and not math.isfinite(value) else value

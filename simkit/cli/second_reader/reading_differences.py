"""Differences between two readings of one URDF file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from simkit.cli.second_reader.robot_reading import Part, RobotReading, Value, random_positions

_RELATIVE: Final = 1e-7
"""Largest relative difference of two numbers that count as equal; readers convert the same text."""
_ABSOLUTE: Final = 1e-9
_FRAME: Final = 1e-6
"""Largest difference of two frames [m, and 1 for a rotation matrix]; they add the rounding errors of long chains."""
_OF_THE_TREE: Final = ("root link", "existence", "parent link", "child link")
"""Quantities without which frames cannot be compared."""


@dataclass(frozen=True, slots=True)
class Difference:
    """Quantity that two readings have different values for.

    Attributes:
        part: link, joint or shape.
        quantity: name of the quantity, such as "upper limit".
        found: value of the first reading.
        expected: value of the second reading.
    """

    part: Part
    quantity: str
    found: str
    expected: str


def reading_differences(ours: RobotReading, theirs: RobotReading) -> list[Difference]:
    """Return all differences: first of the values in the file, then of the frames of links.

    Of the links behind each other that have different frames, the first one is returned. Links whose joint is read
    differently are left out, because their frames differ for this reason.
    """
    differences = (
        [] if ours.root == theirs.root else [Difference(Part("link", ours.root), "root link", ours.root, theirs.root)]
    )
    differences += _value_differences(ours, theirs)
    faulty = {d.part.name for d in differences if d.part.kind == "joint"}
    above = {
        str(values["child link"]): (part.name, str(values["parent link"]))
        for part, values in ours.parts.items()
        if part.kind == "joint"
    }
    if not any(d.quantity in _OF_THE_TREE for d in differences):
        differences += _frame_differences(ours, theirs, above, faulty)
    return differences


def _value_differences(ours: RobotReading, theirs: RobotReading) -> Iterator[Difference]:
    for part in dict.fromkeys((*ours.parts, *theirs.parts)):
        values, others = ours.parts.get(part), theirs.parts.get(part)
        if values is None or others is None:
            yes_or_no = ["no" if side is None else "yes" for side in (values, others)]
            yield Difference(part, "existence", *yes_or_no)
            continue
        for quantity in dict.fromkeys((*values, *others)):
            value, other = values.get(quantity), others.get(quantity)
            if not _are_equal(value, other):
                yield Difference(part, quantity, _shown(value), _shown(other))


def _are_equal(value: Value | None, other: Value | None) -> bool:
    if isinstance(value, tuple) and isinstance(other, tuple):
        largest = max((abs(v) for v in (*value, *other) if math.isfinite(v)), default=0.0)
        tolerance = min(_ABSOLUTE, _RELATIVE * largest)  # an inertia of 1e-9 is compared as well
        return len(value) == len(other) and all(
            v == w or abs(v - w) <= max(tolerance, _RELATIVE * abs(v)) for v, w in zip(value, other, strict=True)
        )
    return value == other


def _shown(value: Value | None) -> str:
    if value is None:
        return "none"
    return value if isinstance(value, str) else " ".join(f"{v:.9g}" for v in value)


def _frame_differences(
    ours: RobotReading, theirs: RobotReading, above: Mapping[str, tuple[str, str]], faulty: set[str]
) -> Iterator[Difference]:
    reported: set[str] = set()
    for positions in random_positions(ours):
        found, expected = ours.frames(positions), theirs.frames(positions)
        far = {name for name, pose in expected.items() if name in found and _distance(found[name], pose) > _FRAME}
        for name in sorted(far - reported, key=list(expected).index):
            joint, parent = above.get(name, ("", ""))
            if parent in far or joint in faulty or not joint:
                continue
            reported.add(name)
            at = f" with {joint} at {positions[joint]:.6g}" if positions.get(joint) else ""
            yield Difference(Part("link", name), f"frame{at}", _shown(found[name]), _shown(expected[name]))


def _distance(pose: tuple[float, ...], other: tuple[float, ...]) -> float:
    """Return the largest difference of two poses' numbers; of positions far away in relation to their distance."""
    far = max(1.0, *(abs(v) for v in other[:3]))
    return max(abs(v - w) / (far if index < 3 else 1.0) for index, (v, w) in enumerate(zip(pose, other, strict=True)))

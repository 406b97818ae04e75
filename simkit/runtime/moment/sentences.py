"""Sentences about a moment, with numbers and units."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

from simkit.runtime.contact.rim_slip import LEAST_SPEED, WheelSlip

if TYPE_CHECKING:
    from simkit.runtime.moment.moment_contents import (
        ConstraintError,
        JointLoad,
        MomentContents,
        TouchingPair,
    )

LEAST_RATIO: Final = 0.05
"""Least share of the speed that a wheel loses by slip for a finding; a tyre that pulls slips by a few percent."""

LEAST_ERROR: Final = 1e-3
"""Least error of a constraint for a finding [m or rad]."""

_MOST_LISTED: Final = 40  # lines of one kind


def findings(moment: MomentContents) -> list[str]:
    """Return a sentence for each wheel that slips, contact that slides, limit that is reached, and large error."""
    cut = _Names(moment.model)
    slips = [wheel for wheel in moment.wheels if abs(wheel.ratio) >= LEAST_RATIO and abs(wheel.slip) >= LEAST_SPEED]
    treads = {wheel.collision for wheel in slips}
    return [
        *(f"Wheel {cut(wheel.joint)} slips: {_slip_text(wheel)}." for wheel in slips),
        *(
            f"{cut(pair.first)} slides on {cut(pair.second)} at {_number(pair.slip_speed)} m/s."
            for pair in moment.contacts
            if pair.slides and not treads & {pair.first, pair.second}
        ),
        *(
            f"{cut(pair.first)} and {cut(pair.second)} use the whole friction of {_number(pair.friction_limit)} N."
            for pair in moment.contacts
            if pair.is_at_limit and not pair.slides
        ),
        *(f"Joint {cut(joint.joint)} {text}." for joint in moment.joints for text in _limits_reached(joint)),
        *(
            f"Constraint {cut(constraint.name)} has an error of {_number(constraint.error)} {constraint.unit}."
            for constraint in moment.constraints
            if constraint.error >= LEAST_ERROR
        ),
    ]


def report(moment: MomentContents, *, brief: bool) -> list[str]:
    """Return all contents as lines, the findings first; with `brief` the findings alone."""
    found = findings(moment) or ["Nothing slides or slips, and no joint has reached a limit."]
    if brief:
        return found
    cut = _Names(moment.model)
    of_model = f", model {moment.model}" if moment.model else ""
    return [
        f"{moment.world} at t = {moment.time:g} s (step {moment.tick}){of_model}",
        *(f"  {text}" for text in found),
        *_section("contacts", (_contact_line(pair, cut) for pair in moment.contacts), len(moment.contacts)),
        *_section("joints", (_joint_line(joint, cut) for joint in moment.joints), len(moment.joints)),
        *_section("constraints", (_constraint_line(item, cut) for item in moment.constraints), len(moment.constraints)),
        *_section("wheels", (_wheel_line(wheel, cut) for wheel in moment.wheels), len(moment.wheels)),
    ]


class _Names:
    """Function that shortens scoped names by the name of the model that the user has chosen."""

    def __init__(self, model: str) -> None:
        self._prefix = f"{model}::" if model else ""

    def __call__(self, scoped: str) -> str:
        return scoped.removeprefix(self._prefix)


def _section(title: str, lines: Iterable[str], count: int) -> Iterator[str]:
    if count:
        yield title
    for number, line in enumerate(lines):
        if number == _MOST_LISTED:
            yield f"  … {count - number} more; --model, --joint and --json show them"
            return
        yield f"  {line}"


def _contact_line(pair: TouchingPair, cut: _Names) -> str:
    points = f"{pair.points} point{'' if pair.points == 1 else 's'}"
    text = f"{cut(pair.first)} on {cut(pair.second)}, {points}: normal force {_number(pair.normal_force)} N"
    if pair.friction_limit:
        text += f", friction {_number(pair.friction_force)} N"
        text += f" ({pair.friction_use:.0%} of the limit of {_number(pair.friction_limit)} N)"
    if pair.slides:
        return f"{text}; slides at {_number(pair.slip_speed)} m/s"
    return text + (f"; moves at {_number(pair.slip_speed)} m/s" if pair.slip_speed >= LEAST_SPEED else "; holds")


def _joint_line(joint: JointLoad, cut: _Names) -> str:
    unit, effort_unit = ("m", "N") if joint.type == "prismatic" else ("rad", "N·m")
    effort = f"effort {_numbers(joint.effort)}"
    if any(map(math.isfinite, joint.effort_limit)):
        effort += f" of {_numbers(joint.effort_limit)}"
    motion = f"position {_numbers(joint.position)} {unit}, velocity {_numbers(joint.velocity)} {unit}/s"
    return "; ".join([f"{cut(joint.joint)}: {motion}, {effort} {effort_unit}", *_limits_reached(joint)])


def _limits_reached(joint: JointLoad) -> Iterator[str]:
    unit, effort_unit = ("m", "N") if joint.type == "prismatic" else ("rad", "N·m")
    if joint.saturated:
        limit = _numbers([limit for limit in joint.effort_limit if math.isfinite(limit)])
        needed = f"{_numbers(joint.steady_effort)} {effort_unit} would keep its velocity"
        yield f"has its effort limit of {limit} {effort_unit}; {needed}"
    if joint.is_at_velocity_limit:
        yield f"has its velocity limit of {_number(joint.velocity_limit)} {unit}/s"
    if joint.stop:
        stop = f"{joint.stop} limit" if joint.stop != "limit" else "limit"
        stopped = f"at {_numbers(joint.position)} {unit}, which pushes with {_number(joint.stop_effort)} {effort_unit}"
        yield f"touches its {stop} {stopped}"


def _constraint_line(constraint: ConstraintError, cut: _Names) -> str:
    unit = "N·m" if constraint.unit == "rad" else "N"
    error, force = _number(constraint.error), _number(constraint.force)
    return f"{cut(constraint.name)} ({constraint.kind}): error {error} {constraint.unit}, force {force} {unit}"


def _wheel_line(wheel: WheelSlip, cut: _Names) -> str:
    if not wheel.ground:
        return f"{cut(wheel.joint)} touches nothing"
    sideways = f", sideways {_number(wheel.sideways)} m/s" if abs(wheel.sideways) >= LEAST_SPEED else ""
    return f"{cut(wheel.joint)} on {cut(wheel.ground)}, load {_number(wheel.load)} N: {_slip_text(wheel)}{sideways}"


def _slip_text(wheel: WheelSlip) -> str:
    speeds = f"rim {_number(wheel.rim_speed)} m/s, axle {_number(wheel.axle_speed)} m/s"
    return f"{speeds}, slip {_number(wheel.slip)} m/s ({_percent(wheel.ratio)})"


def _numbers(values: Sequence[float]) -> str:
    return _number(values[0]) if len(values) == 1 else f"({', '.join(map(_number, values))})"


def _number(value: float) -> str:
    """Return a number with three digits, or without decimals; numbers below 1e-5 are 0."""
    return "0" if abs(value) < 1e-5 else f"{value:.3g}" if abs(value) < 1000.0 else f"{value:.0f}"


def _percent(share: float) -> str:
    return f"{0.0 if abs(share) < 5e-4 else share:.1%}"

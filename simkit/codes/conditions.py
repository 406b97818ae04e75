"""Conditions without code: `simkit run --until` and `--assert`, and the checks of a scenario."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import BALL, command, python


def _asserted(expression: str) -> Example:
    return command(f'simkit run ball.sdf --duration 1 --assert "{expression}"', {"ball.sdf": BALL})


CODES: tuple[Code, ...] = (
    Code(
        "SK-COND-001",
        "error",
        "an expression cannot be read; the place is shown",
        "the language is described in `docs/conditions.md`",
        _asserted("pose('ball').z = 1"),
    ),
    Code(
        "SK-COND-002",
        "error",
        "an expression names a value or a function that there is not; the closest is named",
        "names of models and topics stand in quotes",
        _asserted("pos('ball').z > 1"),
    ),
    Code(
        "SK-COND-003",
        "error",
        "a function in an expression is given too few or too many arguments",
        "how it is written is said",
        _asserted("pose().z > 1"),
    ),
    Code(
        "SK-COND-004",
        "error",
        "a part of an expression is of a kind that does not fit: a vector is compared with a number, a number is taken "
        "for true or false",
        "`.x`, `norm(…)`, `min(…)` make numbers; comparisons are true or false",
        _asserted("pose('ball') > 1"),
    ),
    Code(
        "SK-COND-005",
        "error",
        "an expression or a check names a model, link or joint that the world does not have, or several have; the "
        "closest is named",
        "`simkit inspect` lists them; `robot::wheel` is the whole name of a robot's wheel",
        _asserted("pose('bal').z > 1"),
    ),
    Code(
        "SK-COND-006",
        "error",
        "an expression names a topic that nobody publishes or takes; the closest is named",
        "a run prints its topics at the end",
        _asserted("count('/imu') > 1"),
    ),
    Code(
        "SK-COND-007",
        "error",
        "a value in an expression has no such part; those that it has are listed",
        "",
        _asserted("pose('ball').height > 1"),
    ),
    Code(
        "SK-COND-008",
        "error",
        "an expression is too long or too deep",
        "make several checks of it",
        _asserted("-" * 120 + "1 > 0"),
    ),
    Code(
        "SK-COND-009",
        "error",
        "a check lacks what it is about: models that are to be apart, a topic that is to tick",
        "",
        python(
            """
            import simkit
            from simkit.conditions import Watch
            from simkit.scenario.scenario import Check

            Watch(simkit.load("ball.sdf"), [Check("apart")])
            """,
            {"ball.sdf": BALL},
        ),
    ),
)

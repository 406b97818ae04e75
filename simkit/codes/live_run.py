"""Driving a run from the keyboard."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import BALL, command, python

CODES: tuple[Code, ...] = (
    Code(
        "SK-CLI-050",
        "error",
        "`--teleop` finds no terminal to read keys from",
        "`--cmd-vel`, `--script`, or `simkit topic pub` from another terminal",
        command("simkit run ball.sdf --teleop", {"ball.sdf": BALL}),
    ),
    Code(
        "SK-CLI-051",
        "error",
        "nothing takes velocities where `--teleop` is to drive, or several robots do",
        "`--teleop TOPIC`; the topics that take them are given",
        python(
            """
            import simkit
            from simkit.cli.driving.target import find_target

            with simkit.load("ball.sdf") as sim:
                find_target(sim)
            """,
            {"ball.sdf": BALL},
        ),
    ),
)

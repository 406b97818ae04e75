"""Which TurtleBot3 a world gets: the environment variable that its users know."""

from __future__ import annotations

import os

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError

MODELS = ("waffle",)
_DEFAULT = "waffle"


def turtlebot3_model() -> tuple[str, str]:
    """The robot that `TURTLEBOT3_MODEL` names, and a note where it names none (else an empty text).

    Raises:
        InputError: SK-URI-006 there is no such robot here; lists those there are.
    """
    name = os.environ.get("TURTLEBOT3_MODEL", "").strip()
    if not name:
        return _DEFAULT, f"TURTLEBOT3_MODEL is not set: the robot is the {_DEFAULT}"
    if name not in MODELS:
        hint = did_you_mean(name, MODELS) or "unset it, or choose one of these"
        raise InputError(
            f"SK-URI-006 TURTLEBOT3_MODEL={name}: this robot is not here, allowed is {', '.join(MODELS)}\n    help: {hint}",
            "SK-URI-006",
        )
    return name, ""

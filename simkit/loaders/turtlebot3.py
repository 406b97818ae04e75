"""Which TurtleBot3 `model://turtlebot3` stands for: the environment variable that its users know."""

from __future__ import annotations

import os

from simkit.diagnostics import Diagnostics, Where, did_you_mean

MODELS = ("burger", "waffle", "waffle_pi")
_URI = "model://turtlebot3"
_DEFAULT = "waffle"


def chosen_robot(uri: str, where: Where, diagnostics: Diagnostics) -> str | None:
    """The URI, with `model://turtlebot3` made the robot that `TURTLEBOT3_MODEL` names.

    An unset variable means the waffle, with a note; an unknown robot is an error that lists the known ones.
    """
    if uri != _URI:
        return uri
    name = os.environ.get("TURTLEBOT3_MODEL", "").strip()
    if not name:
        diagnostics.note("SK-URI-008", f"TURTLEBOT3_MODEL is not set: the robot is the {_DEFAULT}", where)
        name = _DEFAULT
    if name not in MODELS:
        message = f"TURTLEBOT3_MODEL={name}: this robot is not here, allowed is {', '.join(MODELS)}"
        diagnostics.error("SK-URI-007", message, where, did_you_mean(name, MODELS) or "unset it")
        return None
    return f"{_URI}_{name}"


def chosen_name(name: str, diagnostics: Diagnostics) -> str | None:
    """The bare name of a bundled model, with `turtlebot3` made the robot that `TURTLEBOT3_MODEL` names."""
    if name != "turtlebot3":
        return name
    uri = chosen_robot(_URI, Where(name), diagnostics)
    return None if uri is None else uri.removeprefix("model://")

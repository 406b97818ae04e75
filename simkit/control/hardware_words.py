"""What `<ros2_control>` may say, and what is wrong with what it does say."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.params import Params

if TYPE_CHECKING:
    from simkit.scene import SceneJoint

_FARTHEST: Final = 1e15  # of positions [rad or m], gains and the like; with larger ones no motion can be worked out
_ELEMENTS: Final = ("hardware", "joint", "sensor", "gpio", "transmission")
_OF_A_JOINT: Final = ("command_interface", "state_interface", "param", "limits", "property", "properties")
_GAINS: Final = ("kp", "ki", "kd", "max_integral_error")
_PARAMS_OF_A_JOINT: Final = ("mimic", "multiplier", "offset", *(f"{s}_{g}" for s in ("pos", "vel") for g in _GAINS))


def report_elements(block: Params, found: Diagnostics) -> None:
    """Tells of elements that no hardware has, and of names in a joint that are nearly ones that count."""
    owner = f"<ros2_control> {block.attribute('name')!r}"
    for one in block.children:
        if one.name not in _ELEMENTS and ":" not in one.name:
            _report(f"{owner}: <{one.name}>", one, did_you_mean(one.name, _ELEMENTS), found)
    for joint in block.all("joint"):
        what = f"{owner}, joint {joint.attribute('name')!r}"
        for one in joint.children:
            near = did_you_mean(one.name, _OF_A_JOINT)
            if one.name not in _OF_A_JOINT and near:
                _report(f"{what}: <{one.name}>", one, near, found)
            word = one.attribute("name") if one.name == "param" else ""
            near = did_you_mean(word, _PARAMS_OF_A_JOINT) if word else ""
            if word not in _PARAMS_OF_A_JOINT and near:  # drivers of real hardware have words of their own
                _report(f"{what}: <param name={word!r}>", one, near, found)


def _report(what: str, element: Params, near: str, found: Diagnostics) -> None:
    found.warning("SK-CONTROL-008", f"{what} is not known and not used", element.where, near)


def number(text: str, default: float, element: Params, found: Diagnostics, *, minimum: float = -_FARTHEST) -> float:
    """A finite number; what is none is an error, and the default is taken."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if minimum <= value <= _FARTHEST:
        return value
    allowed = "a number" if math.isnan(value) else f"a number from {minimum:g} to {_FARTHEST:g}"
    found.error("SK-PARAM-002", f"found {text!r}, allowed is {allowed}", element.where)
    return default


def bound(text: str, default: float, element: Params, found: Diagnostics) -> float:
    """A bound of an interface, which may be infinite; empty where there is none."""
    return default if text.strip().lower() in ("", "inf", "-inf") else number(text, default, element, found)


def initial(text: str, joint: SceneJoint, element: Params, found: Diagnostics) -> float:
    """A first position [rad or m], within the joint's limits; NaN where there is none."""
    value = number(text, math.nan, element, found) if text else math.nan
    axis = joint.axes[0]
    if axis.lower <= value <= axis.upper or math.isnan(value):
        return value
    kept = min(max(value, axis.lower), axis.upper)
    message = (
        f"joint {joint.name!r}: the initial_value {value:g} is outside its limits {axis.lower:g} and {axis.upper:g}"
    )
    found.warning("SK-CONTROL-008", f"{message}; it begins at {kept:g}", element.where)
    return kept


def break_circle(name: str, leaders: Mapping[str, str]) -> Sequence[str]:
    """The joints of the circle that a joint closes by mimicking its leader; empty where it closes none."""
    circle, one = [name], leaders[name]
    while one and one != name and one not in circle:
        circle.append(one)
        one = leaders.get(one, "")
    return circle if one == name else ()

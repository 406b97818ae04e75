"""Readers of attributes of URDF elements: numbers, vectors, texts and poses; an invalid value is an error."""

from __future__ import annotations

import math
from collections.abc import Sequence

from simkit.diagnostics import did_you_mean
from simkit.number_text import counted
from simkit.params import LARGEST, Params
from simkit.pose import IDENTITY, Pose
from simkit.scene.geometry import Vec3, vec3
from simkit.template_texts import find_template_text

FARTHEST = 1e15  # [m]; sums of larger poses overflow


def report_bad_value(element: Params, attribute: str, allowed: str) -> None:
    """Record an error for an invalid value."""
    text = element.attributes.get(attribute, "")
    shown = text if len(text) <= 60 else text[:57] + "..."
    hint = find_template_text(text)[1]
    element.error("SK-URDF-013", f'<{element.name} {attribute}="{shown}">: expected {allowed}', hint)


def report_missing(element: Params, attribute: str, allowed: str, owner: str = "") -> None:
    """Record an error for a missing attribute."""
    near = did_you_mean(attribute, element.attributes)
    prefix = f"{owner}: " if owner else ""
    element.error("SK-URDF-001", f"{prefix}<{element.name}> needs {attribute}= ({allowed})", near)


def report_substitute(element: Params, problem: str, instead: str, hint: str = "") -> None:
    """Record a warning for content that urdfdom rejects with a message, and the value that simkit uses instead."""
    element.warning("SK-URDF-031", f"{problem}; {instead}", hint)


def skip_element(element: Params) -> None:
    """Skip an element whose error has been reported; nothing inside it is reported."""
    element.mark_all_read()
    stack = [element]
    while stack:
        below = stack.pop()
        for name in below.attributes:
            below.attribute(name)
        stack += below.children


def text_attribute(element: Params, attribute: str) -> str:
    """Return an attribute without surrounding white space; empty if missing."""
    return element.attribute(attribute).strip()


def number_attribute(
    element: Params,
    attribute: str,
    default: float | None = None,
    minimum: float | None = None,
    finite: bool = True,
    owner: str = "",
) -> float:
    """Return a number; without a default the attribute is required.

    NaN, a number below the minimum, or with `finite` an infinite number is an error.
    """
    allowed = "a number" + ("" if minimum is None else f" of at least {minimum:g}")
    text = text_attribute(element, attribute)
    if attribute not in element.attributes:
        if default is None:
            report_missing(element, attribute, allowed, owner)
        return 0.0 if default is None else default
    value = parse_number(text)
    if value is None or (finite and math.isinf(value)) or (minimum is not None and value < minimum):
        report_bad_value(element, attribute, allowed)
        return 0.0 if default is None else default
    return value


def parse_number(text: str) -> float | None:
    """Parse a number; return None for any other text and for NaN."""
    if "_" in text or not text.isascii():
        return None
    try:
        value = float(text)
    except ValueError:
        return None
    return None if math.isnan(value) else value


def numbers_attribute(element: Params, attribute: str, count: int, allowed: str = "") -> tuple[float, ...] | None:
    """Return `count` finite numbers separated by white space; None if missing or, with an error, if invalid."""
    if attribute not in element.attributes:
        element.attribute(attribute)
        return None
    parts = [parse_number(part) for part in text_attribute(element, attribute).split()]
    if len(parts) != count or any(p is None or not abs(p) <= LARGEST for p in parts):
        report_bad_value(element, attribute, allowed or counted(count, "number"))
        return None
    return tuple(p for p in parts if p is not None)


def vector3_attribute(element: Params, attribute: str, default: Vec3 = (0.0, 0.0, 0.0)) -> Vec3:
    """Return three finite numbers."""
    numbers = numbers_attribute(element, attribute, 3)
    return default if numbers is None else vec3(numbers)


def leading_numbers(element: Params, attribute: str, count: int, allowed: str = "") -> tuple[float, ...] | None:
    """Return the first `count` numbers, with a warning if there are more; otherwise like `numbers_attribute`."""
    parts = text_attribute(element, attribute).split()
    if len(parts) > count and all(parse_number(part) is not None for part in parts):
        statement = f'<{element.name} {attribute}="{" ".join(parts[:8])}"> has {counted(len(parts), "number")}'
        report_substitute(
            element, statement, f"the first {count} are used", f"expected {allowed or counted(count, 'number')}"
        )
        element.attributes[attribute] = " ".join(parts[:count])
    return numbers_attribute(element, attribute, count, allowed)


def read_origin(owner: Params) -> Pose:
    """Return the `<origin>` of an element: `xyz` [m] and `rpy` [rad], or `quat_xyzw` (URDF 1.2)."""
    element = owner.child("origin")
    if element is None:
        return IDENTITY
    xyz = vector3_attribute(element, "xyz")
    if any(abs(v) > FARTHEST for v in xyz):
        report_bad_value(element, "xyz", f"numbers of at most {FARTHEST:g} m")
        xyz = (0.0, 0.0, 0.0)
    if "quat_xyzw" in element.attributes:
        quat = numbers_attribute(element, "quat_xyzw", 4)
        element.attribute("rpy")
        if quat is not None and 1e-6 < math.hypot(*quat) < FARTHEST:
            return Pose(xyz, (quat[3], quat[0], quat[1], quat[2]))
        if quat is not None:
            report_bad_value(element, "quat_xyzw", "a quaternion of length 1")
    return Pose.from_rpy(*xyz, *vector3_attribute(element, "rpy"))


def extension_text(element: Params) -> str:
    """Return the value of a Gazebo extension: its text, or its `value=`."""
    return element.value or text_attribute(element, "value")


def extension_boolean(element: Params) -> bool:
    """Return true for true, yes and 1, and false for false, no and 0; any other text is an error."""
    text = extension_text(element).lower()
    if text not in ("true", "yes", "1", "false", "no", "0"):
        element.error("SK-URDF-013", f"<{element.name}> is {extension_text(element)!r}; expected true or false")
    return text in ("true", "yes", "1")


def extension_numbers(element: Params, count: int) -> Sequence[float] | None:
    """Return the numbers of a Gazebo extension; None, with an error recorded, if not `count` finite numbers."""
    parts = [parse_number(part) for part in extension_text(element).split()]
    finite = [p for p in parts if p is not None and math.isfinite(p)]
    if len(finite) == len(parts) == count:
        return finite
    allowed = "a number" if count == 1 else counted(count, "number")
    hint = find_template_text(extension_text(element))[1]
    element.error("SK-URDF-013", f"<{element.name}> is {extension_text(element)!r}; expected {allowed}", hint)
    return None

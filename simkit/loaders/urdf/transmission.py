"""Readers of `<transmission>` and `<ros2_control>`, which are stored for controllers."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from simkit.diagnostics import did_you_mean
from simkit.loaders.urdf.element_attributes import (
    extension_text,
    parse_number,
    report_missing,
    report_substitute,
    text_attribute,
)
from simkit.loaders.urdf.robot_draft import RobotDraft
from simkit.params import Params
from simkit.scene import Transmission, TransmissionEnd

_KINDS = {
    "simple": ("simple", "pr2gripper"),
    "differential": ("differential", "wrist"),
    "four_bar_linkage": ("fourbarlinkage", "four_bar_linkage", "four-bar"),
}
_JOINTS: Final = ("joint", "flexJoint", "rollJoint", "gap_joint")
_ACTUATORS: Final = ("actuator", "rightActuator", "leftActuator")
"""Elements of a joint and of an actuator; those after the first belong to the wrist and the gripper of PR2."""


def read_transmissions(draft: RobotDraft) -> tuple[Transmission, ...]:
    """Return every transmission in document order."""
    return tuple(_transmission(draft, element) for element in draft.element.all("transmission"))


def read_controls(draft: RobotDraft) -> tuple[Params, ...]:
    """Return the `<ros2_control>` blocks unchanged; a reference to an unknown joint is reported."""
    blocks = draft.element.all("ros2_control")
    for block in blocks:
        block.mark_all_read()
        for owner in (block, *block.all("transmission")):
            for joint in owner.all("joint"):
                _is_known_joint(draft, joint, f"<{block.name} name={text_attribute(block, 'name')!r}>")
    return tuple(blocks)


def _transmission(draft: RobotDraft, element: Params) -> Transmission:
    name = text_attribute(element, "name")
    if not name:
        report_missing(element, "name", "a text")
    written = element.child("type")
    older = text_attribute(element, "type")
    kind = (written.value if written is not None else "") or older
    if not kind:
        element.warning("SK-URDF-025", f"transmission {name!r} needs <type>")
    common = _reduction(element, 1.0)
    joints = [joint for name in _JOINTS for joint in element.all(name)]
    motors = [motor for name in _ACTUATORS for motor in element.all(name)]
    for joint in (*joints, *element.all("passive_joint")):
        _is_known_joint(draft, joint, f"transmission {name!r}")
    if not joints:
        near = did_you_mean("joint", [c.name for c in element.children])
        element.warning("SK-URDF-025", f"transmission {name!r} names no <joint>", near)
    ends, actuators = [_transmission_end(e, 1.0) for e in joints], [_transmission_end(e, common) for e in motors]
    if kind.rpartition("/")[2] == "WristTransmission" and len(ends) == len(actuators) == 2:
        # a1 = n1 (m1 x1 - m2 x2) and a2 = -n2 (m1 x1 + m2 x2), of wrist_transmission.cpp in pr2_mechanism_model
        ends[1], actuators[1] = (replace(end, reduction=-end.reduction) for end in (ends[1], actuators[1]))
    return Transmission(
        name=name,
        kind=_kind(kind),
        type=kind,
        joints=tuple(ends),
        actuators=tuple(actuators),
        params=element,
        where=element.where,
    )


def _kind(written: str) -> str:
    """Return the kind of a transmission type: `transmission_interface/SimpleTransmission` is simple."""
    plain = written.rpartition("/")[2].rpartition("::")[2].lower()
    for kind, starts in _KINDS.items():
        if plain.startswith(starts):
            return kind
    return written


def _transmission_end(element: Params, reduction: float) -> TransmissionEnd:
    role, older = element.child("role"), text_attribute(element, "role")
    return TransmissionEnd(
        name=text_attribute(element, "name"),
        reduction=_reduction(element, _attribute_number(element, "mechanicalReduction", reduction)),
        offset=_number(element, "offset", 0.0),
        role=role.value if role is not None else older,
        interfaces=tuple(i.value for i in element.all("hardwareInterface")),
    )


def _attribute_number(element: Params, name: str, default: float) -> float:
    """Return the number in an attribute, in which PR2's wrist has its reductions; the default without a number."""
    value = parse_number(text_attribute(element, name))
    return default if value is None or value == 0 or abs(value) == float("inf") else value


def _reduction(element: Params, default: float) -> float:
    reduction = _number(element, "mechanicalReduction", default)
    if reduction == 0:
        element.child_or_self("mechanicalReduction").error("SK-URDF-013", "<mechanicalReduction> cannot be 0")
        return default
    return reduction


def _number(element: Params, name: str, default: float) -> float:
    number_element = element.child(name)
    if number_element is None:
        return default
    value = parse_number(extension_text(number_element))
    if value is None or abs(value) == float("inf"):
        report_substitute(
            number_element, f"<{name}> is {extension_text(number_element)!r}; expected a number", f"{default:g} is used"
        )
        return default
    return value


def _is_known_joint(draft: RobotDraft, joint: Params, owner: str) -> None:
    name = text_attribute(joint, "name")
    if name not in draft.joints and name not in draft.faulty_joints:
        joint.warning("SK-URDF-025", f"{owner}: the robot has no joint {name!r}", did_you_mean(name, draft.joints))

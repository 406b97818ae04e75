"""Description of a robot's control hardware, read from `<ros2_control>` or `<transmission>`."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

from simkit import Params
from simkit.extend import Diagnostics, Where, did_you_mean
from simkit.number_text import is_number, number_or_nan
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT, KD, KP, POSITION, VELOCITY
from simkit_control.plugins.ros2_control.hardware_joint import PidGains

if TYPE_CHECKING:
    from simkit.extend import SceneJoint, SceneModel


_LARGEST_NUMBER: Final = 1e15
"""Largest number for positions [rad or m], gains and the like; the engine cannot compute motion with larger ones."""
_ELEMENTS: Final = ("hardware", "joint", "sensor", "gpio", "transmission")
_JOINT_ELEMENTS: Final = ("command_interface", "state_interface", "param", "limits", "property", "properties")
_GAINS: Final = ("kp", "ki", "kd", "max_integral_error")
_JOINT_PARAMS: Final = ("mimic", "multiplier", "offset", *(f"{s}_{g}" for s in ("pos", "vel") for g in _GAINS))


def report_unknown_elements(block: Params, diagnostics: Diagnostics) -> None:
    """Report unknown elements of `<ros2_control>`, and elements and parameters of joints that look misspelt."""
    owner = f"<ros2_control> {block.attribute('name')!r}"
    for child in block.children:
        if child.name not in _ELEMENTS and ":" not in child.name:
            _report_unused(f"{owner}: <{child.name}>", child, did_you_mean(child.name, _ELEMENTS), diagnostics)
    for joint in block.all("joint"):
        what = f"{owner}, joint {joint.attribute('name')!r}"
        for child in joint.children:
            near = did_you_mean(child.name, _JOINT_ELEMENTS)
            if child.name not in _JOINT_ELEMENTS and near:
                _report_unused(f"{what}: <{child.name}>", child, near, diagnostics)
            name = child.attribute("name") if child.name == "param" else ""
            near = did_you_mean(name, _JOINT_PARAMS) if name else ""
            if name not in _JOINT_PARAMS and near:  # other unknown names may be parameters of a hardware driver
                _report_unused(f"{what}: <param name={name!r}>", child, near, diagnostics)


def _report_unused(what: str, element: Params, near: str, diagnostics: Diagnostics) -> None:
    diagnostics.warning("SK-CONTROL-008", f"{what} is not known and is ignored", element.where, near)


def parse_number(
    text: str, default: float, element: Params, diagnostics: Diagnostics, *, minimum: float = -_LARGEST_NUMBER
) -> float:
    """Parse a finite number; report an invalid one as an error and return the default."""
    value = number_or_nan(text)
    if minimum <= value <= _LARGEST_NUMBER:
        return value
    allowed = "a number" if math.isnan(value) else f"a number from {minimum:g} to {_LARGEST_NUMBER:g}"
    diagnostics.error("SK-PARAM-002", f"found {text!r}; expected {allowed}", element.where)
    return default


def parse_initial_position(text: str, joint: SceneJoint, element: Params, diagnostics: Diagnostics) -> float:
    """Parse an initial position [rad or m] and clamp it to the joint's limits; return NaN for an empty text."""
    value = parse_number(text, math.nan, element, diagnostics) if text else math.nan
    axis = joint.axes[0]
    if axis.lower <= value <= axis.upper or math.isnan(value):
        return value
    clamped = min(max(value, axis.lower), axis.upper)
    message = (
        f"joint {joint.name!r}: the initial_value {value:g} is outside its limits [{axis.lower:g}, {axis.upper:g}]"
    )
    diagnostics.warning("SK-CONTROL-008", f"{message}; the joint starts at {clamped:g}", element.where)
    return clamped


def mimic_circle(name: str, leaders: Mapping[str, str]) -> Sequence[str]:
    """Return the joints of a circle of mimic relations that contains a joint; empty if there is no circle."""
    circle, leader = [name], leaders[name]
    while leader and leader != name and leader not in circle:
        circle.append(leader)
        leader = leaders.get(leader, "")
    return circle if leader == name else ()


MOTION_INTERFACES: Final = (POSITION, VELOCITY, EFFORT)
GAIN_INTERFACES: Final = (KP, KD)
"""Command interfaces of joints whose motors have a spring and a damper with commanded gains, as those of quadrupeds."""
_ROS_1: Final = {"PositionJointInterface": POSITION, "VelocityJointInterface": VELOCITY, "EffortJointInterface": EFFORT}
_SIMULATION_PLUGINS: Final = ("GazeboSystem", "GazeboSimSystem", "IgnitionSystem")


@dataclass(frozen=True, slots=True)
class JointDescription:
    """Joint of the hardware.

    Attributes:
        name: plain name.
        commands, states: names of its interfaces, in the order of the file.
        where: location in the file.
        pids: PID gains in the description, by interface (position, velocity).
        leader, multiplier, offset: mimic relation declared in the hardware description; no leader if empty.
        initial: initial position [rad or m]; NaN if the file has none.
    """

    name: str
    commands: tuple[str, ...]
    states: tuple[str, ...]
    where: Where = field(default_factory=Where)
    pids: dict[str, PidGains] = field(default_factory=dict)
    leader: str = ""
    multiplier: float = 1.0
    offset: float = 0.0
    initial: float = math.nan


@dataclass(frozen=True, slots=True)
class SensorDescription:
    """Sensor of the hardware: its name and its interfaces, such as `orientation.x`."""

    name: str
    interfaces: tuple[str, ...]
    where: Where = field(default_factory=Where)


@dataclass(frozen=True, slots=True)
class ComponentDescription:
    """Component of the hardware: one `<ros2_control>` block, or all `<transmission>` blocks together.

    Attributes:
        name: name of the component.
        kind: system, actuator or sensor.
        plugin: class of the hardware as written in the file.
        joints: joints of the component.
        sensors: sensors of the component.
    """

    name: str
    kind: str
    plugin: str
    joints: tuple[JointDescription, ...] = ()
    sensors: tuple[SensorDescription, ...] = ()


def describe_hardware(scene: SceneModel, params: Params) -> list[ComponentDescription]:
    """Describe the control hardware of a model.

    The description comes from `<ros2_control>` (of the URDF file, or in the plugin's own element), else from
    `<transmission>`. Without either, every joint with one axis gets all interfaces, and a note reports that.

    Args:
        scene: model whose hardware is described.
        params: parameters of the plugin; problems are recorded there.
    """
    diagnostics = params.diagnostics
    blocks = [*scene.controls, *params.all("ros2_control")]
    for block in blocks:
        block.mark_all_read()
        report_unknown_elements(block, diagnostics)
    if blocks:
        return _remove_mimic_circles(
            _remove_repeated_joints([_component(scene, block, diagnostics) for block in blocks], diagnostics),
            diagnostics,
        )
    if scene.transmissions:
        return [_component_of_transmissions(scene, diagnostics)]
    names = [joint.name for joint in scene.all_joints() if _is_drivable(joint)]
    message = (
        f"model {scene.scoped!r} has neither <ros2_control> nor <transmission>: each of its joints with one axis can "
        f"be commanded by position, velocity or effort"
    )
    diagnostics.note("SK-CONTROL-005", message, params.where)
    joints = tuple(JointDescription(name, MOTION_INTERFACES, MOTION_INTERFACES) for name in names)
    return [ComponentDescription(scene.name, "system", "simkit", joints)]


def _is_drivable(joint: SceneJoint) -> bool:
    return len(joint.axes) == 1 and joint.type in ("revolute", "continuous", "prismatic") and not joint.axes[0].mimic


# ------------------------------------------------------------------ <ros2_control>


def _component(scene: SceneModel, block: Params, diagnostics: Diagnostics) -> ComponentDescription:
    hardware = block.block("hardware")
    plugin = hardware.text("plugin", "")
    name = block.attribute("name") or "hardware"
    if plugin.rpartition("/")[2] not in _SIMULATION_PLUGINS:
        message = f"<ros2_control> {name!r}: the simulation replaces the hardware {plugin or '(none)'!r}"
        diagnostics.note("SK-CONTROL-006", message, block.where)
    for unknown in (c for c in block.children if c.name == "gpio"):
        message = f"<ros2_control> {name!r}: <gpio> {unknown.attribute('name')!r} is not supported"
        diagnostics.warning("SK-CONTROL-007", f"{message}; it is ignored", unknown.where)
    joints = [_joint(scene, element, diagnostics) for element in block.all("joint")]
    sensors = [_sensor(element) for element in block.all("sensor")]
    kind = block.attribute("type") or "system"
    return ComponentDescription(name, kind, plugin, tuple(j for j in joints if j is not None), tuple(sensors))


def _joint(scene: SceneModel, element: Params, diagnostics: Diagnostics) -> JointDescription | None:
    name = element.attribute("name")
    joints = {joint.name: joint for joint in scene.all_joints()}
    if name not in joints:
        message = f"<ros2_control> names joint {name!r}, which model {scene.scoped!r} does not have; it is ignored"
        diagnostics.warning("SK-CONTROL-008", message, element.where, did_you_mean(name, joints))
        return None
    if len(joints[name].axes) != 1:
        message = f"<ros2_control> names joint {name!r}, a {joints[name].type} joint; the joint needs exactly one axis"
        diagnostics.warning("SK-CONTROL-008", f"{message}; it is ignored", element.where)
        return None
    texts = _param_texts(element)
    commands, states = element.all("command_interface"), element.all("state_interface")
    initial = _initial_position([*commands, *states], joints[name], diagnostics)
    pids = {}
    for command in (element.attribute("name") for element in commands):
        plain = command.removesuffix("_pid")
        short = {"position": "pos", "velocity": "vel"}.get(plain, "")
        if short and (command != plain or f"{short}_kp" in texts):
            pids[plain] = _gains_of_joint(texts, short, element, diagnostics)
    known_commands = _known_interfaces(name, "command", commands, element, diagnostics)
    known_states = _known_interfaces(name, "state", states, element, diagnostics)
    leader = texts.get("mimic", "")
    if leader and leader not in joints:
        message = f"joint {name!r} mimics {leader!r}, which model {scene.scoped!r} does not have"
        diagnostics.warning(
            "SK-CONTROL-008", f"{message}; the mimic is ignored", element.where, did_you_mean(leader, joints)
        )
        leader = ""
    return JointDescription(
        name,
        tuple(command.removesuffix("_pid") for command in known_commands),
        known_states,
        element.where,
        pids,
        leader,
        parse_number(texts.get("multiplier", "1"), 1.0, element, diagnostics),
        parse_number(texts.get("offset", "0"), 0.0, element, diagnostics),
        initial,
    )


def _known_interfaces(
    joint: str, kind: str, interfaces: Iterable[Params], element: Params, diagnostics: Diagnostics
) -> tuple[str, ...]:
    """Return the names of the supported interfaces of a joint, and report the others."""
    known = []
    supported = (*MOTION_INTERFACES, *GAIN_INTERFACES) if kind == "command" else MOTION_INTERFACES
    for name in (interface.attribute("name") for interface in interfaces):
        if name in supported or (kind == "command" and name.removesuffix("_pid") in MOTION_INTERFACES):
            known.append(name)
            continue
        message = f"joint {joint!r}: {kind} interface {name!r} is not supported "
        message += f"(supported: {', '.join(supported)})"
        near = did_you_mean(name, supported)
        diagnostics.warning("SK-CONTROL-009", f"{message}; it is ignored", element.where, near)
    return tuple(known)


def _param_texts(element: Params) -> dict[str, str]:
    """Return the texts of an element's `<param name="…">` by name."""
    return {param.attribute("name"): param.value for param in element.all("param")}


def _initial_position(interfaces: Iterable[Params], joint: SceneJoint, diagnostics: Diagnostics) -> float:
    """Return the initial position of the interfaces, or NaN if there is none; also validate their unused bounds."""
    initial = []
    for interface in interfaces:
        texts = _param_texts(interface)
        for bound in (texts.get("min", ""), texts.get("max", "")):
            if bound.strip().lower() not in ("", "inf", "-inf") and not is_number(bound):
                message = f"the bound {bound!r:.100} is not a number; it has no effect, as in Gazebo"
                diagnostics.warning("SK-PARAM-005", message, interface.where)
        if interface.name == "state_interface" and interface.attribute("name") == POSITION:  # Gazebo ignores others
            first = texts.get("initial_value", interface.attribute("initial_value"))
            initial.append(parse_initial_position(first, joint, interface, diagnostics))
    return initial[0] if initial else math.nan


def _gains_of_joint(texts: dict[str, str], short: str, element: Params, diagnostics: Diagnostics) -> PidGains:
    """Read gains from the `<param>`s of a joint: `pos_kp`, `pos_ki`, `pos_kd`, `pos_max_integral_error`."""

    def gain(name: str) -> float:
        text = texts.get(f"{short}_{name}", "")
        return parse_number(text, 0.0, element, diagnostics) if text else 0.0

    i, text = gain("ki"), texts.get(f"{short}_max_integral_error", "")
    most = parse_number(text, math.inf, element, diagnostics, minimum=0.0) if text else math.inf
    limit = abs(i * most) if i else 0.0
    return PidGains(gain("kp"), i, gain("kd"), limit, -limit)


def _sensor(element: Params) -> SensorDescription:
    names = tuple(interface.attribute("name") for interface in element.all("state_interface"))
    return SensorDescription(element.attribute("name"), names, element.where)


def _remove_repeated_joints(
    components: list[ComponentDescription], diagnostics: Diagnostics
) -> list[ComponentDescription]:
    """Remove joints that an earlier block has already named."""
    seen: set[str] = set()
    cleaned = []
    for component in components:
        joints = []
        for joint in component.joints:
            if joint.name in seen:
                message = f"<ros2_control> {component.name!r} names joint {joint.name!r} again; the first one is used"
                diagnostics.warning("SK-CONTROL-004", message, joint.where)
                continue
            seen.add(joint.name)
            joints.append(joint)
        cleaned.append(replace(component, joints=tuple(joints)))
    return cleaned


def _remove_mimic_circles(
    components: list[ComponentDescription], diagnostics: Diagnostics
) -> list[ComponentDescription]:
    """Remove the leader of a joint that mimics itself, directly or through other joints."""
    leaders = {joint.name: joint.leader for component in components for joint in component.joints}
    cleaned = []
    for component in components:
        joints = []
        for joint in component.joints:
            circle = mimic_circle(joint.name, leaders)
            if circle:
                message = f"joint {joint.name!r} mimics {' which mimics '.join(map(repr, [*circle[1:], joint.name]))}"
                diagnostics.warning("SK-CONTROL-008", f"{message}; the mimic is ignored", joint.where)
                leaders[joint.name] = ""
            joints.append(replace(joint, leader="") if circle else joint)
        cleaned.append(replace(component, joints=tuple(joints)))
    return cleaned


# ------------------------------------------------------------------ <transmission>


def _component_of_transmissions(scene: SceneModel, diagnostics: Diagnostics) -> ComponentDescription:
    joints = {joint.name: joint for joint in scene.all_joints()}
    interfaces: dict[str, list[str]] = {}
    locations: dict[str, Where] = {}
    for transmission in scene.transmissions:
        for end in transmission.joints:
            if end.name not in joints or len(joints[end.name].axes) != 1:
                continue  # the loader has reported a missing joint
            written = end.interfaces or tuple(i for a in transmission.actuators for i in a.interfaces)
            names = _interfaces_of_ros_1(written, transmission.name, transmission.where, diagnostics)
            interfaces.setdefault(end.name, []).extend(names)
            locations.setdefault(end.name, transmission.where)
    return ComponentDescription(
        scene.name,
        "system",
        "gazebo_ros_control/DefaultRobotHWSim",
        tuple(
            JointDescription(name, tuple(dict.fromkeys(names)), MOTION_INTERFACES, locations[name])
            for name, names in interfaces.items()
        ),
    )


def _interfaces_of_ros_1(written: Sequence[str], owner: str, where: Where, diagnostics: Diagnostics) -> list[str]:
    names = []
    for interface in written:
        plain = interface.rpartition("/")[2]
        if plain in _ROS_1:
            names.append(_ROS_1[plain])
        elif plain != "JointStateInterface":  # this interface only reads states, and every joint has state interfaces
            message = f"transmission {owner!r}: hardware interface {interface!r} is not supported "
            message += f"(supported: {', '.join(_ROS_1)})"
            diagnostics.warning("SK-CONTROL-009", f"{message}; it is ignored", where, did_you_mean(plain, _ROS_1))
    return names

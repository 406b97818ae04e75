"""What of a robot's file has no effect: unknown elements and attributes, and those of other tools."""

from __future__ import annotations

from collections.abc import Iterator

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.loaders.sdf.element_table import sdf_elements
from simkit.loaders.sdf.unread_elements import report_unread as report_sdf
from simkit.loaders.urdf.gazebo_extensions import GazeboExtensions
from simkit.params import Params

_Loud = dict[tuple[str, str, str], list[Where]]  # (message, code, hint) -> places
_TOOLS_WORDS = """
    contact self_collision_checking joint_properties frame collision_checking verbose gravity kinematic
    sensor simulated_actuated_joint compliance gear_ratio rotor_inertia saturationLower saturationUpper deadBandUpper
    deadBandLower ignoreTransmissionAbsoluteEncoder robotNamespace hardwareInterface leftActuator rightActuator
    flexJoint rollJoint gap_joint passive_joint use_simulated_gripper_joint simulated_reduction collision_filter_group
    loop_joint parent2 child2 origin actuator_frame force_element bushing
"""
_OF_OTHER_TOOLS = frozenset(_TOOLS_WORDS.split())
# Bullet, Drake, OpenRAVE, PR2: elements and attributes that Gazebo ignores as well.
_TOOLS_ATTRIBUTES = "version concave current command_effort gear_velocity acceleration jerk D K mu_coulomb mu_viscous"
_ATTRIBUTES_OF_OTHER_TOOLS = frozenset(_TOOLS_ATTRIBUTES.split())
_GAZEBO_WORDS = "provideFeedback implicitSpringDamper cfmDamping stopCfm stopErp fudgeFactor maxContacts physics"
_SETTINGS_OF_GAZEBO = frozenset(_GAZEBO_WORDS.split())
_SHORT = """
mu1 mu2 fdir1 kp kd minDepth maxVel softCfm softErp laserRetro selfCollide turnGravityOff dampingFactor material
visual collision springStiffness springReference preserveFixedJoint disableFixedJointLumping
"""
_SHORT_WORDS = frozenset(_SHORT.split())  # of <gazebo>, which SDF has under other names
_KEPT = frozenset(("transmission", "ros2_control", "gazebo"))


def report_unread(robot: Params, extensions: GazeboExtensions, diagnostics: Diagnostics) -> None:
    """A warning for each unknown element or attribute; one note for those of other tools; Gazebo's as in SDF."""
    quiet: dict[str, list[Where]] = {}
    loud: _Loud = {}
    for element in _read_elements(robot):
        for child in element.children:
            if ":" in child.name or child.was_read or (element is robot and child.name in _KEPT):
                continue
            if child.name in _OF_OTHER_TOOLS or (child.name, element.name) == ("material", "collision"):
                quiet.setdefault(f"<{child.name}> in <{element.name}>", []).append(child.where)
                continue
            key = (f"<{child.name}> in <{element.name}> is not known and not used", "SK-URDF-010", "")
            hint = did_you_mean(child.name, element.asked)
            loud.setdefault((key[0], key[1], hint), []).append(child.where)
        for name in element.attributes:
            if ":" in name or name.startswith("xmlns") or name in element.attributes_asked:
                continue
            text = f"{name}= of <{element.name}>"
            if name in _ATTRIBUTES_OF_OTHER_TOOLS:
                quiet.setdefault(text, []).append(element.where)
                continue
            hint = did_you_mean(name, element.attributes_asked)
            loud.setdefault((f"{text} is not known and not used", "SK-URDF-012", hint), []).append(element.where)
    _report_extensions(robot, extensions, loud, diagnostics)
    for (message, code, hint), places in loud.items():
        diagnostics.warning(code, message + _repeated(places), places[0], hint)
    if quiet:
        listed = ", ".join(
            f"{what} (line {places[0].line}{_remaining_count(places)})" for what, places in quiet.items()
        )
        first = min((p for places in quiet.values() for p in places), key=lambda w: w.line or 0)
        diagnostics.note("SK-URDF-011", f"words of other tools, without effect here and in Gazebo: {listed}", first)


def _report_extensions(robot: Params, extensions: GazeboExtensions, loud: _Loud, diagnostics: Diagnostics) -> None:
    """One note for Gazebo's settings of solvers; the rest as in an SDF model."""
    settings: dict[str, list[Where]] = {}
    parts: list[Params] = []
    for name, block in extensions.merged.items():
        kind = extensions.kinds.get(name, "")
        if name and not kind:
            continue  # a reference to nothing is reported already
        place = kind or "model"
        kept = []
        for child in block.children:
            if child.name in _SETTINGS_OF_GAZEBO:
                settings.setdefault(child.name, []).append(child.where)
            elif child.name in _SHORT_WORDS or ":" in child.name:
                if not child.was_read and ":" not in child.name:
                    message = f"<{child.name}> has no meaning for a {place if name else 'robot'} and is not used"
                    loud.setdefault((message, "SK-URDF-010", ""), []).append(child.where)
            elif sdf_elements().row(place, child.name) is None:
                hint = did_you_mean(child.name, [*block.asked, *sdf_elements().elements(place)])
                message = f"<{child.name}> in <gazebo> is not known and not used"
                loud.setdefault((message, "SK-URDF-010", hint), []).append(child.where)
            else:
                kept.append(child)
        parts += [Params(place, "", {}, kept, block.where, diagnostics)] if name else kept
    model = Params("model", "", {}, parts, robot.where, diagnostics)
    for part in ("link", "joint"):
        model.all(part)
    if settings:
        listed = ", ".join(
            f"<{name}> (line {places[0].line}{_remaining_count(places)})" for name, places in settings.items()
        )
        first = min((p for places in settings.values() for p in places), key=lambda w: w.line or 0)
        diagnostics.note("SK-URDF-022", f"settings of Gazebo's without effect here: {listed}", first)
    report_sdf(model, diagnostics, "model")


def _read_elements(robot: Params) -> Iterator[Params]:
    """Every element that was read, outermost first, but not what is kept whole for others."""
    stack = [robot]
    while stack:
        element = stack.pop()
        yield element
        below = [c for c in element.children if c.was_read and not (element is robot and c.name in _KEPT)]
        stack += reversed(below)


def _repeated(places: list[Where]) -> str:
    if len(places) == 1:
        return ""
    lines = ", ".join(str(p.line) for p in places[:6])
    return f" ({len(places)} times: lines {lines}{', ...' if len(places) > 6 else ''})"


def _remaining_count(places: list[Where]) -> str:
    return f", {len(places)} times" if len(places) > 1 else ""

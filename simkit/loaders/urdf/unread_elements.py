"""Report on parts of a robot's file without effect: unknown elements and attributes, and those of other tools."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from simkit.diagnostics import Where, did_you_mean
from simkit.loaders.sdf.element_table import sdf_elements
from simkit.loaders.sdf.unread_elements import report_unread as report_sdf
from simkit.loaders.urdf.gazebo_extensions import GazeboExtensions
from simkit.loaders.urdf.link import PLUGIN_ELEMENTS
from simkit.params import Params

_Places = defaultdict[str, list[Where]]
_Warnings = defaultdict[tuple[str, str, str], list[Where]]  # (message, code, hint) -> places
_TOOLS_ELEMENTS = """
    contact self_collision_checking joint_properties frame collision_checking verbose gravity kinematic
    sensor simulated_actuated_joint compliance gear_ratio rotor_inertia saturationLower saturationUpper deadBandUpper
    deadBandLower ignoreTransmissionAbsoluteEncoder robotNamespace hardwareInterface leftActuator rightActuator
    flexJoint rollJoint gap_joint passive_joint use_simulated_gripper_joint simulated_reduction collision_filter_group
    loop_joint parent2 child2 origin actuator_frame force_element bushing model_state
"""
# Elements and attributes of Bullet, Drake, OpenRAVE and PR2, and those of the URDF specification that nobody reads,
# which Gazebo ignores as well.
_SENSOR_HINT = "a sensor that measures: <gazebo reference='LINK'><sensor type='camera'> or 'ray', as in an SDF file"
_OF_OTHER_TOOLS = frozenset(_TOOLS_ELEMENTS.split())
_TOOLS_ATTRIBUTES = "version concave current command_effort gear_velocity acceleration jerk D K mu_coulomb mu_viscous"
_ATTRIBUTES_OF_OTHER_TOOLS = frozenset(_TOOLS_ATTRIBUTES.split())
_GAZEBO_ELEMENTS = "provideFeedback implicitSpringDamper cfmDamping stopCfm stopErp fudgeFactor maxContacts physics"
_SETTINGS_OF_GAZEBO = frozenset(_GAZEBO_ELEMENTS.split())
_SHORT = """
mu1 mu2 fdir1 kp kd minDepth maxVel softCfm softErp laserRetro selfCollide turnGravityOff dampingFactor material
visual collision springStiffness springReference preserveFixedJoint disableFixedJointLumping
"""
_SHORT_ELEMENTS = frozenset(_SHORT.split())  # elements of <gazebo> that have other names in SDF
_KEPT = frozenset(("transmission", "ros2_control", "gazebo"))


def report_unread(robot: Params, extensions: GazeboExtensions) -> None:
    """Report a warning for each unknown name, one note for names of other tools, and Gazebo's elements as in SDF."""
    notes: _Places = defaultdict(list)
    warnings: _Warnings = defaultdict(list)
    for element in _read_elements(robot):
        for child in element.children:
            if ":" in child.name or child.was_read or (element is robot and child.name in _KEPT):
                continue
            if child.name in _OF_OTHER_TOOLS or (child.name, element.name) == ("material", "collision"):
                notes[f"<{child.name}> in <{element.name}>"].append(child.where)
                continue
            hint = did_you_mean(child.name, element.asked)
            message = f"<{element.name}> has no element <{child.name}>; it is ignored"
            warnings[message, "SK-URDF-010", hint].append(child.where)
        for name in element.attributes:
            if ":" in name or name.startswith("xmlns") or name in element.attributes_asked:
                continue
            if name in _ATTRIBUTES_OF_OTHER_TOOLS:
                notes[f"{name}= of <{element.name}>"].append(element.where)
                continue
            hint = did_you_mean(name, element.attributes_asked)
            message = f"<{element.name}> has no attribute {name}=; it is ignored"
            warnings[message, "SK-URDF-012", hint].append(element.where)
    _report_extensions(robot, extensions, warnings)
    for (message, code, hint), places in warnings.items():
        robot.diagnostics.warning(code, message + _repeated(places), places[0], hint)
    hint = _SENSOR_HINT if "<sensor> in <robot>" in notes else ""
    _note_all("SK-URDF-011", "elements of other tools, without effect in simkit and in Gazebo", notes, robot, hint)
    water: _Places = defaultdict(list)
    for child in (child for link in robot.all("link") for child in link.children if child.name in PLUGIN_ELEMENTS):
        water[f"<{child.name}> in <link>"].append(child.where)
    _note_all("SK-URDF-033", "elements for libfreefloating_gazebo_fluid.so of the world", water, robot)


def _note_all(code: str, message: str, counted: _Places, robot: Params, hint: str = "") -> None:
    """Record one note that lists the found names with lines; none if the list is empty."""
    if counted:
        counts = {name: f", {len(places)} times" if len(places) > 1 else "" for name, places in counted.items()}
        listed = ", ".join(f"{name} (line {places[0].line}{counts[name]})" for name, places in counted.items())
        first = min((p for places in counted.values() for p in places), key=lambda w: w.line or 0)
        robot.diagnostics.note(code, f"{message}: {listed}", first, hint)


def _report_extensions(robot: Params, extensions: GazeboExtensions, warnings: _Warnings) -> None:
    """Record one note for the settings of Gazebo's solvers; report all others as in an SDF model."""
    settings: _Places = defaultdict(list)
    parts: list[Params] = []
    for name, block in extensions.merged.items():
        kind = extensions.kinds.get(name, "")
        if name and not kind:
            continue  # the reference to an unknown name is already reported
        place = kind or "model"
        children = []
        for child in block.children:
            if child.name in _SETTINGS_OF_GAZEBO:
                settings[f"<{child.name}>"].append(child.where)
            elif child.name in _SHORT_ELEMENTS or ":" in child.name:
                if not child.was_read and ":" not in child.name:
                    message = f"<{child.name}> has no effect on a {place if name else 'robot'}"
                    warnings[message, "SK-URDF-010", ""].append(child.where)
            elif sdf_elements().row(place, child.name) is None:
                hint = did_you_mean(child.name, [*block.asked, *sdf_elements().elements(place)])
                message = f"<gazebo> has no element <{child.name}>; it is ignored"
                warnings[message, "SK-URDF-010", hint].append(child.where)
            else:
                children.append(child)
        parts += [Params(place, "", {}, children, block.where, robot.diagnostics)] if name else children
    model = Params("model", "", {}, parts, robot.where, robot.diagnostics)
    for part in ("link", "joint"):
        model.all(part)
    _note_all("SK-URDF-022", "Gazebo's own settings, without effect in simkit", settings, robot)
    report_sdf(model, "model")


def _read_elements(robot: Params) -> Iterator[Params]:
    """Yield every element that was read, outermost first, except inside blocks that are stored as a whole."""
    stack = [robot]
    while stack:
        element = stack.pop()
        yield element
        kept = _KEPT if element is robot else PLUGIN_ELEMENTS
        below = [c for c in element.children if c.was_read and c.name not in kept]
        stack += reversed(below)


def _repeated(places: list[Where]) -> str:
    if len(places) == 1:
        return ""
    lines = ", ".join(str(p.line) for p in places[:6])
    return f" ({len(places)} times: lines {lines}{', ...' if len(places) > 6 else ''})"

"""Joints that cannot move as the file says, and what hangs on them."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import INERTIAL, joint, model, python, world

_AXIS = "<axis><xyz>0 0 1</xyz></axis>"
_FLAG = """<robot name="robot">
  <link name="base">
    <inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="flag"/>
  <joint name="pole" type="continuous"><parent link="base"/><child link="flag"/><axis xyz="0 0 1"/></joint>
</robot>
"""
_HOLLOW = '<robot name="robot"><link name="base"/></robot>'
_RING = f"""
<link name="base">{INERTIAL}</link>
<link name="left">{INERTIAL}</link>
<link name="right">{INERTIAL}</link>
<joint name="a" type="revolute">
  <parent>base</parent><child>left</child>
  <axis><xyz>0 0 1</xyz><mimic joint="b"><multiplier>1</multiplier></mimic></axis>
</joint>
<joint name="b" type="revolute">
  <parent>base</parent><child>right</child>
  <axis><xyz>0 0 1</xyz><mimic joint="a"><multiplier>1</multiplier></mimic></axis>
</joint>
"""
_BOTH_STATIC = """
<model name="a"><static>true</static><link name="l"/></model>
<model name="b"><static>true</static><pose>2 0 0 0 0 0</pose><link name="l"/></model>
<joint name="door" type="revolute"><parent>a::l</parent><child>b::l</child><axis><xyz>0 0 1</xyz></axis></joint>
"""
_LOOP = f"""<sdf version="1.9"><model name="m">
<link name="base">{INERTIAL}</link>
<link name="left"><pose>-1 0 0 0 0 0</pose>{INERTIAL}</link>
<link name="right"><pose>1 0 0 0 0 0</pose>{INERTIAL}</link>
<joint name="a" type="revolute"><parent>base</parent><child>left</child>{_AXIS}</joint>
<joint name="b" type="revolute"><parent>base</parent><child>right</child>{_AXIS}</joint>
<joint name="rod" type="revolute"><parent>left</parent><child>right</child>{_AXIS}</joint>
</model></sdf>
"""
_CHAIN = """
    import simkit
    links = "".join(f"<link name='l{i}'/>" for i in range(1100))
    joint = "<joint name='j{1}' type='ball'><parent>l{0}</parent><child>l{1}</child></joint>"
    joints = "".join(joint.format(i, i + 1) for i in range(1099))
    simkit.load(f"<sdf version='1.9'><model name='m'>{links}{joints}</model></sdf>")
"""
_DRIVE = """
<link name="base">{inertial}</link>
<link name="left">{inertial}</link>
<link name="right">{inertial}</link>
<joint name="left_wheel" type="revolute"><parent>base</parent><child>left</child>{weak}</joint>
<joint name="right_wheel" type="revolute"><parent>base</parent><child>right</child>{weak}</joint>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
  <left_joint>left_wheel</left_joint><right_joint>right_wheel</right_joint>
</plugin>
""".format(inertial=INERTIAL, weak="<axis><xyz>0 0 1</xyz><limit><effort>0</effort></limit></axis>")


def _limits(text: str) -> Example:
    return joint(f"<axis><xyz>0 0 1</xyz><limit>{text}</limit></axis>")


CODES: tuple[Code, ...] = (
    Code("SK-JOINT-001", "error", "joints mimic each other in a ring", "one of them leads", model(_RING)),
    Code(
        "SK-JOINT-002",
        "error",
        "an axis has no length, or another than one",
        without="the loaders find an axis of length zero first, and make others unit vectors",
    ),
    Code(
        "SK-JOINT-003",
        "error",
        "an axis, a limit, dynamics or a mimic's numbers are not finite",
        without="the loaders refuse such a number first, with the line it stands in",
    ),
    Code(
        "SK-JOINT-004",
        "warning",
        "a joint joins two links that never move",
        "one of the models should not be static",
        world(_BOTH_STATIC),
    ),
    Code(
        "SK-JOINT-005",
        "warning",
        "a floating joint whose child another joint holds: it is read, not set",
        without="no file that a loader accepts gives a link two parents of which one floats",
    ),
    Code(
        "SK-JOINT-006",
        "warning",
        "a lower limit above the upper one: taken as unlimited",
        without="the loaders find it first, with the line of the limit",
    ),
    Code(
        "SK-JOINT-007",
        "warning",
        "a joint begins outside its limits",
        "limits count from the pose in the file",
        _limits("<lower>0.5</lower><upper>1</upper>"),
    ),
    Code(
        "SK-JOINT-008",
        "warning",
        "a velocity limit of 0",
        "leave the limit out for a joint without one",
        _limits("<velocity>0</velocity>"),
    ),
    Code(
        "SK-JOINT-009",
        "warning",
        "negative damping, friction or spring stiffness is taken as 0",
        "",
        joint("<axis><xyz>0 0 1</xyz><dynamics><damping>-1</damping></dynamics></axis>"),
    ),
    Code(
        "SK-JOINT-010",
        "error",
        "a link moves freely and has no mass, and what it carries does not weigh on it",
        "an `<inertial>`, or a base that is fixed",
        python(f"import simkit\nsimkit.load({_HOLLOW!r}, base='floating')\n"),
    ),
    Code(
        "SK-JOINT-011",
        "warning",
        "a plugin drives a joint whose effort limit is 0",
        "leave `<effort>` out for a joint without a limit",
        model(_DRIVE),
    ),
    Code(
        "SK-JOINT-012",
        "error",
        "a joint that closes a loop, or floats, cannot be set or pushed in that way",
        "set the other joints of the loop; push the link",
        python('import simkit\nsim = simkit.load("m.sdf")\nsim.joint("m::rod").set_position(0.1)\n', {"m.sdf": _LOOP}),
    ),
    Code(
        "SK-JOINT-013",
        "warning",
        "a plugin names a link or model that is not there; it is waited for",
        "",
        world(
            '<plugin filename="gz-sim-apply-link-wrench-system" name="gz::sim::systems::ApplyLinkWrench">\n'
            "  <persistent><entity_name>later</entity_name><entity_type>model</entity_type></persistent>"
            "\n</plugin>"
        ),
    ),
    Code(
        "SK-JOINT-014",
        "note",
        "the stops at a joint's limits are rigid; their stiffness is not used",
        "",
        _limits("<lower>-1</lower><upper>1</upper><stiffness>100</stiffness>"),
    ),
    Code(
        "SK-JOINT-015",
        "error",
        "a chain of more links below each other than can be simulated",
        "",
        python(_CHAIN),
    ),
    Code(
        "SK-JOINT-016",
        "warning",
        "a joint moves nothing that has mass; it gets an armature, so that it can be stepped",
        "an `<inertial>`, or a fixed joint",
        Example(_FLAG, suffix=".urdf"),
    ),
)

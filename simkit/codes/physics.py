"""Codes of the file's physics and of its conversion for the engine."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import BALL, INERTIAL, joint, link, model, python, static, surface, world

_AXIS = "<axis><xyz>0 0 1</xyz></axis>"
_LOOP = f"""
<link name="base">{INERTIAL}</link>
<link name="left"><pose>-1 0 0 0 0 0</pose>{INERTIAL}</link>
<link name="right"><pose>1 0 0 0 0 0</pose>{INERTIAL}</link>
<joint name="a" type="revolute"><parent>base</parent><child>left</child>{_AXIS}</joint>
<joint name="b" type="revolute"><parent>base</parent><child>right</child>{_AXIS}</joint>
<joint name="rod" type="{{kind}}"><parent>left</parent><child>right</child>{_AXIS}</joint>
"""
_KINEMATIC = f"""
<link name="base">{INERTIAL}</link>
<link name="arm"><kinematic>true</kinematic>{INERTIAL}</link>
<joint name="elbow" type="revolute"><parent>base</parent><child>arm</child>{_AXIS}</joint>
"""
_DECAY = "<velocity_decay><linear>0.01</linear><angular>0.01</angular></velocity_decay>"
_GEARBOX = f"""
<link name="base">{INERTIAL}</link>
<link name="wheel">{INERTIAL}</link>
<joint name="axle" type="revolute"><parent>base</parent><child>wheel</child>{_AXIS}</joint>
<joint name="gear" type="gearbox">
  <parent>base</parent><child>wheel</child>{_AXIS}
  <gearbox_ratio>3</gearbox_ratio><gearbox_reference_body>base</gearbox_reference_body>
</joint>
"""
_MIMIC = f"""
<link name="base">{INERTIAL}</link>
<link name="left">{INERTIAL}</link>
<link name="right">{INERTIAL}</link>
<joint name="a" type="revolute"><parent>base</parent><child>left</child>{_AXIS}</joint>
<joint name="b" type="revolute">
  <parent>base</parent><child>right</child>
  <axis><xyz>0 0 1</xyz><mimic joint="a" axis="axis2"><multiplier>1</multiplier></mimic></axis>
</joint>
"""
_DRIVE = f"""
<link name="base">{INERTIAL}</link>
<link name="left">{INERTIAL}</link>
<link name="right">{INERTIAL}</link>
<joint name="left_wheel" type="revolute"><parent>base</parent><child>left</child>{_AXIS}</joint>
<joint name="right_wheel" type="revolute"><parent>base</parent><child>right</child>{_AXIS}</joint>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
  <left_joint>left_wheel</left_joint><right_joint>right_wheel</right_joint>
</plugin>
"""
_NEGATIVE = """<robot name="robot">
  <link name="base">
    <inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0.5" ixz="0" iyz="0"/></inertial>
  </link>
</robot>
"""
_BOX = '<collision name="hull"><geometry><box><size>1 1 1</size></box></geometry></collision>'
_OVERLAP = f"""
<model name="a"><link name="l">{INERTIAL}{_BOX}</link></model>
<model name="b"><pose>0.5 0 0 0 0 0</pose><link name="l">{INERTIAL}{_BOX}</link></model>
"""
_PLANE = (
    '<collision name="ground"><geometry><plane><normal>0 0 1</normal><size>{size}</size></plane></geometry></collision>'
)
_CHECKED = "the loaders refuse such a number first, with the line it stands in"

CODES: tuple[Code, ...] = (
    Code(
        "SK-PHYS-001",
        "stop",
        "the physics diverged; exit code 3; joint and time are named",
        "a smaller step, softer gains, larger inertias",
        python(
            'import simkit\nsim = simkit.load("ball.sdf")\n'
            'sim.model("ball").set_velocity((1e12, 0, 0), (0, 0, 0))\nsim.run(1.0)\n',
            {"ball.sdf": BALL},
        ),
    ),
    Code(
        "SK-PHYS-002",
        "note",
        "a friction coefficient beyond the largest that is told apart",
        "",
        surface("<friction><ode><mu>100000</mu><mu2>100000</mu2></ode></friction>"),
    ),
    Code(
        "SK-PHYS-003",
        "note",
        "a restitution coefficient holds at any speed; its threshold is not used",
        "",
        surface("<bounce><restitution_coefficient>0.8</restitution_coefficient><threshold>0</threshold></bounce>"),
    ),
    Code(
        "SK-PHYS-004",
        "note",
        "what became of a contact stiffness `<kp>`",
        "",
        surface("<contact><ode><kp>1000</kp><kd>1</kd></ode></contact>"),
    ),
    Code(
        "SK-PHYS-005",
        "warning",
        "friction differs along and across; the smaller is used both ways",
        "",
        surface("<friction><ode><mu>1</mu><mu2>0.5</mu2></ode></friction>"),
    ),
    Code(
        "SK-PHYS-006",
        "warning",
        "`slip1`, `slip2` differ without `<fdir1>`",
        "",
        surface("<friction><ode><mu>1</mu><mu2>1</mu2><slip1>0.1</slip1></ode></friction>"),
    ),
    Code(
        "SK-PHYS-007",
        "note",
        "torsional friction of a patch that grows with the depth is not used",
        "`<patch_radius>` instead of `<surface_radius>`",
        surface(
            "<friction><torsional><coefficient>0.5</coefficient><use_patch_radius>false</use_patch_radius>"
            "<surface_radius>0.1</surface_radius></torsional></friction>"
        ),
    ),
    Code(
        "SK-PHYS-009",
        "note",
        "a screw or a gearbox is a stiff constraint",
        "",
        joint(f"{_AXIS}\n<thread_pitch>100</thread_pitch>", "screw"),
    ),
    Code(
        "SK-PHYS-010",
        "note",
        "a joint that a plugin drives gets some armature, so that its servo does not ring",
        "",
        model(_DRIVE),
    ),
    Code(
        "SK-PHYS-011",
        "note, warning",
        "a mass or inertia that no body has, mended; the values used are given",
        "`simkit check --fix-inertia`",
        model(
            '<link name="base">\n  <inertial><mass>1</mass>'
            "<inertia><ixx>0</ixx><iyy>0</iyy><izz>0.1</izz></inertia></inertial>\n</link>"
        ),
    ),
    Code(
        "SK-INERTIA-001",
        "note, warning",
        "the principal moments of inertia of a moving link break A + B >= C, so no solid has them; they are simulated "
        "as written (a note up to 1 % of C)",
        "`simkit check --fix-inertia`",
        model(
            '<link name="base">\n  <inertial><mass>1</mass>'
            "<inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.5</izz></inertia></inertial>\n</link>"
        ),
    ),
    Code(
        "SK-INERTIA-002",
        "error",
        "a moment of inertia of a moving link is negative by more than 1 % of the largest; the moments are given",
        "check signs and units; `simkit check --fix-inertia`",
        Example(_NEGATIVE, suffix=".urdf"),
    ),
    Code(
        "SK-PHYS-012",
        "warning",
        "a kinematic link hangs on a joint: it is not pulled by gravity, but it can be pushed",
        "",
        model(_KINEMATIC),
    ),
    Code(
        "SK-PHYS-013",
        "warning",
        "a joint of an unknown type is taken as fixed",
        without="the loaders refuse an unknown type first, with its line",
    ),
    Code(
        "SK-PHYS-014",
        "warning",
        "`collide_without_contact`: left out of all contacts",
        "",
        surface("<contact><collide_without_contact>true</collide_without_contact></contact>"),
    ),
    Code("SK-PHYS-015", "error", "the step is not a positive number of seconds", without=_CHECKED),
    Code(
        "SK-PHYS-016",
        "warning",
        "a plane on a moving link collides as a plate",
        "make the model static",
        link(_PLANE.format(size="1 1")),
    ),
    Code("SK-PHYS-017", "warning", "a shape without size is left out", "", static(_PLANE.format(size="0 0"))),
    Code("SK-PHYS-018", "error", "mass, centre of mass or inertia of a link is not finite", without=_CHECKED),
    Code(
        "SK-PHYS-019",
        "error",
        "a joint has too few axes for its type",
        without="the loaders give a joint the axes that its type needs, with SK-SDF-026",
    ),
    Code(
        "SK-PHYS-020",
        "note",
        "a joint that closes a loop is held by a constraint; it can be read and driven, not set",
        "",
        model(_LOOP.format(kind="revolute")),
    ),
    Code("SK-PHYS-021", "warning", "a gearbox that cannot be built is left out", "", model(_GEARBOX)),
    Code(
        "SK-PHYS-022",
        "warning",
        "a joint mimics one that is not there, or has no such axis",
        "",
        model(_MIMIC),
    ),
    Code(
        "SK-PHYS-023",
        "error",
        "the engine refuses the compiled model; its own words are given",
        without="what the engine is known to refuse is found before, with a code of its own",
    ),
    Code(
        "SK-PHYS-024",
        "warning",
        "two bodies lie deep in each other at the start; they move apart slowly, at 0.1 m/s at most",
        "move one of them",
        world(_OVERLAP),
    ),
    Code(
        "SK-PHYS-025",
        "warning",
        "the engine warns while it builds the model; its own words are given",
        without="what the engine is known to warn of is found before, with a code of its own",
    ),
    Code(
        "SK-PHYS-026",
        "note",
        "`velocity_decay` of a free link is a damping in proportion to its mass and inertia",
        "",
        link(_DECAY),
    ),
    Code(
        "SK-PHYS-027",
        "warning",
        "`velocity_decay` of a link that hangs on a joint is not used",
        "damping of the joint",
        model(
            _KINEMATIC.replace("<kinematic>true</kinematic>", "<velocity_decay><linear>0.01</linear></velocity_decay>")
        ),
    ),
)

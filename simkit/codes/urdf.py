"""Robots in URDF and xacro, and the packages they name."""

from __future__ import annotations

from simkit.codes import Code, Example

_MASS = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
_LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def _robot(content: str, name: str = 'name="robot"') -> Example:
    return Example(f"<robot {name}>\n{content}\n</robot>\n", suffix=".urdf")


def _two(joint: str, extra: str = "", kind: str = "revolute", below: str = _MASS) -> Example:
    """Two links and one joint."""
    return _robot(
        f'  <link name="base">{_MASS}</link>\n  <link name="arm">{below}</link>\n'
        f'  <joint name="j" type="{kind}"><parent link="base"/><child link="arm"/>{joint}</joint>\n{extra}'
    )


def _link(content: str) -> Example:
    return _robot(f'  <link name="base">{_MASS}{content}</link>')


def _xacro(content: str, files: dict[str, str | bytes] | None = None) -> Example:
    text = f'<robot name="robot" xmlns:xacro="http://www.ros.org/wiki/xacro">\n{content}\n</robot>\n'
    return Example(text, suffix=".xacro", files=files or {})


_BASE = f'  <link name="base">{_MASS}</link>'

CODES: tuple[Code, ...] = (
    Code(
        "SK-URDF-001",
        "error",
        "an element or attribute that URDF requires is missing",
        "write it",
        _robot("  <link/>"),
    ),
    Code(
        "SK-URDF-002",
        "error",
        "two links or two joints have one name, or a name holds `::`",
        "give one of them another name",
        _robot(f"{_BASE}\n{_BASE}"),
    ),
    Code(
        "SK-URDF-003",
        "error",
        "a joint names a link that does not exist",
        "the closest name is shown",
        _robot(f'{_BASE}\n  <joint name="j" type="fixed"><parent link="base"/><child link="amr"/></joint>'),
    ),
    Code("SK-URDF-004", "error", "the type of a joint is none of URDF's", "", _two(_LIMIT, kind="hinge")),
    Code(
        "SK-URDF-005",
        "error",
        "a link is the child of two joints",
        "close a loop with a joint in SDF's words inside `<gazebo>`",
        _two(_LIMIT, '  <joint name="k" type="fixed"><parent link="base"/><child link="arm"/></joint>'),
    ),
    Code(
        "SK-URDF-006",
        "error",
        "more than one link is the child of no joint",
        "join them",
        _robot(f'{_BASE}\n  <link name="lost">{_MASS}</link>'),
    ),
    Code(
        "SK-URDF-007",
        "error",
        "joints go round in a circle, or join a link with itself",
        "",
        _two(_LIMIT, '  <joint name="k" type="fixed"><parent link="arm"/><child link="base"/></joint>'),
    ),
    Code("SK-URDF-008", "error", "the robot has no link", "", _robot("  <links/>")),
    Code(
        "SK-URDF-009",
        "error",
        "a collision or visual has no shape that can be used, or one of negative size",
        "",
        _link('<collision><geometry><sphere radius="-1"/></geometry></collision>'),
    ),
    Code(
        "SK-URDF-010",
        "warning",
        "an element is not known, or has no meaning where it stands",
        "the closest name is shown",
        _link('<colision><geometry><sphere radius="1"/></geometry></colision>'),
    ),
    Code(
        "SK-URDF-011",
        "note",
        "words of Bullet, Drake, PR2 and other tools, which Gazebo ignores as well",
        "",
        _link('<contact><lateral_friction value="1"/></contact>'),
    ),
    Code(
        "SK-URDF-012",
        "warning",
        "an attribute is not known",
        "the closest name is shown",
        _two('<limit lower="-1" uper="1" effort="1" velocity="1"/>'),
    ),
    Code(
        "SK-URDF-013",
        "error",
        "a value is not what is allowed there",
        "a file with `${...}` in it is xacro: load the `.xacro` file",
        _robot(
            '  <link name="base"><inertial><mass value="${m}"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>'
        ),
    ),
    Code("SK-URDF-014", "error", "an axis has no length", "", _two(f'<axis xyz="0 0 0"/>{_LIMIT}')),
    Code(
        "SK-URDF-015",
        "error, warning",
        "a joint mimics one that does not exist or cannot be followed",
        "the closest name is shown",
        _two(f'<mimic joint="i"/>{_LIMIT}'),
    ),
    Code(
        "SK-URDF-016",
        "error",
        "a mass is negative",
        "",
        _robot('  <link name="base"><inertial><mass value="-1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>'),
    ),
    Code(
        "SK-URDF-017",
        "note",
        "what `base=auto` has decided",
        "`base=fixed` or `base=floating` decides otherwise",
        _robot(_BASE),
    ),
    Code(
        "SK-URDF-018",
        "warning",
        "`base=floating` for a robot whose root link is `world`",
        "take the link out of the file",
        Example(
            "import simkit\n"
            'text = \'<robot name="r"><link name="world"/></robot>\'\n'
            "for found in simkit.describe(text, base='floating')['diagnostics']:\n"
            "    print(found['code'], found['severity'])\n",
            kind="python",
        ),
    ),
    Code(
        "SK-URDF-019",
        "warning",
        "a limit that no joint could keep: lower above upper, or a velocity of 0",
        "",
        _two('<limit lower="1" upper="-1" effort="1" velocity="1"/>'),
    ),
    Code("SK-URDF-020", "warning", "a limit that URDF requires is missing", "", _two("")),
    Code(
        "SK-URDF-021",
        "warning",
        "a `<gazebo reference=...>` names no link and no joint",
        "the closest name is shown",
        _robot(f'{_BASE}\n  <gazebo reference="bas"><mu1>1</mu1></gazebo>'),
    ),
    Code(
        "SK-URDF-022",
        "note",
        "settings of Gazebo's solvers, which have no effect here",
        "",
        _two(_LIMIT, '  <gazebo reference="j"><implicitSpringDamper>1</implicitSpringDamper></gazebo>'),
    ),
    Code(
        "SK-URDF-023",
        "error",
        "a force_torque sensor on a joint that carries nothing with mass or collisions",
        "give the link an `<inertial>`, or put the sensor elsewhere",
        _two(
            "",
            '  <gazebo reference="j"><sensor name="ft" type="force_torque"/></gazebo>',
            "fixed",
            "",
        ),
    ),
    Code(
        "SK-URDF-024",
        "note",
        "links without `<inertial>` are frames without mass",
        "",
        _two("", "", "fixed", ""),
    ),
    Code(
        "SK-URDF-025",
        "warning",
        "a transmission or `<ros2_control>` block names no joint of the robot, or has no type",
        "the closest name is shown",
        _robot(f'{_BASE}\n  <transmission name="t"><type>SimpleTransmission</type><joint name="j"/></transmission>'),
    ),
    Code(
        "SK-URDF-026",
        "warning",
        "a material is not defined, or defined twice",
        "the closest name is shown",
        _link('<visual><geometry><sphere radius="1"/></geometry><material name="bleu"/></visual>'),
    ),
    Code("SK-URDF-027", "warning", "the robot has no name; it gets that of its file", "", _robot(_BASE, "")),
    Code(
        "SK-URDF-028",
        "warning",
        "a size is 0; 0.1 mm is used",
        "",
        _link('<collision><geometry><box size="1 1 0"/></geometry></collision>'),
    ),
    Code(
        "SK-XACRO-001",
        "error",
        "an expression, macro or argument cannot be expanded",
        "the line and the macros that led there are shown",
        _xacro('  <link name="${lenght}"/>\n  <xacro:property name="length" value="1"/>'),
    ),
    Code(
        "SK-XACRO-002",
        "error",
        "an included file or YAML file is not there, or lies outside the folders that may be read",
        "`--package-path NAME=DIR` or `--resource-path DIR`",
        _xacro('  <xacro:include filename="$(find arm_description)/arm.xacro"/>'),
    ),
    Code(
        "SK-XACRO-003",
        "error",
        "an expansion costs more than any robot's does: too many elements or steps, or a macro that calls itself",
        "",
        _xacro('  <xacro:macro name="m"><xacro:m/></xacro:macro>\n  <xacro:m/>'),
    ),
    Code(
        "SK-XACRO-004",
        "warning",
        "an argument was given that the file does not have",
        "the closest name is shown",
        Example(
            "import simkit\n"
            'text = \'<robot name="r" xmlns:xacro="x"><xacro:arg name="arm" default="1"/><link name="l"/></robot>\'\n'
            "for found in simkit.describe(text, xacro_args={'amr': '0'})['diagnostics']:\n"
            "    print(found['code'], found['severity'])\n",
            kind="python",
        ),
    ),
    Code(
        "SK-XACRO-005",
        "warning",
        "what the file itself, or xacro about it, has to say",
        "",
        _xacro(f"  ${{xacro.warning('an old arm')}}\n{_BASE}"),
    ),
    Code(
        "SK-XACRO-006",
        "error",
        "the file is xacro, and the package `xacro` is not installed",
        "`pip install xacro`",
        without="it is installed with simkit",
    ),
    Code(
        "SK-XACRO-007",
        "note",
        "`$(find ...)` names a package that is not here; `package://` stands for it, for those who need no file of it",
        "`--package-path NAME=DIR`",
        _xacro(f'{_BASE}\n  <gazebo><plugin name="p" filename="x"><a>$(find nope)/a.yaml</a></plugin></gazebo>'),
    ),
    Code(
        "SK-URI-009",
        "error, warning",
        "a ROS package is not found; every place looked in is shown, once for all its files",
        "`--package-path NAME=DIR` (Python: `package_paths`)",
        _link('<collision><geometry><mesh filename="package://nope/a.stl"/></geometry></collision>'),
    ),
    Code(
        "SK-URI-010",
        "note",
        "a file of another machine, or of a package under another name, was found here",
        "",
        Example(
            "simkit check arm-main/urdf/arm.urdf",
            kind="command",
            files={
                "arm-main/urdf/arm.urdf": f'<robot name="r"><link name="base">{_MASS}<visual><geometry>'
                '<mesh filename="package://arm_description/meshes/a.obj"/></geometry></visual></link></robot>',
                "arm-main/meshes/a.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n",
            },
        ),
    ),
    Code(
        "SK-PARAM-005",
        "warning",
        "a whole number is needed; its whole part is used, as Gazebo uses it",
        "",
        _robot(
            f'{_BASE}\n  <gazebo reference="base"><sensor name="s" type="ray"><ray><scan><horizontal>'
            "<samples>10.5</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan>"
            "<range><min>0.1</min><max>5</max></range></ray></sensor></gazebo>"
        ),
    ),
    Code(
        "SK-URDF-029",
        "error",
        "an include merges a robot in URDF, or changes it with `experimental:params`: it stays a model of its own",
        "`simkit convert ROBOT.urdf -o model.sdf` once, and include that; or include it without `merge` and changes",
        Example(
            '<sdf version="1.9"><model name="m"><include merge="true"><uri>robot.urdf</uri></include></model></sdf>\n',
            files={"robot.urdf": f'<robot name="r">{_BASE}</robot>\n'},
        ),
    ),
    Code(
        "SK-URDF-030",
        "warning",
        "a link has two sensors of one name, as after a xacro macro that is called twice; the first is used",
        "",
        _robot(
            f'{_BASE}\n  <gazebo reference="base">\n    <sensor name="s" type="imu"/>\n'
            '    <sensor name="s" type="imu"/>\n  </gazebo>'
        ),
    ),
    Code(
        "SK-URDF-031",
        "warning",
        "a part that other readers of URDF pass over with a message; it says what stands for it here",
        "",
        _link('<collision><geometry><plane normal="0 0 1"/></geometry></collision>'),
    ),
    Code(
        "SK-URDF-032",
        "warning",
        "no link of the robot has mass, or none that a planar or floating joint does not carry, so its base is fixed",
        "an `<inertial>`; `base='floating'` is an error for such a robot",
        _robot('<link name="base"/>'),
    ),
)

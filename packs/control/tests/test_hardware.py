"""Hardware of a robot: interfaces, limits, loops, mimics and initial positions, compared with physics."""

from __future__ import annotations

from pathlib import Path

import pytest
from control_robots import ALL, POSITIONS, arm, command, interfaces, opened, position, reported_messages, states

import simkit

GROUP = """
controller_manager:
  ros__parameters:
    update_rate: 100
    group: {{type: {kind}}}
group:
  ros__parameters: {{joints: [{joints}]}}
"""
VELOCITIES = GROUP.format(kind="velocity_controllers/JointGroupVelocityController", joints="j1, j2")
EFFORTS = GROUP.format(kind="effort_controllers/JointGroupEffortController", joints="j1, j2")
FIRST = GROUP.format(kind="position_controllers/JointGroupPositionController", joints="j1")
CART = """<robot name="cart"><link name="world"/>
<link name="cart"><inertial><mass value="{mass}"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="world"/><child link="cart"/><axis xyz="{axis}"/>
<limit lower="-50" upper="50" effort="{effort}" velocity="30"/><dynamics damping="{damping}"/></joint>
<ros2_control name="c" type="system"><hardware><plugin>gazebo_ros2_control/GazeboSystem</plugin></hardware>
<joint name="slide">{inside}</joint></ros2_control>
<gazebo><plugin filename="libgazebo_ros2_control.so" name="control"><parameters>arm.yaml</parameters></plugin></gazebo>
</robot>"""


def cart(inside: str, *, mass: float = 2.0, axis: str = "1 0 0", effort: float = 1000.0, damping: float = 0) -> str:
    return CART.format(inside=inside, mass=mass, axis=axis, effort=effort, damping=damping)


def slide(kind: str) -> str:
    return GROUP.format(kind=kind, joints="slide")


def hardware(*commands: str, first: str = "") -> str:
    return "".join(f'<joint name="{j}">{interfaces(commands)}{first}</joint>' for j in ("j1", "j2"))


def test_an_effort_accelerates_by_newtons_law(tmp_path: Path) -> None:
    robot = cart(interfaces(("effort",)))
    with opened(tmp_path, robot, slide("effort_controllers/JointGroupEffortController")) as sim:
        command(sim, "group", 10.0)
        sim.run(0.011)  # the command is taken at 10 ms
        sim.run(1.0)
        # 10 N on 2 kg: 5 m/s²
        assert float(sim.joint("cart::slide").velocity) == pytest.approx(5.0, abs=0.03)
        assert float(sim.joint("cart::slide").effort) == pytest.approx(10.0)


def test_an_effort_stays_within_the_joints_limit(tmp_path: Path) -> None:
    robot = cart(interfaces(("effort",)), effort=4.0)
    with opened(tmp_path, robot, slide("effort_controllers/JointGroupEffortController")) as sim:
        command(sim, "group", 100.0)
        sim.run(1.01)
        assert float(sim.joint("cart::slide").velocity) == pytest.approx(2.0, abs=0.03)


def test_a_velocity_is_reached_and_held_against_gravity(tmp_path: Path) -> None:
    robot = cart(interfaces(("velocity",)), axis="0 0 1")
    with opened(tmp_path, robot, slide("velocity_controllers/JointGroupVelocityController")) as sim:
        sim.run(1.0)
        assert position(sim, "slide") == pytest.approx([0.0], abs=1e-3)  # held though nothing was commanded
        command(sim, "group", 0.5)
        sim.run(2.0)
        assert float(sim.joint("cart::slide").velocity) == pytest.approx(0.5, abs=1e-3)
        command(sim, "group", -0.5)
        sim.run(2.0)
        assert float(sim.joint("cart::slide").velocity) == pytest.approx(-0.5, abs=1e-3)


def test_the_effort_state_is_the_holding_effort(tmp_path: Path) -> None:
    yaml = slide("position_controllers/JointGroupPositionController").replace(
        "    group:", "    jsb: {type: joint_state_broadcaster/JointStateBroadcaster}\n    group:", 1
    )
    with opened(tmp_path, cart(interfaces(("position",)), axis="0 0 1"), yaml) as sim:
        messages = sim.subscribe("/joint_states")
        sim.run(1.0)
        assert messages.messages[-1].effort == pytest.approx([2.0 * 9.81], rel=2e-3)


def test_gains_in_the_hardware_replace_the_servo(tmp_path: Path) -> None:
    gains = '<param name="pos_kp">100</param><param name="pos_kd">20</param><command_interface name="position_pid"/>'
    robot = cart(gains + interfaces(()), axis="0 0 1", mass=1.0)
    with opened(tmp_path, robot, slide("position_controllers/JointGroupPositionController")) as sim:
        command(sim, "group", 1.0)
        sim.run(5.0)
        # a spring of 100 N/m under 1 kg
        assert position(sim, "slide") == pytest.approx([1.0 - 9.8 / 100], abs=2e-3)


def test_an_integral_part_removes_the_error_of_gravity(tmp_path: Path) -> None:
    gains = (
        '<param name="pos_kp">100</param><param name="pos_ki">50</param><param name="pos_kd">20</param>'
        '<param name="pos_max_integral_error">10000</param><command_interface name="position_pid"/>'
    )
    robot = cart(gains + interfaces(()), axis="0 0 1", mass=1.0)
    with opened(tmp_path, robot, slide("position_controllers/JointGroupPositionController")) as sim:
        command(sim, "group", 1.0)
        sim.run(20.0)
        assert position(sim, "slide") == pytest.approx([1.0], abs=1e-3)


@pytest.mark.parametrize("words", ["kp: 100, kd: 20", "p: 100, d: 20"])
def test_gains_in_the_parameter_file_replace_the_servo(tmp_path: Path, words: str) -> None:
    yaml = slide("position_controllers/JointGroupPositionController")
    yaml += f"control:\n  ros__parameters:\n    pid_gains:\n      position:\n        slide: {{{words}}}\n"
    robot = cart(interfaces(("position",)), axis="0 0 1", mass=1.0)
    with opened(tmp_path, robot, yaml) as sim:
        command(sim, "group", 1.0)
        sim.run(5.0)
        assert position(sim, "slide") == pytest.approx([1.0 - 9.8 / 100], abs=2e-3)


def test_a_position_beyond_the_limit_stops_at_the_limit(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        command(sim, "arm_controller", 5.0, 0.0)
        sim.run(4.0)
        assert position(sim, "j1") == pytest.approx([2.0], abs=5e-3)


def test_the_initial_positions_come_from_the_description(tmp_path: Path) -> None:
    inside = interfaces(("position",), ()) + (
        '<state_interface name="position"><param name="initial_value">0.7</param></state_interface>'
    )
    with opened(tmp_path, arm(f'<joint name="j1">{inside}</joint>'), FIRST) as sim:
        assert position(sim, "j1") == pytest.approx([0.7])
        sim.run(1.0)
        assert position(sim, "j1") == pytest.approx([0.7], abs=1e-3)
        sim.reset()
        assert position(sim, "j1") == pytest.approx([0.7])


@pytest.mark.parametrize("start", ["", "1.5707963"])
def test_overlaps_and_limits_are_judged_at_the_initial_positions(tmp_path: Path, start: str) -> None:
    """At its nearest limit, 0.2 rad, the arm reaches into the ground; its initial position points upwards."""
    urdf = f"""<robot name="arm"><link name="world"/>
<link name="base"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="fix" type="fixed"><parent link="world"/><child link="base"/><origin xyz="0 0 0.1"/></joint>
<link name="upper"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0.5 0 -0.3"/><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
<joint name="lift" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 -1 0"/>
<limit lower="0.2" upper="2" effort="100" velocity="2"/></joint>
<ros2_control name="c" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
<joint name="lift"><command_interface name="position"/><state_interface name="position">
<param name="initial_value">{start}</param></state_interface></joint></ros2_control>
<gazebo><plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin"/></gazebo>
</robot>"""
    with simkit.load(urdf, model_world="ground") as sim:
        codes = {"SK-PHYS-024", "SK-JOINT-007"} & {d.code for d in sim.diagnostics}
        assert codes == (set() if start else {"SK-PHYS-024", "SK-JOINT-007"})


@pytest.mark.parametrize("where", ["in the URDF", "in the hardware", "in the hardware, with commands"])
def test_a_mimic_follows_its_leader(tmp_path: Path, where: str) -> None:
    second = '<mimic joint="j1" multiplier="-0.5" offset="0.1"/>' if where == "in the URDF" else ""
    words = '<param name="mimic">j1</param><param name="multiplier">-0.5</param><param name="offset">0.1</param>'
    own = interfaces(("position",) if where.endswith("commands") else ())
    blocks = (
        f'<joint name="j1">{interfaces(("position",))}</joint><joint name="j2">{"" if second else words}{own}</joint>'
    )
    with opened(tmp_path, arm(blocks, second=second), FIRST) as sim:
        command(sim, "group", 0.6)
        sim.run(3.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.6, -0.2], abs=1e-3)
        command(sim, "group", -0.4)
        sim.run(3.0)
        assert position(sim, "j1", "j2") == pytest.approx([-0.4, 0.3], abs=1e-3)


def test_effort_joints_fall_if_hold_joints_is_false(tmp_path: Path) -> None:
    ends = []
    for more in ("", "<hold_joints>false</hold_joints>"):
        plugin = f"<parameters>arm.yaml</parameters>{more}"
        yaml = EFFORTS.replace("[j1, j2]", "[j1]")
        start = '<param name="initial_value">0.3</param>'
        blocks = hardware("effort").replace(
            '<state_interface name="position"/>', f'<state_interface name="position">{start}</state_interface>'
        )
        with opened(tmp_path, arm(blocks, plugin=plugin), yaml) as sim:
            sim.run(1.0)
            ends.append(position(sim, "j2")[0])
    assert ends[0] == pytest.approx(0.3, abs=0.02)  # nobody claims j2: it holds, as in Gazebo
    assert abs(ends[1] - 0.3) > 0.3


def test_without_a_description_every_joint_has_every_interface(tmp_path: Path) -> None:
    with opened(tmp_path, arm(""), POSITIONS) as sim:
        assert reported_messages(sim, "SK-CONTROL-005")
        names = [i.name for i in sim.call("/controller_manager/list_hardware_interfaces").command_interfaces]
        assert names == [f"{joint}/{one}" for joint in ("j1", "j2") for one in ALL]
        command(sim, "arm_controller", 0.3, 0.0)
        sim.run(2.0)
        assert position(sim, "j1") == pytest.approx([0.3], abs=1e-3)


def test_a_description_may_be_in_the_plugin_of_an_sdf_file(tmp_path: Path) -> None:
    (tmp_path / "arm.yaml").write_text(FIRST)
    text = f"""<sdf version="1.9"><model name="m">
    <link name="l"><pose>0 0 1 0 0 0</pose><inertial><mass>1</mass></inertial></link>
    <joint name="j1" type="revolute"><parent>world</parent><child>l</child><axis><xyz>0 0 1</xyz></axis></joint>
    <plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
      <parameters>arm.yaml</parameters>
      <ros2_control name="hw" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
        <joint name="j1">{interfaces(("position",))}</joint></ros2_control>
    </plugin></model></sdf>"""
    path = tmp_path / "arm.sdf"
    path.write_text(text)
    with simkit.load(path) as sim:
        command(sim, "group", 1.0)
        sim.run(3.0)
        assert states(sim) == {"group": "active"}
        assert position(sim, "j1") == pytest.approx([1.0], abs=1e-3)
        assert not reported_messages(sim, "SK-PARAM-003")


@pytest.mark.parametrize(
    ("block", "code", "words"),
    [
        (f'<joint name="j3">{interfaces(("position",))}</joint>', "SK-CONTROL-008", "'j3'"),
        ('<joint name="j1"><command_interface name="velocty"/></joint>', "SK-CONTROL-009", "'velocty'"),
        ('<gpio name="lamp"/>', "SK-CONTROL-007", "'lamp'"),
        ('<sensor name="s"><state_interface name="force.x"/></sensor>', "SK-CONTROL-008", "no force_torque sensor"),
        (
            '<sensor name="s"><state_interface name="smell"/></sensor>',
            "SK-CONTROL-008",
            "no sensor measures its interfaces",
        ),
    ],
)
def test_unknown_names_in_the_hardware_are_reported(tmp_path: Path, block: str, code: str, words: str) -> None:
    with opened(tmp_path, arm(hardware("position") + block)) as sim:
        assert any(words in message for message in reported_messages(sim, code))
        assert states(sim)["arm_controller"] == "active"


def test_the_first_of_two_equal_joints_is_used(tmp_path: Path) -> None:
    with opened(tmp_path, arm(hardware("position") + f'<joint name="j1">{interfaces(("effort",))}</joint>')) as sim:
        assert "names joint 'j1' again" in reported_messages(sim, "SK-CONTROL-004")[0]
        assert states(sim)["arm_controller"] == "active"


@pytest.mark.parametrize(("plugin", "is_free"), [("gazebo_ros2_control", True), ("gz_ros2_control-system", False)])
def test_gazebo_classic_sets_the_position_of_a_joint_whose_effort_limit_is_0(
    tmp_path: Path, plugin: str, is_free: bool
) -> None:
    """Gazebo Classic sets positions and needs no effort; the servo of gz stays within the limit."""
    robot = cart(interfaces(("position",)), effort=0.0).replace("libgazebo_ros2_control", f"lib{plugin}")
    with opened(tmp_path, robot, slide("position_controllers/JointGroupPositionController")) as sim:
        command(sim, "group", 0.5)
        sim.run(2.0)
        assert float(sim.joint("cart::slide").position) == pytest.approx(0.5 if is_free else 0.0, abs=2e-3)
        (message,) = reported_messages(sim, "SK-JOINT-011")
        assert ("is unlimited" in message) == is_free

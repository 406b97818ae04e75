"""Controllers that follow trajectories, close grippers and point heads."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import INERTIAL, model, python

_ELBOW = (
    f'<link name="base">{INERTIAL}</link>\n<link name="arm"><pose>0 0 0.5 0 0 0</pose>{INERTIAL}</link>\n'
    '<joint name="fixed" type="fixed"><parent>world</parent><child>base</child></joint>\n'
    '<joint name="elbow" type="revolute"><parent>base</parent><child>arm</child>'
    "<axis><xyz>0 1 0</xyz><limit><lower>-2</lower><upper>2</upper><effort>50</effort><velocity>2</velocity></limit>"
    "</axis></joint>\n"
)
_PLUGIN = (
    '<plugin filename="libgz_ros2_control-system.so" name="gz_ros2_control::GazeboSimROS2ControlPlugin">\n'
    "  <parameters>arm.yaml</parameters>\n</plugin>"
)
_TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"
_ARM = {
    "joints": "[elbow]",
    "command_interfaces": "[position]",
    "state_interfaces": "[position, velocity]",
}


def _yaml(kind: str, values: dict[str, str]) -> str:
    """Parameters of a controller called `arm`."""
    lines = "".join(f"    {key}: {value}\n" for key, value in values.items())
    return (
        "controller_manager:\n  ros__parameters:\n    update_rate: 100\n"
        f"    arm: {{type: {kind}}}\narm:\n  ros__parameters:\n{lines}"
    )


def _robot(kind: str = _TRAJECTORY, **values: str) -> Example:
    given = {**(_ARM if kind == _TRAJECTORY else {}), **values}
    return model(_ELBOW + _PLUGIN, files={"arm.yaml": _yaml(kind, given)})


def _run(text: str) -> Example:
    """A script that has the robot's simulation as `sim`."""
    robot = f'<sdf version="1.9"><model name="robot">{_ELBOW}{_PLUGIN}</model></sdf>'
    head = f"import simkit\n\nwith open('robot.sdf', 'w') as file:\n    file.write('''{robot}''')\n"
    head += 'sim = simkit.load("robot.sdf")\n'
    return python(head + text, files={"arm.yaml": _yaml(_TRAJECTORY, _ARM)})


def _publish(points: str) -> str:
    return f'sim.publish("/arm/joint_trajectory", {{"joint_names": ["elbow"], "points": {points}}})\nsim.run(0.1)\n'


_SECOND = '"time_from_start": {"sec": 1}'

CODES: tuple[Code, ...] = (
    Code(
        "SK-CONTROL-020",
        "warning",
        "a trajectory on a topic, a tolerance of a goal, or another command of a trajectory controller cannot be used",
        "the reason is ros2_control's; a goal is rejected with it instead. Nothing moves because of it",
        _run(_publish(f'[{{"positions": [0.5, 0.1], {_SECOND}}}]')),
    ),
    Code(
        "SK-CONTROL-021",
        "warning",
        "a trajectory or a gripper's goal asks a joint for a position outside its limits",
        "the joint stops at its limit, as in ros2_control, so a goal may end with its tolerance violated",
        _run(_publish(f'[{{"positions": [2.5], {_SECOND}}}]')),
    ),
    Code(
        "SK-CONTROL-022",
        "warning",
        "a trajectory on the topic takes the place of the one of a goal, which goes on",
        "as in ros2_control the goal ends when the new trajectory does; cancel it first",
        _run(
            f'point = {{"positions": [0.5], {_SECOND}}}\n'
            'trajectory = {"joint_names": ["elbow"], "points": [point]}\n'
            'sim.send_goal("/arm/follow_joint_trajectory", {"trajectory": trajectory})\n'
            'sim.run(0.1)\nsim.publish("/arm/joint_trajectory", trajectory)\nsim.run(0.1)\n'
        ),
    ),
    Code(
        "SK-CONTROL-023",
        "warning",
        "`cmd_timeout` is not longer than `constraints.goal_time`, so there is none",
        "make it longer, or leave it out",
        _robot(cmd_timeout="0.2", constraints="{goal_time: 0.5}"),
    ),
    Code(
        "SK-CONTROL-024",
        "error",
        "joints or interfaces of a trajectory controller that cannot be",
        "name each joint once; commands are position, position + velocity (+ acceleration), velocity, effort, or "
        "position + effort; states are position (+ velocity (+ acceleration))",
        _robot(command_interfaces="[velocity, effort]"),
    ),
    Code(
        "SK-CONTROL-025",
        "warning",
        "a trajectory has efforts, and its controller commands none",
        "leave them out, or name `effort` among the `command_interfaces`",
        _run(_publish(f'[{{"positions": [0.5], "effort": [1.0], {_SECOND}}}]')),
    ),
    Code(
        "SK-CONTROL-026",
        "error, warning",
        "a gripper action controller names no joint, or has no gains for the effort that it commands",
        "`joint: gripper_finger_joint`",
        _robot("position_controllers/GripperActionController", goal_tolerance="0.01"),
    ),
    Code(
        "SK-CONTROL-027",
        "error",
        "the neck of a point-head action is not two joints that are there",
        "`joints: [head_1_joint, head_2_joint]`, the one nearer the body first",
        _robot("simkit/PointHeadAction", joints="[elbow]"),
    ),
)

"""The differential drive controller of mobile bases."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import INERTIAL, model, python

_WHEELS = "".join(
    f'<link name="{side}"><pose>0 {y} 0.1 0 0 0</pose>{INERTIAL}</link>\n'
    f'<joint name="{side}_wheel" type="continuous"><parent>base</parent><child>{side}</child>'
    "<axis><xyz>0 1 0</xyz></axis></joint>\n"
    for side, y in (("left", 0.2), ("right", -0.2))
)
_PLUGIN = (
    '<plugin filename="libgz_ros2_control-system.so" name="gz_ros2_control::GazeboSimROS2ControlPlugin">\n'
    "  <parameters>base.yaml</parameters>\n</plugin>"
)
_ROBOT = f'<link name="base">{INERTIAL}</link>\n{_WHEELS}{_PLUGIN}'
_SIZES = {"wheel_separation": 0.4, "wheel_radius": 0.1}


def _yaml(**values: object) -> str:
    """Parameters of a controller called `base`."""
    settings = {"left_wheel_names": "[left_wheel]", "right_wheel_names": "[right_wheel]", **_SIZES, **values}
    lines = "".join(f"    {key}: {value}\n" for key, value in settings.items() if value is not None)
    return (
        "controller_manager:\n  ros__parameters:\n    update_rate: 100\n"
        "    base: {type: diff_drive_controller/DiffDriveController}\n"
        f"base:\n  ros__parameters:\n{lines}"
    )


def _robot(**values: object) -> Example:
    return model(_ROBOT, files={"base.yaml": _yaml(**values)})


_ROS_1_PLUGIN = '<plugin filename="libgazebo_ros_control.so" name="control"><parameters>base.yaml</parameters></plugin>'
_ROS_1 = (
    "robot:\n  base:\n    type: diff_drive_controller/DiffDriveController\n    left_wheel: left_wheel\n"
    "    right_wheel: right_wheel\n    wheel_radius: 0.1\n"
)
_INFINITE = f"""
import simkit

with open("robot.sdf", "w") as file:
    file.write('''<sdf version="1.9"><model name="robot">{_ROBOT}</model></sdf>''')
sim = simkit.load("robot.sdf")
sim.publish("/base/cmd_vel", simkit.msgs.make("geometry_msgs/msg/Twist", linear={{"x": float("inf")}}))
sim.run(0.1)
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-CONTROL-040",
        "error",
        "a differential drive controller has no wheels on a side, or another number than on the other",
        "name as many joints in `left_wheel_names` as in `right_wheel_names` (ROS 1: `left_wheel`, `right_wheel`)",
        _robot(right_wheel_names="[]"),
    ),
    Code(
        "SK-CONTROL-041",
        "error",
        "a differential drive controller names one joint as several wheels",
        "each wheel has a joint of its own",
        _robot(right_wheel_names="[left_wheel]"),
    ),
    Code(
        "SK-CONTROL-042",
        "error",
        "a limit of a mobile base is switched on, or has a lower bound, without its upper bound",
        "give `max_velocity`, `max_acceleration` or `max_jerk`; the lower bound is minus that unless given",
        _robot(linear="{x: {has_velocity_limits: true}}"),
    ),
    Code(
        "SK-CONTROL-043",
        "warning",
        "`wheels_per_side` is another number than that of the wheels that are named: those are driven",
        "leave `wheels_per_side` out",
        _robot(wheels_per_side=2),
    ),
    Code(
        "SK-CONTROL-044",
        "note",
        "a differential drive controller of ROS 1 takes the separation or the radius of its wheels from the model",
        "",
        model(_ROBOT.replace(_PLUGIN, _ROS_1_PLUGIN), files={"base.yaml": _ROS_1}),
    ),
    Code(
        "SK-CONTROL-045",
        "warning",
        "a differential drive controller leaves a command out: it is not finite, or came while it was inactive",
        "",
        python(_INFINITE, files={"base.yaml": _yaml()}),
    ),
)

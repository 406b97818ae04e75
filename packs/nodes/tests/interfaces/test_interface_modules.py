"""Programs import the interfaces of a package as with a real ROS."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest
from interface_tools import imports_of, ros2_module

from simkit.errors import InterfaceError
from simkit.msgs.interface_definitions import interface_text
from simkit_nodes.interfaces import ROS1, ROS2, add_workspace, interface_module


def test_a_class_is_the_same_in_all_its_modules() -> None:
    with imports_of(ROS2):
        import geometry_msgs.msg  # type: ignore[import-not-found]
        from geometry_msgs.msg import Twist
        from geometry_msgs.msg._twist import Twist as TwistOfFile  # type: ignore[import-not-found]
    assert geometry_msgs.msg.Twist is Twist is TwistOfFile is ROS2.message_class("geometry_msgs/msg/Twist")
    assert Twist.__module__ == "geometry_msgs.msg._twist"


def test_the_file_of_a_class_has_another_name_in_ros_1() -> None:
    with imports_of(ROS1):
        from geometry_msgs.msg import TwistStamped
        from geometry_msgs.msg._TwistStamped import TwistStamped as TwistOfFile  # type: ignore[import-not-found]
    assert TwistStamped is TwistOfFile is not ROS2.message_class("geometry_msgs/msg/TwistStamped")


def test_a_module_lists_its_classes() -> None:
    names = dir(ros2_module("sensor_msgs.msg"))
    assert {"LaserScan", "Image"} <= set(names)
    assert {"AddTwoInts", "AddTwoInts_Request"} <= set(dir(ros2_module("example_interfaces.srv")))
    namespace: dict[str, object] = {}
    with imports_of(ROS2):
        exec("from sensor_msgs.msg import *", namespace)
    assert namespace["LaserScan"] is ROS2.message_class("sensor_msgs/msg/LaserScan")


def test_unknown_packages_and_modules_are_not_there() -> None:
    for name in ("no_msgs", "no_msgs.msg", "geometry_msgs.srv", "geometry_msgs.text", "geometry_msgs.msg._no"):
        assert interface_module(name, ROS2) is None
    assert interface_module("nav2_msgs.action", ROS1) is None


def test_an_unknown_class_is_an_import_error_that_names_the_closest() -> None:
    with imports_of(ROS2):
        module = importlib.import_module("sensor_msgs.msg")
        with pytest.raises(ImportError, match=r"'LaserScn' from 'sensor_msgs.msg'; did you mean 'LaserScan'\?"):
            from sensor_msgs.msg import LaserScn  # type: ignore[import-not-found]  # noqa: F401
        assert not hasattr(module, "LaserScn")


@pytest.mark.parametrize(
    "name",
    [
        "ackermann_msgs/msg/AckermannDriveStamped",
        "turtlebot3_msgs/msg/SensorState",
        "rmf_task_msgs/srv/SubmitTask_Request",
        "action_tutorials_interfaces/action/Fibonacci_Goal",
        "move_base_msgs/action/MoveBase_Goal",
        "irobot_create_msgs/action/Undock_Goal",
        "turtlebot4_msgs/msg/UserLed",
        "ur_msgs/srv/SetIO_Request",
        "moveit_msgs/msg/DisplayTrajectory",
    ],
)
def test_the_pack_brings_interfaces_of_public_programs(name: str) -> None:
    assert ROS2.message_class(name)() is not None


# ---------------------------------------------------------------------- definitions of a program's own packages


def write_package(folder: Path, name: str, **files: str) -> Path:
    folder = folder / name
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package><name>{name}</name></package>")
    for file, text in files.items():
        short, kind = file.rsplit("_", 1)
        path = folder / kind / f"{short}.{kind}"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    return folder


def test_a_program_imports_the_interfaces_of_its_workspace(tmp_path: Path) -> None:
    write_package(tmp_path, "own_parts_msgs", Part_msg="string name\nfloat64 size 2.5\n")
    write_package(tmp_path, "own_order_msgs", Order_msg="own_parts_msgs/Part[] parts\n", Send_srv="Order order\n---\n")
    names = ["own_order_msgs/msg/Order", "own_order_msgs/srv/Send", "own_parts_msgs/msg/Part"]
    assert add_workspace(tmp_path) == names
    with imports_of(ROS2):
        from own_order_msgs.msg import Order  # type: ignore[import-not-found]
        from own_order_msgs.srv import Send  # type: ignore[import-not-found]
        from own_parts_msgs.msg import Part  # type: ignore[import-not-found]
    order = Order(parts=[Part(name="wheel")])
    assert order.parts[0].size == 2.5
    sent = ROS2.to_simkit("own_order_msgs/srv/Send_Request")(Send.Request(order=order))
    assert sent.order.parts[0].name == "wheel"


def test_an_error_in_a_definition_that_is_not_used_stops_no_program(tmp_path: Path) -> None:
    write_package(tmp_path, "own_mixed_msgs", Good_msg="int32 number\n", Bad_msg="int number\n")
    add_workspace(tmp_path)
    module = ros2_module("own_mixed_msgs.msg")
    assert module.Good(number=1).number == 1
    with pytest.raises(InterfaceError, match=r"Bad.msg:1.*unknown type 'int'"):
        module.Bad()


def test_a_copy_of_a_package_that_simkit_ships_is_not_read(tmp_path: Path) -> None:
    write_package(tmp_path, "geometry_msgs", Point_msg="float32 other\n")
    assert add_workspace(tmp_path) == []


def test_a_definition_of_ros_1_keeps_its_names_in_programs_of_ros_1(tmp_path: Path) -> None:
    text = "Header header\nbyte lowWord=-1\nfloat64 maxSpeed  # [m/s]\nfloat64[] K\ntime when\n"
    write_package(tmp_path, "own_old_msgs", Limits_msg=text, Lift_action="float32 Height\n---\n---\n")
    add_workspace(tmp_path)
    with imports_of(ROS1):
        from own_old_msgs.msg import LiftGoal, Limits  # type: ignore[import-not-found]
    limits = Limits(maxSpeed=1, K=[2])
    assert (limits.header.seq, Limits.lowWord, limits.when.secs) == (0, -1, 0)
    sent = ROS1.to_simkit("own_old_msgs/msg/Limits")(limits)
    assert (sent.max_speed, sent.k.tolist()) == (1.0, [2.0])
    assert ROS1.to_program("own_old_msgs/msg/Limits")(sent).maxSpeed == 1.0
    assert LiftGoal(Height=2).Height == 2
    assert "\tbuiltin_interfaces/Time stamp" in interface_text("own_old_msgs/msg/Limits")


def test_a_type_of_ros_1_keeps_a_name_that_ros_2_does_not_allow(tmp_path: Path) -> None:
    files = {
        "joint_state_msg": "float64 q\n",
        "Arm_State_msg": "joint_state[] joints\n",
        "get_arm_srv": "---\nArm_State arm\n",
    }
    write_package(tmp_path, "own_arm_msgs", **files)
    add_workspace(tmp_path)
    with imports_of(ROS1):
        from own_arm_msgs.msg import Arm_State, joint_state  # type: ignore[import-not-found]
        from own_arm_msgs.srv import get_arm, get_armResponse  # type: ignore[import-not-found]
    response = get_armResponse(Arm_State([joint_state(q=1)]))
    assert ROS1.to_simkit(response._ros_type)(response).arm.joints[0].q == 1.0
    assert (Arm_State._type, get_arm._type) == ("own_arm_msgs/Arm_State", "own_arm_msgs/get_arm")
    assert Arm_State._slot_types == ["own_arm_msgs/joint_state[]"]


def test_two_programs_with_the_same_definition_share_a_type_and_other_definitions_are_told(tmp_path: Path) -> None:
    for workspace, text in (
        ("first", "int32 number\n"),
        ("same", "int32 number # comment\n"),
        ("other", "int8 number\n"),
    ):
        write_package(tmp_path / workspace, "own_shared_msgs", Value_msg=text)
    add_workspace(tmp_path / "first")
    first = ros2_module("own_shared_msgs.msg").Value
    add_workspace(tmp_path / "same")
    assert ros2_module("own_shared_msgs.msg").Value is first
    add_workspace(tmp_path / "other")
    with pytest.raises(InterfaceError, match="own_shared_msgs/msg/Value is defined differently already"):
        ros2_module("own_shared_msgs.msg").Value  # noqa: B018
    add_workspace(tmp_path / "first")
    assert ros2_module("own_shared_msgs.msg").Value is first


def test_a_workspace_completes_a_package_of_which_simkit_has_some_types(tmp_path: Path) -> None:
    write_package(tmp_path, "kobuki_msgs", Led_msg="int64 other\n", Special_msg="int32 number\n")
    assert add_workspace(tmp_path) == ["kobuki_msgs/msg/Special"]
    module = ros2_module("kobuki_msgs.msg")
    assert module.Special().number == 0
    assert not hasattr(module.Led(), "other")

"""Messages of any type in programs: `rosidl_runtime_py` and `rclpy_message_converter`."""

from __future__ import annotations

from collections.abc import Callable

import pytest

Run = Callable[..., list[str]]

START = """
    import rclpy
    from geometry_msgs.msg import PoseStamped, Twist
    from nav_msgs.msg import Path
    from std_msgs.msg import UInt8MultiArray
    rclpy.init()
    log = rclpy.create_node("n").get_logger()
"""


def test_classes_are_found_by_their_names(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    from rosidl_runtime_py.utilities import get_action, get_interface, get_message, get_service
    log.info(str(get_message("geometry_msgs/msg/Twist") is get_message("geometry_msgs/Twist") is Twist))
    log.info(get_service("std_srvs/srv/SetBool").Request.__name__)
    log.info(str(get_action("nav2_msgs/action/Spin") is get_interface("nav2_msgs/action/Spin")))
    for name in ("geometry_msgs/msg/Nothing", "nowhere/msg/Nothing"):
        try:
            get_message(name)
        except (AttributeError, ModuleNotFoundError) as error:
            log.info(type(error).__name__)
    """
    )
    assert lines == ["True", "SetBool_Request", "True", "AttributeError", "ModuleNotFoundError"]


def test_messages_become_text_and_dictionaries(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    from rosidl_runtime_py import message_to_csv, message_to_ordereddict, message_to_yaml
    twist = Twist()
    twist.linear.x = 1.5
    log.info(message_to_csv(twist))
    log.info(message_to_yaml(twist.linear).replace("\\n", " "))
    log.info(message_to_yaml(UInt8MultiArray(data=[1, 2]), flow_style=True).splitlines()[-1])
    path = Path(poses=[PoseStamped()])
    path.header.frame_id = "a_long_name"
    log.info(str(list(message_to_ordereddict(path)["poses"][0])))
    log.info(message_to_yaml(path.header, truncate_length=3).splitlines()[-1])
    log.info(str(message_to_ordereddict(path, no_arr=True)["poses"]))
    log.info(str(message_to_ordereddict(UInt8MultiArray(data=[1, 2, 3]), truncate_length=2)["data"]))
    """
    )
    assert lines == [
        "1.5,0.0,0.0,0.0,0.0,0.0",
        "x: 1.5 y: 0.0 z: 0.0 ",
        "data: [1, 2]",
        "['header', 'pose']",
        "frame_id: a_l...",
        "<sequence type: geometry_msgs/msg/PoseStamped, length: 1>",
        "[1, 2, '...']",
    ]


def test_messages_are_set_from_dictionaries(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    from rosidl_runtime_py import set_message_fields
    path = Path()
    set_message_fields(path, {"header": {"frame_id": "map"}, "poses": [{"pose": {"position": {"x": 2}}}]})
    log.info(f"{path.header.frame_id} {path.poses[0].pose.position.x}")
    times = set_message_fields(path, {"header": "auto"}, expand_header_auto=True)
    times[0](rclpy.time.Time(seconds=3).to_msg())
    log.info(str(path.header.stamp.sec))
    for values in ({"nothing": 1}, {"header": 1}):
        try:
            set_message_fields(path, values)
        except (AttributeError, TypeError) as error:
            log.info(str(error))
    """
    )
    assert lines == [
        "map 2.0",
        "3",
        "'Path' object has no attribute 'nothing'",
        "Value '1' is expected to be a dictionary but is a int",
    ]


def test_interfaces_are_listed_by_package(run_program: Run) -> None:
    lines = run_program(
        START
        + """
    from rosidl_runtime_py import get_interface_packages, get_interfaces, get_service_interfaces
    log.info(str(get_service_interfaces(["std_srvs"])))
    log.info(str("msg/Twist" in get_interfaces(["geometry_msgs"])["geometry_msgs"]))
    log.info(str("nav_msgs" in get_interface_packages()))
    try:
        get_interfaces(["nowhere"])
    except LookupError as error:
        log.info(str(error))
    """
    )
    assert lines == [
        "{'std_srvs': ['srv/Empty', 'srv/SetBool', 'srv/Trigger']}",
        "True",
        "True",
        "Unknown package 'nowhere'",
    ]


@pytest.mark.parametrize("values", ["{'linear': {'x': 1, 'y': 0.5}}", "dict(linear=dict(x=1.0, y=0.5, z=None))"])
def test_the_converter_makes_messages_and_dictionaries(run_program: Run, values: str) -> None:
    lines = run_program(
        START
        + f"""
    from rclpy_message_converter.json_message_converter import convert_ros_message_to_json
    from rclpy_message_converter.message_converter import (
        convert_dictionary_to_ros_message, convert_ros_message_to_dictionary)
    twist = convert_dictionary_to_ros_message("geometry_msgs/msg/Twist", {values})
    log.info(str(convert_ros_message_to_dictionary(twist)["linear"]))
    log.info(convert_ros_message_to_json(twist.angular))
    bytes_ = convert_dictionary_to_ros_message(UInt8MultiArray, {{"data": "AQID"}})
    log.info(str(convert_ros_message_to_dictionary(bytes_)["data"]) + str(list(bytes_.data)))
    try:
        convert_dictionary_to_ros_message("geometry_msgs/msg/Twist", {{"speed": 1}})
    except ValueError as error:
        log.info(str(error))
    """
    )
    assert lines == [
        "{'x': 1.0, 'y': 0.5, 'z': 0.0}",
        '{"x": 0.0, "y": 0.0, "z": 0.0}',
        "AQID[1, 2, 3]",
        'ROS message type "geometry_msgs/msg/Twist" has no field named "speed"',
    ]


def test_a_library_writes_to_the_log_as_rclpy_does(run_program: Callable[..., list[str]]) -> None:
    texts = run_program(
        """
        import rclpy
        from rclpy.impl.implementation_singleton import rclpy_implementation as impl
        rclpy.init()
        node = rclpy.create_node("a")
        for severity in (rclpy.logging.LoggingSeverity.DEBUG, rclpy.logging.LoggingSeverity.INFO):
            impl.rclpy_logging_rcutils_log(severity, "a", severity.name, "main", "program.py", 1)
        """
    )
    assert texts == ["INFO"]

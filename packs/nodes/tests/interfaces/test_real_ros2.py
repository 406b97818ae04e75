"""Comparison of the classes for programs with those of a real rclpy."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest
from interface_tools import ROS2_TOOLS, ros2_message_of
from probe import describe_package

PACKAGES = [
    "action_msgs", "actionlib_msgs", "builtin_interfaces", "diagnostic_msgs", "geometry_msgs", "lifecycle_msgs",
    "nav_msgs", "rcl_interfaces", "rosgraph_msgs", "sensor_msgs", "service_msgs", "shape_msgs", "std_msgs", "std_srvs",
    "stereo_msgs", "trajectory_msgs", "type_description_interfaces", "unique_identifier_msgs", "visualization_msgs",
]  # fmt: skip


@pytest.mark.ros
def test_classes_of_messages_and_services_behave_as_those_of_rclpy_with_checks_of_fields(jazzy_python: Path) -> None:
    probe = Path(__file__).with_name("probe.py")
    command = [str(jazzy_python), str(probe), *PACKAGES]
    environment = os.environ | {"ROS_PYTHON_CHECK_FIELDS": "1"}
    output = subprocess.run(command, env=environment, check=True, capture_output=True, text=True, timeout=300).stdout
    for package, classes in json.loads(output).items():
        ours = describe_package(package, *ROS2_TOOLS)
        assert len(classes) > 1
        assert set(classes) == set(ours)
        for name, lines in classes.items():
            if name.endswith("in bytes"):  # rclpy does not set the bytes between fields
                cls = name.removesuffix(" in bytes")
                assert [text for _, text in lines] == [repr(ros2_message_of(cls, data)) for data, _ in lines]
                assert [text for _, text in lines] == [text for _, text in ours[name]]
            else:
                assert lines == ours[name], name

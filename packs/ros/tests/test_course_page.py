"""The last section of the course's page about the ROS 2 graph, in terminals with nodes of a real rclpy."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.cli.course_page import WITH_ROS, WITHOUT_ROS, Desk

from .conftest import DOMAIN

pytestmark = pytest.mark.ros


def test_nodes_of_the_page_talk_with_nodes_of_ros(ros_python: Path, sockets: Path, tmp_path: Path) -> None:
    (tmp_path / "rosenv").symlink_to(ros_python.parents[1])
    ros = {"ROS_DOMAIN_ID": str(DOMAIN), "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp", "RCUTILS_COLORIZED_OUTPUT": "0"}
    with ExitStack() as stack:
        desk = Desk(tmp_path, stack, {"TMPDIR": str(sockets.parent), **ros})
        desk.play(WITHOUT_ROS, only_files=True)
        desk.play(WITH_ROS)
        desk.finish()

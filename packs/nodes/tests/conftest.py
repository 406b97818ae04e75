"""Python with a real rclpy, in an environment that the session makes."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

_WHEELS = ("ros-jazzy-rclpy", "ros-jazzy-rmw-fastrtps-cpp", "ros-jazzy-common-interfaces", "rosbags")


@pytest.fixture(scope="session")
def jazzy_python(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A Python with the rclpy of ROS 2 Jazzy. SIMKIT_TEST_ROS_VENVS keeps the environment for the next session."""
    if os.environ.get("SIMKIT_TEST_ROS") != "1":
        pytest.skip("SIMKIT_TEST_ROS=1 makes an environment with rclpy (266 MB) and runs this test")
    if (sys.platform, platform.machine()) != ("linux", "x86_64"):
        pytest.skip("the wheels of rclpy are for Linux on x86-64 only")
    kept = os.environ.get("SIMKIT_TEST_ROS_VENVS")
    folder = (Path(kept) if kept else tmp_path_factory.mktemp("ros")) / "jazzy"
    python = folder / "bin" / "python"
    if not (folder / "is_complete").exists():
        subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
        subprocess.run([str(python), "-m", "pip", "install", "-q", *_WHEELS], check=True, timeout=600)
        (folder / "is_complete").touch()
    return python

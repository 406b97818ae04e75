"""Options of the bridge, its environment and its errors, which need no ROS."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from simkit.errors import InputError
from simkit.msgs.derived_types import derived_type
from simkit.msgs.type_hashes import rihs
from simkit_ros.bridge_process import RosBridge, RosOptions
from simkit_ros.cli.run_parts.ros import join_ros_arguments
from simkit_ros.ros_names import parameter_node, ros_name
from simkit_ros.ros_python import find_python


def test_a_python_without_rclpy_is_an_error_with_the_reason_and_a_remedy() -> None:
    command = ["run", "turtlebot3_empty", "--duration", "1", "--ros", "--ros-python", sys.executable]
    found = subprocess.run([sys.executable, "-m", "simkit", *command], capture_output=True, text=True)
    assert found.returncode == 2
    assert "SK-ROS-002" in found.stderr and "'rclpy'" in found.stderr
    assert "pip install ros-jazzy-rclpy" in found.stderr


@pytest.mark.skipif(os.name != "posix", reason="the interpreter is a script for a shell")
def test_the_program_needs_neither_simkit_nor_packages_until_it_opens_ros(tmp_path: Path) -> None:
    bare = tmp_path / "python"
    bare.write_text(f'#!/bin/sh\nexec "{sys.executable}" -I -S "$@"\n')
    bare.chmod(0o755)
    with (
        pytest.raises(InputError, match="SK-ROS-002 .*No module named 'rclpy'"),
        RosBridge(RosOptions(python=bare), report=print) as bridge,
    ):
        bridge.start(tmp_path / "socket")


def test_a_long_namespace_that_is_invalid_takes_no_time() -> None:
    program = "from simkit_ros.ros_names import is_namespace; assert not is_namespace('a' * 1_000_000 + '!')"
    subprocess.run([sys.executable, "-c", program], check=True, timeout=60)


def test_a_bridge_that_ends_before_it_reads_its_settings_is_an_error_with_its_exit_code(tmp_path: Path) -> None:
    for _ in range(30):  # the process may end before, while or after the settings are written
        with (
            pytest.raises(InputError, match="SK-ROS-002 .* exit code 1"),
            RosBridge(RosOptions(python=Path("/bin/false")), report=print) as bridge,
        ):
            bridge.start(tmp_path / "socket")


def test_a_sourced_ros_names_its_python(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    packages = tmp_path / "lib" / f"python{sys.version_info.major}.{sys.version_info.minor}" / "site-packages"
    (packages / "rclpy").mkdir(parents=True)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    assert find_python(None) == Path(sys.executable)
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    monkeypatch.delenv("PYTHONPATH", raising=False)
    with pytest.raises(InputError, match="SK-ROS-001"):
        find_python(None)


def test_an_environment_is_named_by_its_folder_and_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "python").symlink_to(sys.executable)
    assert find_python(tmp_path) == tmp_path / "bin" / "python"
    with pytest.raises(InputError, match="SK-ROS-001 --ros-python: found"):
        find_python(tmp_path / "none")


def test_only_with_a_network_ros_reads_the_users_variables(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_STATIC_PEERS", "10.0.0.1")
    monkeypatch.setenv("ROS_DOMAIN_ID", "5")
    found = RosOptions().environment()
    assert "ROS_STATIC_PEERS" not in found and found["ROS_DOMAIN_ID"] == "5"
    assert "<address>127.0.0.1</address>" in Path(found["FASTRTPS_DEFAULT_PROFILES_FILE"]).read_text()
    open_found = RosOptions(domain=7, uses_network=True).environment()
    assert open_found["ROS_STATIC_PEERS"] == "10.0.0.1" and open_found["ROS_DOMAIN_ID"] == "7"
    assert "interfaceWhiteList" not in Path(open_found["FASTRTPS_DEFAULT_PROFILES_FILE"]).read_text()


@pytest.mark.parametrize(
    "options", [RosOptions(domain=233), RosOptions(domain=-1), RosOptions(namespace="a b"), RosOptions(namespace="2d")]
)
def test_a_domain_or_namespace_that_ros_does_not_accept_is_an_error(options: RosOptions) -> None:
    with pytest.raises(InputError, match="SK-ROS-003 --ros-(domain|namespace): found"):
        options.check()


@pytest.mark.parametrize("value", ["240", "-1", "lab"])
def test_a_domain_of_the_environment_that_ros_does_not_accept_is_an_error(
    monkeypatch: pytest.MonkeyPatch, value: str
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", value)
    with pytest.raises(InputError, match=f"SK-ROS-003 ROS_DOMAIN_ID: found {value}; expected a number from 0 to 232"):
        RosOptions().check()
    RosOptions(domain=7).check()


def test_names_become_names_of_ros() -> None:
    assert ros_name("/world/a.b/2d-scan/x") == "/world/a_b/_2d_scan/x"
    assert ros_name("/scan", "/lab") == "/lab/scan"
    assert ros_name("/clock", "/lab") == "/clock"
    assert parameter_node("/arm/list_parameters") == "/arm"
    assert parameter_node("/arm/other") == ""


def test_arguments_of_ros_end_with_two_dashes() -> None:
    words = ["w.sdf", "--ros-args", "-r", "/scan:=/a b", "--", "--rtf", "1"]
    assert join_ros_arguments(words) == ["w.sdf", "--ros-args=-r '/scan:=/a b'", "--rtf", "1"]


def test_services_have_the_published_hashes() -> None:
    # share/std_srvs/srv/SetBool.json of ROS 2 Jazzy
    found = rihs("std_srvs/srv/SetBool")
    assert found == "RIHS01_abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a"


def test_the_parts_of_an_action_are_types() -> None:
    response = derived_type("example_interfaces/action/Fibonacci_GetResult_Response")
    assert [*response.__dataclass_fields__][:2] == ["status", "result"]

"""Golden runs, bundles and certificates of runs with a node, and the example of the page about CI."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from simkit.cli import app

ROOT = Path(__file__).resolve().parents[3]
WORLD = """<sdf version="1.9"><world name="hall"><model name="robot"><link name="base"/>
<plugin name="gz::sim::systems::VelocityControl" filename="gz-sim-velocity-control-system"><topic>/cmd_vel</topic>
</plugin></model></world></sdf>"""
DRIVER = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

import speed


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.drive)

    def drive(self):
        message = Twist()
        message.linear.x = speed.value()
        self.publisher.publish(message)


def main():
    rclpy.init()
    rclpy.spin(Driver())


if __name__ == "__main__":
    main()
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Working directory with a world, and a program that imports a module beside it."""
    (tmp_path / "hall.sdf").write_text(WORLD)
    (tmp_path / "driver.py").write_text(DRIVER)
    (tmp_path / "speed.py").write_text("def value():\n    return 0.5\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def simkit(*words: str) -> Result:
    return CliRunner().invoke(app, words)


def test_a_golden_run_names_the_program_that_was_changed(folder: Path) -> None:
    done = simkit("golden", "record", "hall.sdf", "-o", "golden", "--duration", "1", "--node", "driver.py")
    assert done.exit_code == 0, done.output
    done = simkit("golden", "check", "golden", "--allow-code")
    assert done.exit_code == 0, done.output
    (folder / "speed.py").write_text("def value():\n    return 0.25\n")
    done = simkit("golden", "check", "golden", "--allow-code")
    assert done.exit_code == 5 and "the code of speed.py was changed" in done.output, done.output


def test_a_golden_run_names_the_nodes_if_no_input_was_changed(folder: Path) -> None:
    (folder / "speed.py").write_text(
        "from pathlib import Path\n\n\ndef value():\n    return float(Path('v').read_text())\n"
    )
    (folder / "v").write_text("0.5")
    done = simkit("golden", "record", "hall.sdf", "-o", "golden", "--duration", "1", "--node", "driver.py")
    assert done.exit_code == 0, done.output
    (folder / "v").write_text("0.25")
    done = simkit("golden", "check", "golden", "--allow-code")
    assert done.exit_code == 5, done.output
    assert "the run is not deterministic" in done.output and "code of nodes can be the reason: driver.py" in done.output


def test_a_bundle_repeats_the_run_without_the_program(folder: Path) -> None:
    done = simkit("bundle", "hall.sdf", "-o", "b.zip", "--duration", "1", "--node", "driver.py")
    assert done.exit_code == 0, done.output
    state = re.search(r"state \w+", done.output)
    (folder / "driver.py").unlink()
    (folder / "hall.sdf").unlink()
    again = simkit("replay", "b.zip")
    assert again.exit_code == 0 and "identical" in again.output, again.output
    assert state is not None and state[0] in again.output


@pytest.mark.slow
def test_a_run_with_a_node_has_the_same_bits_in_all_processes(folder: Path) -> None:
    done = simkit("certify", "hall.sdf", "--duration", "1", "--node", "driver.py")
    assert done.exit_code == 0 and "the same bits in 6 runs" in done.output, done.output
    assert "restored" not in done.output


# ---------------------------------------------------------------------- the example of the page about CI


ROBOT = """<robot name="linorobot2_2wd" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:include filename="$(find linorobot2_description)/urdf/base.urdf.xacro"/>
<gazebo><plugin name="drive" filename="libgazebo_ros_planar_move.so"/></gazebo></robot>"""
BASE = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base_footprint"><inertial><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link></robot>"""
BRAKE = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Brake(Node):
    def __init__(self):
        super().__init__("brake")
        self.last = self.get_clock().now()
        self.publisher = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_subscription(Twist, "cmd_vel", self.hear, 1)
        self.create_timer(0.2, self.check)

    def hear(self, message):
        if message.linear.x:
            self.last = self.get_clock().now()

    def check(self):
        if (self.get_clock().now() - self.last).nanoseconds >= 200_000_000:
            self.publisher.publish(Twist())


def main():
    rclpy.init()
    rclpy.spin(Brake())


if __name__ == "__main__":
    main()
"""


@pytest.mark.slow
def test_the_example_of_the_page_about_ci_passes_with_a_package_of_this_layout(tmp_path: Path) -> None:
    """The public package is not here; a package with the same names and a node for the same task takes its place."""
    page = (ROOT / "docs" / "ci.md").read_text(encoding="utf-8")
    commands, listing = re.findall(r"^```(?:sh|python)\n(.*?)^```", page, re.MULTILINE | re.DOTALL)[:2]
    assert len(commands.splitlines()) + len([line for line in listing.splitlines() if line]) <= 20
    package = tmp_path / "linorobot2" / "linorobot2_description"
    gazebo = tmp_path / "linorobot2" / "linorobot2_gazebo"
    for file, text in {
        package / "package.xml": "<package><name>linorobot2_description</name></package>",
        package / "urdf" / "robots" / "2wd.urdf.xacro": ROBOT,
        package / "urdf" / "base.urdf.xacro": BASE,
        gazebo / "package.xml": "<package><name>linorobot2_gazebo</name></package>",
        gazebo / "CMakeLists.txt": "install(PROGRAMS scripts/command_timeout.py DESTINATION lib/${PROJECT_NAME})",
        gazebo / "scripts" / "command_timeout.py": BRAKE,
        tmp_path / "test_linorobot2.py": listing,
    }.items():
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    plugins = ["-p", "simkit.pytest_plugin", "-p", "simkit_nodes.pytest_plugin", "-p", "no:cacheprovider"]
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        *plugins,
        "-c",
        os.devnull,
        "--rootdir",
        str(tmp_path),
        str(tmp_path),
    ]
    environment = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr

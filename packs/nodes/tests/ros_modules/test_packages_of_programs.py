"""Packages in programs: `ament_index_python`, and xacro files with `$(find ...)`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import simkit

ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="length" default="1"/>
  <xacro:include filename="$(find robot)/urdf/part.xacro"/>
  <link name="arm_$(arg length)"/>
</robot>
"""

PROGRAM = """
import os
import rclpy
from ament_index_python import has_resource
from ament_index_python.packages import (
    PackageNotFoundError, get_package_prefix, get_package_share_directory, get_package_share_path,
    get_packages_with_prefixes,
)
from ament_index_python.resources import get_resource
import xacro

rclpy.init()
log = rclpy.create_node("n").get_logger()
share = get_package_share_directory("robot")
with open(os.path.join(share, "config", "a.yaml")) as stream:
    log.info(stream.read().strip())
log.info(str(get_package_share_path("robot") / "urdf" == get_package_share_path("robot").joinpath("urdf")))
log.info(str(get_package_prefix("robot") == share == get_packages_with_prefixes()["robot"]))
for name in ("nowhere", "not valid"):
    try:
        get_package_share_directory(name)
    except (PackageNotFoundError, ValueError) as error:
        log.info(f"{type(error).__name__} {error.args[0]}")
log.info(f"{has_resource('packages', 'robot') == share} {has_resource('packages', 'nowhere')}")
log.info(get_resource("packages", "installed")[0].strip() + " " + os.path.basename(get_package_prefix("installed")))
document = xacro.process_file(os.path.join(share, "urdf", "arm.xacro"), mappings={"length": "2"})
log.info(str([link.getAttribute("name") for link in document.getElementsByTagName("link")]))
"""


def test_a_program_finds_the_files_of_packages(
    sim: simkit.Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = {
        "ws/src/robot/package.xml": "<package><name>robot</name></package>",
        "ws/src/robot/config/a.yaml": "a: 1",
        "ws/src/robot/urdf/arm.xacro": ARM,
        "ws/src/robot/urdf/part.xacro": '<robot xmlns:xacro="x"><link name="part"/></robot>',
        "ws/src/robot/scripts/program.py": PROGRAM,
        "prefix/share/installed/package.xml": "<package><name>installed</name></package>",
        "prefix/share/ament_index/resource_index/packages/installed": "text",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    node = sim.add_node(tmp_path / "ws/src/robot/scripts/program.py")
    sim.run(0.5)
    assert node.error is None, "\n".join(node.log)
    assert [line.split("]: ", 1)[1] for line in node.log] == [
        "a: 1",
        "True",
        "True",
        f"PackageNotFoundError package 'nowhere' not found, searching: ['{tmp_path / 'prefix'}']",
        "ValueError 'not valid' is not a valid package name",
        "True False",
        "text prefix",
        "['part', 'arm_2']",
    ]


def test_models_of_simkit_are_packages(run_program: Callable[..., list[str]]) -> None:
    lines = run_program(
        """
        import os, rclpy
        from ament_index_python.packages import get_package_share_directory
        rclpy.init()
        log = rclpy.create_node("n").get_logger()
        log.info(str(os.path.isfile(os.path.join(get_package_share_directory("baxter"), "model.config"))))
        """
    )
    assert lines == ["True"]

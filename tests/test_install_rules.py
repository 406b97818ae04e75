"""Files that a package installs under other names are found in its source tree."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit
from simkit.loaders.resources.install_rules import installed_sources

CMAKE = """
cmake_minimum_required(VERSION 3.16)
project(bot)
# install(DIRECTORY old/urdf DESTINATION share/${PROJECT_NAME})
install(
  DIRECTORY description/urdf bringup/config launch
  DESTINATION share/${PROJECT_NAME}
)
install(DIRECTORY models/ DESTINATION "share/bot/sdf")
install(DIRECTORY include/ DESTINATION include)
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    (tmp_path / "CMakeLists.txt").write_text(CMAKE)
    (tmp_path / "package.xml").write_text("<package><name>bot</name></package>")
    return tmp_path


@pytest.mark.parametrize(
    ("inside", "sources"),
    [
        ("urdf/bot.urdf", ["description/urdf/bot.urdf"]),
        ("config", ["bringup/config"]),
        ("sdf/arm/model.sdf", ["models/arm/model.sdf"]),
        ("launch/bot.launch.py", []),
        ("urdf_old/bot.urdf", []),
    ],
)
def test_the_source_of_an_installed_path_follows_from_the_rules(package: Path, inside: str, sources: list[str]) -> None:
    assert list(installed_sources(package, inside)) == sources


def test_a_package_without_cmake_has_no_rules(tmp_path: Path) -> None:
    assert list(installed_sources(tmp_path, "urdf/bot.urdf")) == []


def test_a_xacro_file_includes_a_file_by_its_installed_path(package: Path) -> None:
    folder = package / "description" / "urdf"
    folder.mkdir(parents=True)
    (folder / "link.xacro").write_text('<robot><link name="base"/></robot>')
    text = '<robot name="bot" xmlns:xacro="http://ros.org/wiki/xacro">'
    text += '<xacro:include filename="$(find bot)/urdf/link.xacro"/>'
    (folder / "bot.urdf.xacro").write_text(f"{text}</robot>")
    assert simkit.describe(folder / "bot.urdf.xacro")["model"]["name"] == "bot"

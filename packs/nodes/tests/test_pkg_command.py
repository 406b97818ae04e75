"""`simkit pkg`: packages of a workspace without ROS."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

import simkit
from simkit.cli.commands import app


def pkg(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["pkg", *map(str, arguments)], catch_exceptions=False)


@pytest.fixture(autouse=True)
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Workspace with a package, as the present folder."""
    monkeypatch.chdir(tmp_path)
    assert pkg("create", "wall_follower", "--node-name", "follower", "--destination-directory", "src").exit_code == 0
    return tmp_path


def test_a_new_package_has_a_node_that_runs(workspace: Path) -> None:
    with simkit.load("empty") as sim:
        node = sim.add_node("wall_follower/follower")
        sim.run(1.5)
        assert node.error is None
        assert node.log == ["[INFO] [1.000000000] [follower]: hello"]
    assert "<depend>rclpy</depend>" in (workspace / "src/wall_follower/package.xml").read_text()
    assert (workspace / "src/wall_follower/resource/wall_follower").read_text() == ""


def test_packages_and_executables_are_listed(workspace: Path) -> None:
    assert "wall_follower" in pkg("list").stdout.splitlines()
    assert pkg("executables", "wall_follower").stdout == "wall_follower follower\n"
    file = workspace / "src/wall_follower/wall_follower/follower.py"
    assert pkg("executables", "wall_follower", "--full-path").stdout == f"{file}\n"
    assert json.loads(pkg("executables", "wall_follower", "--json").stdout) == [
        {"package": "wall_follower", "name": "follower", "file": str(file)}
    ]


def test_executables_of_packages_of_ros_are_programs_of_simkit(workspace: Path) -> None:
    names = ("draw_square", "mimic", "turtle_teleop_key", "turtlesim_node")
    assert pkg("executables", "turtlesim").stdout == "".join(f"turtlesim {name}\n" for name in names)
    assert "SK-NODE-060" in pkg("executables", "no_such_package").output


def test_a_package_is_found_with_what_it_depends_on(workspace: Path) -> None:
    folder = workspace / "src/wall_follower"
    assert pkg("find", "wall_follower").stdout == f"{folder}\n"
    file = folder / "package.xml"
    file.write_text(
        file.read_text().replace("</package>", "<!-- <depend>a</depend> --><run_depend>tf</run_depend></package>")
    )
    names = pkg("depends", "wall_follower").stdout.split()
    assert {"rclpy", "tf"} <= set(names) and "a" not in names


def test_the_prefix_of_a_source_package_is_its_folder(workspace: Path) -> None:
    folder = workspace / "src/wall_follower"
    assert pkg("prefix", "wall_follower").stdout == pkg("prefix", "wall_follower", "--share").stdout == f"{folder}\n"


def test_the_prefix_of_an_installed_package_contains_share(workspace: Path) -> None:
    share = workspace / "elsewhere/share/tool"
    share.mkdir(parents=True)
    (share / "package.xml").write_text("<package><name>tool</name></package>")
    option = ("--package-path", workspace / "elsewhere")
    assert pkg("prefix", "tool", *option).stdout == f"{workspace / 'elsewhere'}\n"
    assert pkg("prefix", "tool", "--share", *option).stdout == f"{share}\n"


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("prefix", "wal_follower"), "SK-NODE-060 no ROS package 'wal_follower'; did you mean 'wall_follower'?"),
        (("create", "Robot"), "SK-NODE-062 'Robot' cannot be the name of a package"),
        (("create", "wall_follower", "--destination-directory", "src"), "SK-NODE-063 src/wall_follower exists already"),
    ],
)
def test_mistakes_are_one_message(arguments: tuple[str, ...], text: str) -> None:
    result = pkg(*arguments)
    assert result.exit_code == 2
    assert text in result.stderr


def test_known_nodes_are_listed_with_those_without_effect() -> None:
    listed = CliRunner().invoke(app, ["pkg", "known"]).stdout.splitlines()
    assert "tf2_ros/static_transform_publisher" in listed
    assert any(line.startswith("rviz2/rviz2: no effect; ") for line in listed)
    assert CliRunner().invoke(app, ["pkg", "known", "no such text"]).stdout == ""

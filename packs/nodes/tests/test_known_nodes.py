"""Known nodes: a pack has a program for an executable of ROS, or says that it has no effect."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import simkit
from simkit import Simulation
from simkit.errors import InputError, NodeError
from simkit_nodes.known_nodes import known_node, known_node_names

WORLD = '<sdf version="1.9"><world name="w"/></sdf>'

TABLE = """
["robot_tools/describe"]
program = "programs/describe.py"
also = ["old_tools/describe.py"]

["robot_tools/fail"]
program = "programs/fail.py"

["robot_tools/refuse"]
program = "programs/refuse.py"

["show_*/*"]
nothing = "look at the page"

["show_all/once"]
nothing = "look at the page"
ends = true
"""

DESCRIBE = """
import sys
import rclpy
from rclpy.node import Node
from simkit_nodes.host import current_host
from plural import plural_of
from simkit_fleet.texts import TEXT

def main():
    rclpy.init()
    node = Node("describe")
    sim = current_host().simulation
    node.get_logger().info(f"{sys.argv} {plural_of('model')}: {sorted(sim.models)} {TEXT} {__name__}")
    for each in {"a", "b"}:
        pass
    rclpy.spin(node)
"""

Install = Callable[[str], Path]


@pytest.fixture
def install_pack(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Function that installs a pack `fleet` of another distribution with a table of known nodes."""

    def install(table: str) -> Path:
        site = tmp_path / "site"
        files = {
            "fleet-1.0.dist-info/entry_points.txt": "[simkit.packs]\nfleet = simkit_fleet\n",
            "simkit_fleet/__init__.py": "",
            "simkit_fleet/texts.py": "TEXT = 'shared'\n",
            "simkit_fleet/known_nodes.toml": table,
            "simkit_fleet/programs/describe.py": DESCRIBE,
            "simkit_fleet/programs/plural.py": "import rclpy\ndef plural_of(name): return name + 's'\n",
            "simkit_fleet/programs/fail.py": "import rclpy\n\ndef main():\n    raise KeyError('no entry')\n",
            "simkit_fleet/programs/refuse.py": "import rclpy, sys\n\ndef main():\n    sys.exit('no parameter x')\n",
        }
        for name, text in files.items():
            path = site / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        monkeypatch.syspath_prepend(str(site))
        return site / "simkit_fleet"

    forget_pack()  # other tests have a pack of this name too
    yield install
    forget_pack()


def forget_pack() -> None:
    """Have the modules of the pack `fleet` imported again."""
    for name in [name for name in sys.modules if name.partition(".")[0] == "simkit_fleet"]:
        del sys.modules[name]


@pytest.fixture
def sim() -> Iterator[Simulation]:
    simulation = simkit.load(
        WORLD.replace("/></sdf>", '><model name="box"><static>1</static><link name="l"/></model></world></sdf>')
    )
    yield simulation
    simulation.close()


def test_a_known_node_runs_as_a_program_with_its_own_files_and_the_simulation(
    install_pack: Install, sim: Simulation
) -> None:
    install_pack(TABLE)
    node = sim.add_node("old_tools/describe.py", args=("a", "b"))
    sim.run(0.1)
    assert node.name == "describe"
    assert node.log[0].endswith("['old_tools/describe.py', 'a', 'b'] models: ['box'] shared __main__")
    assert node.error is None


def test_the_user_is_told_nothing_about_the_source_of_a_known_node(install_pack: Install, sim: Simulation) -> None:
    install_pack(TABLE)
    sim.add_node("robot_tools/describe")
    sim.run(0.1)
    assert not sim.diagnostics


def test_a_known_node_that_raises_fails_the_run_and_names_its_pack(install_pack: Install, sim: Simulation) -> None:
    folder = install_pack(TABLE)
    sim.add_node("robot_tools/fail")
    sim.run(0.1)
    place = folder / "programs/fail.py"
    with pytest.raises(NodeError) as caught:
        sim.check_nodes()
    assert f"'fail' (a program of the pack fleet) raised KeyError at {place}:4: 'no entry'" in str(caught.value)


def test_a_known_node_can_end_with_a_text_for_the_user(install_pack: Install, sim: Simulation) -> None:
    install_pack(TABLE)
    node = sim.add_node("robot_tools/refuse")
    sim.run(0.1)
    assert node.log == ["no parameter x"]
    assert node.exit_code == 1


def test_an_executable_without_effect_runs_until_the_end_of_the_run_and_is_noted(
    install_pack: Install, sim: Simulation
) -> None:
    install_pack(TABLE)
    node, once = sim.add_node("show_robot/show"), sim.add_node("show_all/once")
    sim.run(0.1)
    assert [node.done, once.done] == [False, True]
    texts = [each.message for each in sim.diagnostics if each.code == "SK-NODE-064"]
    assert texts == [f"{name} has no effect here: look at the page" for name in ("show_robot/show", "show_all/once")]
    sim.close()
    assert node.done
    assert node.error is None


def test_a_python_executable_of_the_workspace_comes_before_a_known_node(
    install_pack: Install, sim: Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install_pack(TABLE)
    package = tmp_path / "ws/src/robot_tools"
    (package / "scripts").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>robot_tools</name></package>")
    (package / "CMakeLists.txt").write_text(
        "project(robot_tools)\nadd_executable(fail src/fail.cpp)\n"
        "install(PROGRAMS scripts/describe DESTINATION lib/robot_tools)\n"
    )
    (package / "scripts/describe").write_text("#!/usr/bin/env python3\nprint('mine')\n")
    monkeypatch.chdir(tmp_path / "ws")
    mine, known = sim.add_node("robot_tools/describe"), sim.add_node("robot_tools/refuse")
    sim.run(0.1)
    assert mine.log == ["mine"]
    assert known.log == ["no parameter x"]


def test_faults_in_a_table_are_told_and_the_rest_of_it_counts(
    install_pack: Install, caplog: pytest.LogCaptureFixture
) -> None:
    install_pack(
        """
["a/missing"]
program = "programs/nowhere.py"
["a"]
nothing = "x"
["a/both"]
program = "programs/describe.py"
nothing = "x"
["a/typo"]
programm = "programs/describe.py"
["a/good"]
nothing = "x"
"""
    )
    with caplog.at_level(logging.WARNING, "simkit"):
        assert known_node("a/good") is not None
    assert all(known_node(name) is None for name in ("a/missing", "a/both", "a/typo"))
    texts = [record.getMessage().partition("known_nodes.toml: ")[2] for record in caplog.records]
    assert texts == [
        "[a/missing] has no file programs/nowhere.py",
        "[a] has the name 'a'; expected PACKAGE/EXECUTABLE",
        "[a/both] needs either 'program' or 'nothing'",
        "[a/typo] has no key 'programm'; allowed: also, ends, loads_controllers, nothing, program, world",
    ]


def test_the_tables_of_the_packs_of_simkit_have_no_faults(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING, "simkit"):
        names = known_node_names()
    assert names == sorted(set(names))
    assert not caplog.records


def test_an_executable_that_nobody_knows_is_an_error(install_pack: Install, sim: Simulation) -> None:
    install_pack(TABLE)
    with pytest.raises(InputError, match="no ROS package 'robot_tools'"):
        sim.add_node("robot_tools/other")

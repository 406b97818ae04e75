"""A run of a sweep that lacks a plugin of the other runs fails, and a sweep continues only with the same plugins."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest
from typer.testing import CliRunner

import simkit
from simkit.cli import app
from simkit.errors import InputError

pytestmark = pytest.mark.leaves_out

INERTIA = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
ROBOT = f"""<robot name="robot" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="joint" default="axle"/>
<link name="base">{INERTIA}</link><link name="wheel">{INERTIA}</link>
<joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/><axis xyz="0 1 0"/></joint>
<gazebo><plugin name="drive" filename="gz-sim-joint-controller-system">
<joint_name>$(arg joint)</joint_name></plugin></gazebo></robot>"""
DRIVE = "plugin 'drive' (gz-sim-joint-controller-system) of 'robot'"


def sweep(folder: Path, joints: list[str], seeds: int = 1) -> list[tuple[int, str]]:
    """Sweep the joint that the plugin drives; return the exit code and the message of each run."""
    (folder / "robot.urdf.xacro").write_text(ROBOT, encoding="utf-8")
    table = simkit.sweep(
        folder / "robot.urdf.xacro", {"xacro.joint": joints}, seeds=seeds, duration=0.01, jobs=1, folder=folder / "out"
    )
    return list(zip(table["exit_code"], table["message"].fillna(""), strict=True))


def test_a_run_fails_if_its_values_leave_out_a_plugin_that_the_others_have(tmp_path: Path) -> None:
    good, bad = sweep(tmp_path, ["axle", "axel"])
    assert good == (0, "")
    assert bad == (2, f"SK-SWEEP-012 the world of this run is without {DRIVE}, which other runs have")


def test_a_sweep_whose_worlds_all_lack_a_plugin_runs_and_tells_it(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING, "simkit"):
        assert sweep(tmp_path, ["axel"]) == [(0, "")]
    assert f"the world runs without {DRIVE}" in caplog.text


SWEEP = "world: world.sdf\nduration: 0.01\nseeds: 4\nparameters: {m::base.inertial.mass: [1.0, 2.0]}\n"
WORLD = """<sdf version="1.9"><world name="w"><include><uri>m.sdf</uri></include></world></sdf>"""
MODEL = """<sdf version="1.9"><model name="m"><link name="base"/><link name="wheel"/><joint name="axle" type="revolute">
<parent>base</parent><child>wheel</child><axis><xyz>0 1 0</xyz></axis></joint><plugin name="drive"
filename="gz-sim-joint-controller-system"><joint_name>axle</joint_name></plugin></model></sdf>"""


@pytest.mark.slow
@pytest.mark.parametrize(("first", "then", "words"), [("axle", "axel", "is now without"), ("axel", "axle", "now has")])
def test_a_sweep_continues_only_with_the_plugins_of_its_stored_runs(
    first: str, then: str, words: str, tmp_path: Path
) -> None:
    def run(joint: str, shard: int) -> str:
        (tmp_path / "m.sdf").write_text(MODEL.replace("<joint_name>axle", f"<joint_name>{joint}"), encoding="utf-8")
        arguments = ["sweep", str(tmp_path / "s.yaml"), "-o", str(tmp_path / "out"), "--shard", f"{shard}/2"]
        result = CliRunner().invoke(app, arguments)
        return " ".join(result.output.split()) if result.exit_code else ""

    (tmp_path / "s.yaml").write_text(SWEEP, encoding="utf-8")
    (tmp_path / "world.sdf").write_text(WORLD, encoding="utf-8")
    assert run(first, 0) == ""
    text = run(then, 1)
    assert "SK-SWEEP-003" in text and f"{words} plugin 'drive' (gz-sim-joint-controller-system) of 'm'" in text
    assert run(first, 1) == ""


def test_a_damaged_note_of_what_is_left_out_is_no_sweep(tmp_path: Path) -> None:
    sweep(tmp_path, ["axle"])
    file = tmp_path / "out" / "sweep.json"
    file.write_text(file.read_text(encoding="utf-8").replace('"left_out": {}', '"left_out": [1]'), encoding="utf-8")
    with pytest.raises(InputError, match="SK-SWEEP-008"):
        sweep(tmp_path, ["axle"])

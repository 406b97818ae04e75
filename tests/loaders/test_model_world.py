"""World of a bare model: ground and sun, empty space, or a world of the user's choice."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

import simkit
from simkit.cli import app
from simkit.run_spec import GROUND, RunSpec
from simkit.testing.golden.record_encoding import decode_scenario, encode_scenario
from simkit.testing.scenarios.scenario_run import open_scenario

ROBOT = """<robot name="robot"><link name="base"><inertial><mass value="1"/>
<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 -0.3"/><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link></robot>"""
LAB = """<sdf version="1.9"><world name="lab"><model name="desk"><static>true</static><pose>0 0 0.35 0 0 0</pose>
<link name="l"><collision name="c"><geometry><box><size>1 1 0.7</size></box></geometry></collision></link></model>
</world></sdf>"""
MJCF = """<mujoco model="drone"><option gravity="0 0 -3"/><worldbody>{}<body name="b"><freejoint/>
<geom size="0.05" pos="0 0 -0.1"/></body></worldbody></mujoco>"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "robot.urdf").write_text(ROBOT)
    (tmp_path / "lab.sdf").write_text(LAB)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*arguments: str) -> str:
    result = CliRunner().invoke(app, ["run", *arguments, "--duration", "0.5"])
    assert result.exit_code == 0, result.output
    return result.output


def height(spec: RunSpec) -> float:
    with open_scenario(spec) as sim:
        return float(sim.model(next(n for n, m in sim.models.items() if not m.static)).pose.position[2])


def test_a_bare_model_runs_on_the_ground_and_a_load_of_it_is_in_empty_space(folder: Path) -> None:
    with open_scenario(RunSpec("robot.urdf")) as sim:
        assert sim.world.name == "default"
        assert sorted(sim.models) == ["ground_plane", "robot"] and [light.name for light in sim.world.lights] == ["sun"]
        assert sim.model("robot").pose.position[2] == pytest.approx(0.4, abs=1e-9)
        sim.run(1.0)
        assert sim.model("robot").pose.position[2] == pytest.approx(0.4, abs=1e-3)
        assert sim.run_spec is not None and sim.run_spec.model_world == GROUND
    with simkit.load("robot.urdf") as sim:
        assert list(sim.models) == ["robot"] and sim.model("robot").pose.position[2] == 0.0
    assert simkit.describe("robot.urdf")["worlds"] == []


def test_the_command_line_says_where_the_model_stands(folder: Path) -> None:
    assert "robot starts on level ground" in run("robot.urdf")
    assert "fell out of the world" not in run("robot.urdf", "--world", "lab.sdf")
    fallen = CliRunner().invoke(app, ["run", "robot.urdf", "--world", "none", "--duration", "2", "-q"])
    assert fallen.exit_code == 0
    assert "SK-SPAWN-007" in fallen.output and "freely since about t = 0.00 s" in fallen.output.replace("\n", " ")


@pytest.mark.parametrize(("model_world", "expected"), [(GROUND, 0.4), ("none", 0.0), ("lab.sdf", 1.1), ("empty", 0.4)])
def test_the_world_of_a_model_can_be_chosen_and_survives_a_golden_record(
    folder: Path, model_world: str, expected: float
) -> None:
    spec = RunSpec("robot.urdf", model_world=model_world)
    assert height(spec) == pytest.approx(expected, abs=1e-6)
    golden = folder / "golden" / "robot"
    golden.mkdir(parents=True)
    assert height(decode_scenario(encode_scenario(spec, golden), golden)) == pytest.approx(expected, abs=1e-6)


def test_a_golden_run_of_an_older_version_stays_in_empty_space(folder: Path) -> None:
    assert decode_scenario({"world": "robot.urdf"}, folder).model_world == "none"


@pytest.mark.needs_packs
@pytest.mark.parametrize("chosen", [(), ("--world", "lab.sdf"), ("--world", "none")])
def test_a_bundle_repeats_a_model_in_its_world(folder: Path, chosen: tuple[str, ...]) -> None:
    runner = CliRunner()
    packed = runner.invoke(app, ["bundle", "robot.urdf", *chosen, "-o", "b.zip", "--duration", "0.3"])
    assert packed.exit_code == 0, packed.output
    (folder / "lab.sdf").unlink()
    again = runner.invoke(app, ["replay", "b.zip"])
    assert again.exit_code == 0 and "identical" in again.output, again.output


def test_a_model_with_a_ground_of_its_own_gets_no_other_one(folder: Path) -> None:
    plane = '<geom type="plane" size="1 1 1"/>'
    with open_scenario(RunSpec(MJCF.format(plane), model_world=GROUND)) as sim:
        assert "ground_plane" not in sim.models
    floor = LAB[LAB.index("<model") : LAB.index("</world>")].replace("<box><size>1 1 0.7</size></box>", "<plane/>")
    with open_scenario(RunSpec(f'<sdf version="1.9">{floor}</sdf>')) as sim:
        assert list(sim.models) == ["desk"]


def test_a_bare_mjcf_model_keeps_its_settings_on_the_ground(folder: Path) -> None:
    with open_scenario(RunSpec(MJCF.format(""))) as sim:
        assert sim.gravity.tolist() == [0.0, 0.0, -3.0]
        assert sim.model("drone").link("b").pose.position[2] == pytest.approx(0.15, abs=1e-9)
        sim.run(0.5)
        assert sim.model("drone").link("b").pose.position[2] == pytest.approx(0.15, abs=1e-3)


def test_a_world_for_a_file_that_is_a_world_is_ignored_with_a_warning(folder: Path) -> None:
    with simkit.load("lab.sdf", model_world="empty") as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SPAWN-006"] == ["warning"]
        assert list(sim.models) == ["desk"]


def test_a_world_that_does_not_exist_or_has_a_model_of_that_name_is_an_error(folder: Path) -> None:
    with pytest.raises(simkit.LoadError, match="SK-LOAD-002"):
        simkit.load("robot.urdf", model_world="nowhere.sdf")
    (folder / "lab.sdf").write_text(LAB.replace("desk", "robot"))
    with pytest.raises(simkit.LoadError, match="SK-SPAWN-002"):
        simkit.load("robot.urdf", model_world="lab.sdf")


def test_an_mjcf_model_with_a_light_on_its_body_gets_no_sun(folder: Path) -> None:
    for light, suns in (("", 1), ('<light pos="0 0 3"/>', 0)):
        (folder / "drone.xml").write_text(MJCF.format("").replace("<freejoint/>", f"<freejoint/>{light}"))
        with open_scenario(RunSpec("drone.xml")) as sim:
            assert len(sim.world.lights) == suns

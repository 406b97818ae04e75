"""A sensor or plugin of a file that has errors is left out, and the world runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import simkit
from simkit.run_spec import RunSpec
from simkit.testing.golden.compare.runs import compare
from simkit.testing.golden.record_encoding import decode_record, encode_record
from simkit.testing.run_record.record import RunRecord
from simkit.testing.run_record.run_recorder import record_run

pytestmark = pytest.mark.leaves_out

JOINT = (
    "<link name='wheel'><pose>0 0.1 0 0 0 0</pose></link>"
    "<joint name='axle' type='revolute'><parent>base</parent><child>wheel</child><axis><xyz>0 1 0</xyz></axis></joint>"
)
DRIVE = "<plugin name='drive' filename='gz-sim-joint-controller-system'><joint_name>{}</joint_name></plugin>"
ODOMETRY = (
    "<plugin name='odometry' filename='gz-sim-odometry-publisher-system'>"
    "<odom_publish_frequency>{}</odom_publish_frequency></plugin>"
)


def model(plugins: str, sensor: str = "") -> str:
    base = f"<link name='base'>{sensor}</link>"
    return f"<sdf version='1.9'><model name='robot'>{base}{JOINT}{plugins}</model></sdf>"


def codes(found: object) -> list[tuple[str, str]]:
    return [(d.severity, d.code) for d in found if d.severity != "note"]  # type: ignore[attr-defined]


def test_the_world_runs_without_a_plugin_that_names_an_unknown_joint() -> None:
    with simkit.load(model(DRIVE.format("axel") + ODOMETRY.format(50))) as sim:
        assert codes(sim.diagnostics) == [("warning", "SK-PLUGIN-003"), ("warning", "SK-LOAD-014")]
        assert [p.name for p in sim.engine.structure.all_plugins() if p.source is not None] == ["odometry"]
        sim.step(10)


def test_the_warning_tells_what_does_not_work() -> None:
    with simkit.load(model(DRIVE.format("axel"))) as sim:
        warning = next(d for d in sim.diagnostics if d.code == "SK-LOAD-014")
    assert "plugin 'drive' (gz-sim-joint-controller-system) of 'robot' is left out" in warning.message
    assert "'robot' does not follow the commands" in warning.message
    assert "no command is received on /model/robot/joint/" in warning.message


def test_every_faulty_plugin_is_left_out_and_every_other_one_stays() -> None:
    with simkit.load(model(DRIVE.format("axel") + ODOMETRY.format("fast") + DRIVE.format("axle"))) as sim:
        assert [p.where.line for p in sim.engine.structure.all_plugins() if p.source is not None] == [1]
        sim.publish("/model/robot/joint/axle/cmd_vel", {"data": 1.0})
        sim.step(100)
        assert sim.joint("robot::axle").velocity == pytest.approx(1.0, abs=0.05)


def test_the_same_robot_twice_loses_the_plugin_twice() -> None:
    inner = model(DRIVE.format("axel")).partition("<model name='robot'>")[2].removesuffix("</model></sdf>")
    models = "".join(f"<model name='robot'>{inner}</model>".replace("robot'", f"{name}'") for name in ("a", "b"))
    with simkit.load(f"<sdf version='1.9'><world name='w'>{models}</world></sdf>") as sim:
        assert sum(d.code == "SK-LOAD-014" for d in sim.diagnostics) == 2


def test_a_sensor_with_an_invalid_number_is_left_out_with_its_plugins() -> None:
    sensor = (
        "<sensor name='scan' type='gpu_lidar'><lidar><scan><horizontal><samples>many</samples></horizontal></scan>"
        "</lidar></sensor>"
    )
    with simkit.load(model(ODOMETRY.format(50), sensor)) as sim:
        assert ("warning", "SK-LOAD-013") in codes(sim.diagnostics)
        assert not sim.engine.structure.all_sensors()
        sim.step(5)


def test_with_strict_the_error_stops_the_load() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003") as caught:
        simkit.load(model(DRIVE.format("axel")), strict=True)
    assert "SK-LOAD-014" not in [d.code for d in caught.value.diagnostics]


def test_a_value_of_the_command_line_is_never_left_out() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(model(ODOMETRY.format(50)), overrides=["robot::odometry.odom_publish_frequency=fast"])


def test_an_error_outside_of_plugins_stops_the_load() -> None:
    text = model(DRIVE.format("axel")).replace("<child>wheel</child>", "<child>whele</child>")
    with pytest.raises(simkit.LoadError, match="whele"):
        simkit.load(text)


def test_a_spawned_model_loses_its_faulty_plugin(tmp_path: Path) -> None:
    file = tmp_path / "robot.sdf"
    file.write_text(model(DRIVE.format("axel")), encoding="utf-8")
    with simkit.load("<sdf version='1.9'><world name='w'/></sdf>") as sim:
        sim.spawn(file)
        assert ("warning", "SK-LOAD-014") in codes(sim.diagnostics)
        assert "robot" in sim.models
        sim.step(5)


def test_a_run_without_faulty_plugins_has_the_same_bits() -> None:
    states = []
    for plugins in ("", ODOMETRY.format("fast")):
        with simkit.load(model(plugins)) as sim:
            sim.step(50)
            states.append(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())
    assert states[0] == states[1]


def recorded(file: Path, *plugins: str) -> RunRecord:
    """Record a short run of the robot with some plugins."""
    file.write_text(model("".join(plugins)), encoding="utf-8")
    run = record_run(RunSpec(str(file), duration=0.01, model_world="none"))
    assert run.simulation is not None
    run.simulation.close()
    return run


def test_a_golden_check_fails_if_a_plugin_is_newly_left_out(tmp_path: Path) -> None:
    file = tmp_path / "robot.sdf"
    golden, run = recorded(file, DRIVE.format("axle")), recorded(file, DRIVE.format("axel"))
    first = compare(golden, run).differences[0]
    assert first.kind == "left out"
    drive = "plugin 'drive' (gz-sim-joint-controller-system) of 'robot'"
    assert first.words == f"the world runs without {drive}, which the golden run had ({file}:1: SK-LOAD-014)"
    assert not compare(run, run).differences
    mended = compare(run, golden)
    assert "left out" not in [d.kind for d in mended.differences] and f"{drive} is no longer left out" in mended.notes


def test_another_plugin_that_is_left_out_fails_a_golden_check_too(tmp_path: Path) -> None:
    file = tmp_path / "robot.sdf"
    golden = recorded(file, DRIVE.format("axel"), ODOMETRY.format(50))
    run = recorded(file, DRIVE.format("axle"), ODOMETRY.format("fast"))
    assert sum(golden.left_out.values()) == sum(run.left_out.values()) == 1  # type: ignore[union-attr]
    found = [d.field for d in compare(golden, run).differences if d.kind == "left out"]
    assert found == ["plugin 'odometry' (gz-sim-odometry-publisher-system) of 'robot'"]


def test_a_plugin_whose_library_has_a_typo_fails_a_golden_check(tmp_path: Path) -> None:
    file = tmp_path / "robot.sdf"
    golden = recorded(file, ODOMETRY.format(50))
    run = recorded(file, ODOMETRY.format(50).replace("odometry-publisher", "odometry-publsher"))
    assert [d.kind for d in compare(golden, run).differences][:1] == ["left out"]


def test_a_stored_golden_run_keeps_what_is_left_out_and_an_older_one_is_compared_by_number(tmp_path: Path) -> None:
    run = recorded(tmp_path / "robot.sdf", DRIVE.format("axel"))
    stored, data = encode_record(run)
    assert decode_record(stored, data, run.scenario).left_out == run.left_out
    older = replace(run, left_out=None)
    assert not compare(older, run).differences
    assert [d.kind for d in compare(replace(older, diagnostics={}), run).differences] == ["left out"]


def test_a_plugin_of_a_model_that_is_spawned_at_the_load_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "robot.sdf").write_text(model(DRIVE.format("axel")))
    world = "<sdf version='1.9'><world name='w'/></sdf>"
    with simkit.load(world, spawn=[f"{tmp_path / 'robot.sdf'}:0,0,0"]) as sim:
        assert codes(sim.diagnostics) == [("warning", "SK-PLUGIN-003"), ("warning", "SK-LOAD-014")]
        sim.step(10)

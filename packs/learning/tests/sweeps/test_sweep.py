"""Sweeps: tables of runs with different parameters, equal for any number of processes."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from sweep_worlds import BOX, SLOPE, crashing, height

import simkit
from simkit import InputError, RunSpec
from simkit.recording import Recorder
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing import open_scenario
from simkit_learning.sweeps.design import Design
from simkit_learning.sweeps.parameter_space import parameter_space
from simkit_learning.sweeps.row_runner import RowRunner
from simkit_learning.sweeps.sweep_spec import SweepSpec
from simkit_verification.testing.bundles import replay

GRAVITY = RunSpec(BOX, duration=0.2, overrides=("world.gravity=0 0 {g}",))


def test_the_table_has_parameters_metrics_and_ends() -> None:
    def greatest_speed(sim: Any) -> Any:
        speeds = [0.0]
        yield sim.subscribe("/clock", lambda _: speeds.append(-sim.link("box::l").linear_velocity[2]))
        yield max(speeds)

    metrics = {"z": "pose('box').z", "same": height, "fall": "path_length('box')", "speed": greatest_speed}
    table = simkit.sweep(GRAVITY, {"g": [-1.0, -4.0]}, seeds=2, metrics=metrics, jobs=1)
    assert list(table.columns)[:7] == ["run", "seed", "g", "z", "same", "fall", "speed"]
    assert table["g"].tolist() == [-1, -1, -4, -4] and table["seed"].tolist() == [0, 1, 0, 1]
    for _, row in table.iterrows():
        assert row["z"] == row["same"] == pytest.approx(0.5 + row["g"] * 0.02, abs=2e-4 * 4)
        assert row["fall"] == pytest.approx(0.5 - row["z"], abs=1e-9)
        assert (row["status"], row["end"], row["time"], row["steps"], row["code"]) == ("ok", "duration", 0.2, 200, "")
        assert 0 < row["speed"] <= -row["g"] * 0.2 + 1e-9
    assert table["state_hash"][0] == table["state_hash"][1] != table["state_hash"][2]


@pytest.mark.slow
def test_a_world_that_stays_loaded_has_the_bits_of_a_fresh_load() -> None:
    names = {
        "box::l.inertial.mass": {"uniform": [0.5, 2.0]},
        "box::l::c.surface.friction.ode.mu": {"uniform": [0.01, 0.2]},
        "post::l::c.geometry.cylinder.radius": {"uniform": [0.02, 0.1]},
        "world.gravity": [[3.0, 0.5, -9.8], [2.0, 0.0, -9.0]],
    }
    spaces = tuple(parameter_space(name, space) for name, space in names.items())
    spec = SweepSpec(RunSpec(SLOPE, duration=0.7), Design(spaces, (0, 1), 4), {"hits": "collisions('box', 'post')"})
    warm = RowRunner(spec)
    found = []
    for run in (0, 1, 5, 9, 5, 0, 14):
        row = spec.design.row(run)
        result = warm.run(row)
        with open_scenario(spec.row_spec(row)) as sim:
            sim.run(0.7)
            assert (result.state_hash, result.time) == (state_hash(sim), sim.time), run
        found.append(result.metrics["hits"])
    warm.close()
    assert max(found) >= 1


@pytest.mark.slow
def test_one_and_three_processes_give_equal_tables(tmp_path: Path) -> None:
    parameters = {"box::l.inertial.mass": {"uniform": [-0.2, 1]}, "world.gravity": [[0, 0, -1], [1, 0, -2]]}
    tables = [
        simkit.sweep(BOX, parameters, samples=12, duration=0.05, metrics={"z": "pose('box').z"}, jobs=jobs)
        for jobs in (1, 3)
    ]
    assert tables[0].equals(tables[1])
    assert set(tables[0]["status"]) == {"ok", "invalid"} and len(tables[0]) == 24


def test_failures_are_rows_with_codes_and_bundles(tmp_path: Path) -> None:
    spec = RunSpec(BOX, duration=0.1, overrides=("world.gravity=0 0 {g}",), until="pose('box').z < 0.49")

    def metric(sim: Any) -> float:
        return 1.0 / (0.0 if sim.seed == 1 else 1.0)

    parameters = {"g": [-9.0, -0.1, 0.0 - 1e16]}
    table = simkit.sweep(spec, parameters, seeds=2, metrics={"m": metric}, jobs=1, folder=tmp_path / "out", keep="all")
    found = {(row["g"], row["seed"]): (row["status"], row["code"]) for _, row in table.iterrows()}
    assert found[-9.0, 0] == ("ok", "")
    assert found[-9.0, 1] == ("plugin", "SK-SWEEP-004")
    assert found[-0.1, 0] == ("failed", "SK-SWEEP-006")
    assert found[-1e16, 0] == ("diverged", "SK-PHYS-001")
    row = table.iloc[0]
    assert row["end"] == "until" and row["time"] < 0.1 and row["m"] == 1.0
    assert math.isnan(table["m"][1]) and "ZeroDivisionError" in table["message"][1]
    assert len(list((tmp_path / "out" / "runs").glob("*.zip"))) == 6
    assert replay(tmp_path / "out" / "runs" / "000002.zip").is_same


def test_a_diverged_run_is_a_row_and_the_next_run_is_sound() -> None:
    parameters = {"box::l.inertial.mass": [1.0], "world.gravity": [[0, 0, -1], [0, 0, -1e300], [0, 0, -1]]}
    table = simkit.sweep(BOX, parameters, duration=0.05, jobs=1)
    assert table["exit_code"].tolist() == [0, 3, 0] and table["code"][1] == "SK-PHYS-001"
    assert table["state_hash"][0] == table["state_hash"][2]


@pytest.mark.slow
def test_a_process_that_crashes_costs_one_run() -> None:
    table = simkit.sweep(BOX, seeds=8, duration=0.01, metrics={"m": crashing}, jobs=2)
    assert table["status"].tolist() == ["ok"] * 3 + ["error"] + ["ok"] * 4
    assert table["code"][3] == "SK-SWEEP-007" and "SIGABRT" in table["message"][3]


def test_a_csv_file_gives_the_values_of_each_run(tmp_path: Path) -> None:
    (tmp_path / "runs.csv").write_text("g,box::l.inertial.mass\n-1,2\n-2.5,3\n", encoding="utf-8")
    table = simkit.sweep(GRAVITY, tmp_path / "runs.csv", jobs=1)
    assert table["g"].tolist() == [-1.0, -2.5] and table["box::l.inertial.mass"].tolist() == [2, 3]
    listed = [{"g": -1, "box::l.inertial.mass": 2}, {"g": -2.5, "box::l.inertial.mass": 3}]
    assert simkit.sweep(GRAVITY, listed, jobs=1)["state_hash"].tolist() == table["state_hash"].tolist()


@pytest.mark.parametrize(
    ("arguments", "messages"),
    [
        ({"parameters": {"bx::l.inertial.mass": [1]}}, ["SK-SWEEP-002", "did you mean 'box::l'"]),
        ({"parameters": {"speed": [1]}}, ["SK-SWEEP-002", "'speed' is not used"]),
        ({"parameters": {"world.gravity": {"uniform": [1, 2]}}}, ["samples: missing"]),
        ({"parameters": {"a.b": {"unifrm": [1]}, "c.d": []}}, ["'a.b'", "'c.d'"]),
        ({"metrics": {"a": "pose('bx').z", "b": "1 +"}}, ["metric 'a'", "metric 'b'"]),
        ({"metrics": {"a": "pose('box')"}}, ["SK-COND-004", "must be a number"]),
        ({"seeds": -1}, ["seeds"]),
        ({"jobs": 0}, ["jobs"]),
        ({"metrics": {"run": "time"}}, ["two columns"]),
        ({"until": "pose('bx').z < 0"}, ["SK-COND-005"]),
        ({"metrics": ["time"]}, ["SK-SWEEP-001 metrics: found ['time']"]),
        ({"metrics": {"a": 5}}, ["SK-SWEEP-001 metric 'a': found 5"]),
        ({"duration": -1.0}, ["duration: found -1.0"]),
        ({"duration": math.nan}, ["duration: found nan"]),
        ({"duration": "2"}, ["duration: found '2'"]),
        ({"duration": math.inf}, ["an endless run needs until"]),
        ({"parameters": {"box.count": [2], "box_*.mass": [2]}}, ["'mass' cannot be set here"]),
    ],
)
def test_a_wrong_sweep_is_refused_before_its_first_run(arguments: Any, messages: list[str]) -> None:
    given = {"duration": 0.01, "jobs": 1, **arguments}
    with pytest.raises(InputError) as error:
        simkit.sweep(BOX, given.pop("parameters", {}), **given)
    for message in messages:
        assert message in str(error.value)


# ---------------------------------------------------------------------- commands

BALL = BOX.replace(
    "</link></model>",
    """</link><plugin filename="gz-sim-velocity-control-system"
name="gz::sim::systems::VelocityControl"><topic>/cmd_vel</topic></plugin></model>""",
)
"""A box that moves as `/cmd_vel` says."""
X = {"x": "pose('box').x"}


def test_the_commands_of_a_sweep_are_a_list_a_velocity_a_script_or_a_bag(tmp_path: Path) -> None:
    forward = [{"at": 0.0, "topic": "/cmd_vel", "message": {"linear": {"x": "{v}"}}}]
    (tmp_path / "forward.yaml").write_text(str(forward), "utf-8")
    with simkit.load(BALL) as sim, Recorder(sim, tmp_path / "drive.mcap", topics=("/cmd_vel",)):
        sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
        sim.step()
    speeds = {"v": [0.5, 1.0]}
    for commands in (forward, "{v},0", tmp_path / "forward.yaml"):
        table = simkit.sweep(BALL, speeds, commands=commands, metrics=X, duration=0.1, jobs=1)
        assert table["x"].tolist() == pytest.approx([0.05, 0.1], abs=2e-3), commands
    played = simkit.sweep(BALL, commands=tmp_path / "drive.mcap", metrics=X, duration=0.1, jobs=1)
    assert played["x"].tolist() == pytest.approx([0.05], abs=2e-3)


def test_the_times_and_the_rate_of_a_command_are_variables() -> None:
    command = {"at": "{t}", "until": "{t}", "rate": "{rate}", "topic": "/cmd_vel", "message": {"linear": {"x": 1.0}}}
    table = simkit.sweep(BALL, {"t": [0.02, 0.05], "rate": [5]}, commands=[command], metrics=X, duration=0.1, jobs=1)
    assert table["x"].tolist() == pytest.approx([0.08, 0.05], abs=2e-3)
    with pytest.raises(InputError) as caught:
        simkit.sweep(BALL, {"t": [-1.0]}, commands=[{**command, "rate": 5}], metrics=X, duration=0.1, jobs=1)
    assert "at: found -1.0; expected a number of at least 0" in str(caught.value)


def test_the_commands_of_a_sweep_replace_those_of_the_specification() -> None:
    spec = RunSpec(BALL, velocity="1,0", duration=0.1)
    assert simkit.sweep(spec, metrics=X, jobs=1)["x"][0] == pytest.approx(0.1, abs=2e-3)
    assert simkit.sweep(spec, commands="-1,0", metrics=X, jobs=1)["x"][0] == pytest.approx(-0.1, abs=2e-3)
    assert simkit.sweep(spec, commands=[], metrics=X, jobs=1)["x"][0] == 0.0


@pytest.mark.parametrize(
    "commands, text",
    [
        (3, "found 3; expected a list of mappings"),
        ("missing.mcap", "a bag that exists"),
        ([{"topic": "/cmd_vel"}], "key 'at' is missing"),
        (["drive"], "expected {at, topic, message}"),
        ("missing.yaml", "cannot be read"),
        ("", "found ''; expected a list of mappings"),
        ([{"at": 0, "topic": "/cmd"}], "no topic '/cmd'; did you mean '/cmd_vel'"),
    ],
)
def test_a_sweep_with_invalid_commands_does_not_begin(commands: Any, text: str) -> None:
    with pytest.raises(InputError, match=text) as caught:
        simkit.sweep(BALL, commands=commands, metrics=X, duration=0.1, jobs=1)
    assert caught.value.code == "SK-CLI-011"


@pytest.mark.parametrize(
    "commands, code, text",
    [
        ("0.2,nan", "SK-CLI-010", "commands: found '0.2,nan'; expected LINEAR,ANGULAR"),
        ("{v},1,2", "SK-CLI-010", "found '0.5,1,2'"),
        ([{"at": 9, "topic": "/cmd_vel", "message": {"linaer": {}}}], "SK-CLI-012", "did you mean 'linear'"),
    ],
)
def test_commands_that_fit_no_run_are_refused_before_the_first_run(commands: Any, code: str, text: str) -> None:
    metrics = {"v": "pose('box').x"} if "{v}" not in commands else {"x": "pose('bax').x"}
    parameters = {"v": [0.5, 1.0]} if "{v}" in commands else {}
    with pytest.raises(InputError) as caught:
        simkit.sweep(BALL, parameters, commands=commands, metrics=metrics, duration=0.1, jobs=1)
    assert code in str(caught.value) and text in str(caught.value)
    assert ("did you mean 'box'" in str(caught.value)) == ("{v}" in commands)


def test_commands_that_fit_some_runs_fail_only_in_the_others() -> None:
    table = simkit.sweep(BALL, {"v": [1.0, "fast"]}, commands="{v},0", metrics=X, duration=0.1, jobs=1)
    assert table["status"].tolist() == ["ok", "invalid"]

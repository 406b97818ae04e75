"""Sweeps that share a folder, that changed since they were stored, or whose options contradict each other."""

from __future__ import annotations

import json
import multiprocessing
import sys
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from sweep_worlds import BOX, SLOPE
from typer.testing import CliRunner

import simkit
from simkit import RunSpec, build
from simkit.cli import app
from simkit.errors import InputError
from simkit.plugins import WorldPlugin
from simkit_learning.sweeps.design import Design
from simkit_learning.sweeps.metrics import FileMetric
from simkit_learning.sweeps.optimisation import optimise_sweep
from simkit_learning.sweeps.parameter_space import parameter_space
from simkit_learning.sweeps.result_store import locked_blocks, make_folder
from simkit_learning.sweeps.row_runner import RowRunner
from simkit_learning.sweeps.sweep import run_sweep
from simkit_learning.sweeps.sweep_spec import SweepSpec, spec_of_world

G = RunSpec(BOX, duration=0.02, overrides=("world.gravity=0 0 {g}",))


def spec_of(values: list[float], **options: Any) -> SweepSpec:
    return SweepSpec(G, Design((parameter_space("g", values),)), **options)


def take_block(folder: Path) -> str:
    try:
        with locked_blocks(folder, [2]):
            return "free"
    except InputError as error:
        return error.code


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no locks of this kind")
def test_parts_of_different_divisions_cannot_write_the_same_block(tmp_path: Path) -> None:
    make_folder(tmp_path)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        with locked_blocks(tmp_path, [0, 2]):
            with pytest.raises(InputError, match="SK-SWEEP-010"), locked_blocks(tmp_path, [1, 2]):
                pass
            for file in tmp_path.rglob("*"):
                if file.is_file():
                    file.read_bytes()  # a backup in this process opens and closes the files, and the locks stay
            assert pool.apply(take_block, (tmp_path,)) == "SK-SWEEP-010"
        assert pool.apply(take_block, (tmp_path,)) == "free"


def test_a_part_leaves_the_rows_of_other_parts_alone_and_keeps_its_own_failed_runs(tmp_path: Path) -> None:
    spec = spec_of([-1.0, -1e300, -2.0, -1e300, -1e300, -1e300], keep=1)
    run_sweep(spec, tmp_path, jobs=1, shard=(0, 2))
    foreign = tmp_path / "rows" / "000001.log"
    foreign.write_bytes(b'{"run":1,"exit')  # a row that another process is writing
    run_sweep(spec, tmp_path, jobs=1, shard=(0, 2))
    assert foreign.read_bytes() == b'{"run":1,"exit'
    assert [path.name for path in (tmp_path / "runs").glob("*")] == ["000004.zip"]
    run_sweep(spec, tmp_path, jobs=1, shard=(1, 2))
    assert sorted(path.name for path in (tmp_path / "runs").glob("*")) == ["000001.zip", "000004.zip"]


class Closing(WorldPlugin):
    """Counts its loads and closes in all worlds."""

    open_worlds = 0

    def load(self, sim: simkit.Simulation, params: Any) -> None:
        Closing.open_worlds += 1

    def close(self) -> None:
        Closing.open_worlds -= 1


@pytest.mark.parametrize(("names", "jobs"), [(["mass", "mas"], 1), (["mass"], 0)])
def test_a_sweep_that_a_check_refuses_closes_its_world(names: list[str], jobs: int, tmp_path: Path) -> None:
    before = Closing.open_worlds
    spaces = tuple(parameter_space(f"box::l.inertial.{name}", [1.0]) for name in names)
    with pytest.raises(InputError, match="SK-SWEEP-00[12]"):
        run_sweep(SweepSpec(RunSpec(BOX, duration=0.02, plugins=(Closing(),)), Design(spaces)), tmp_path, jobs=jobs)
    assert Closing.open_worlds == before


def test_a_part_of_a_sweep_that_cannot_write_its_locks_says_so(tmp_path: Path) -> None:
    make_folder(tmp_path)
    (tmp_path / "locks" / "000003.lock").mkdir()
    with pytest.raises(InputError, match="SK-CLI-016 cannot write"), locked_blocks(tmp_path, [1, 3]):
        pass
    with locked_blocks(tmp_path, [1]):
        pass


def test_a_duration_may_be_a_number_of_numpy() -> None:
    for number in (np.float32(0.5), np.array(0.5), np.float64(0.5)):
        assert type(spec_of_world(BOX, cast("float", number), "").duration) is float
    with pytest.raises(InputError, match=r"SK-SWEEP-001 duration: found array\(\[1., 2.\]\)"):
        spec_of_world(BOX, cast("float", np.array([1.0, 2.0])), "")


class Weigher(WorldPlugin):
    def __init__(self, factor: float) -> None:
        self.factor = factor

    def load(self, sim: simkit.Simulation, params: Any) -> None:
        """Do nothing."""


def test_a_change_of_a_metric_or_a_plugin_makes_another_sweep(tmp_path: Path) -> None:
    file = tmp_path / "cost.py"

    def of_file(text: str) -> str:
        file.write_text(f"def cost(sim):\n    return {text}\n", encoding="utf-8")
        return spec_of([-1.0], metrics={"m": FileMetric("cost.py:cost", tmp_path)}).fingerprint()

    assert of_file("1") == of_file("1") != of_file("2")

    def of_plugin(factor: float) -> str:
        run = RunSpec(BOX, plugins=(Weigher(factor),))
        return SweepSpec(run, Design((), range(2))).fingerprint()

    assert of_plugin(1.0) == of_plugin(1.0) != of_plugin(2.0)

    def of_function(number: float) -> str:
        return spec_of([-1.0], metrics={"m": lambda sim: sim.time * number}).fingerprint()

    assert of_function(1.0) == of_function(1.0) != of_function(2.0)

    def of_cycle(number: float) -> str:
        first, second = Weigher(number), Weigher(2.0)
        first.other, second.other = second, first  # type: ignore[attr-defined]
        return spec_of([-1.0], metrics={"m": lambda sim: first.factor}).fingerprint()

    assert of_cycle(1.0) == of_cycle(1.0) != of_cycle(2.0)

    other = spec_of([-1.0], metrics={"m": lambda sim: sim.time + 1.0}).fingerprint()
    assert other != spec_of([-1.0], metrics={"m": lambda sim: sim.time - 1.0}).fingerprint()


def test_a_strict_run_in_a_loaded_world_is_refused_as_in_a_fresh_one() -> None:
    run = RunSpec(SLOPE, duration=0.01, options={"strict": True})
    name = "box::l::c.surface.friction.ode"
    listed = ({f"{name}.mu": 0.5}, {f"{name}.mu": 0.5, f"{name}.mu2": 0.3}, {f"{name}.mu": 0.4})  # SK-PHYS-005
    spec = SweepSpec(run, Design((), listed=listed))
    runner = RowRunner(spec)
    found = [runner.run(spec.design.row(run)) for run in range(3)]
    runner.close()
    alone = RowRunner(spec)
    fresh = alone.run(spec.design.row(1))
    assert [one.exit_code for one in found] == [0, 2, 0]
    assert (found[1].exit_code, found[1].code, found[1].message) == (fresh.exit_code, fresh.code, fresh.message)


def test_the_world_is_read_once_before_the_first_run(monkeypatch: pytest.MonkeyPatch) -> None:
    reads: list[object] = []
    real = build.load_scene
    monkeypatch.setattr(build, "load_scene", lambda *args, **options: reads.append(args) or real(*args, **options))
    table = simkit.sweep(SLOPE, {"box::l.inertial.mass": [1.0, 2.0]}, duration=0.01, jobs=1)
    assert len(reads) == 1 and table["status"].tolist() == ["ok", "ok"]


def test_a_search_does_not_continue_with_other_values(tmp_path: Path) -> None:
    pytest.importorskip("optuna", reason="pip install 'simkit-robotics[search]'")
    space = (parameter_space("g", {"uniform": [-2.0, -1.0]}),)
    spec = SweepSpec(G, Design(space), {"z": "pose('box').z"})
    optimise_sweep(spec, tmp_path, "z", 2, jobs=1, always_processes=False)
    for log in (tmp_path / "rows").glob("000000*"):
        row = json.loads(log.read_text())
        row["values"]["g"] = -1.5
        log.write_text(json.dumps(row) + "\n")
    with pytest.raises(InputError, match="SK-SWEEP-003.*other values of run 0"):
        optimise_sweep(spec, tmp_path, "z", 2, jobs=1, always_processes=False)


@pytest.mark.parametrize(
    ("options", "messages"),
    [
        (["--optimise", "z", "--shard", "0/2"], ["--optimise excludes --shard"]),
        (["--trials", "5", "--maximise"], ["--trials needs --optimise", "--maximise needs --optimise"]),
        (["--cluster", "auto", "--jobs", "2"], ["--cluster excludes --jobs"]),
        (["--shard", "2/2"], ["--shard: found '2/2'"]),
    ],
)
def test_options_without_an_effect_are_refused(tmp_path: Path, options: list[str], messages: list[str]) -> None:
    (tmp_path / "box.sdf").write_text(BOX, encoding="utf-8")
    file = tmp_path / "sweep.yaml"
    file.write_text("world: box.sdf\nduration: 0.01\nseeds: 2\nmetrics: {z: pose('box').z}\n", encoding="utf-8")
    result = CliRunner().invoke(app, ["sweep", str(file), "-o", str(tmp_path / "out"), *options])
    assert result.exit_code == 2 and not (tmp_path / "out").exists()
    for message in messages:
        assert message in result.output

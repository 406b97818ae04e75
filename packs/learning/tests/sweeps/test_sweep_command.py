"""`simkit sweep`: files, report, replay and search."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from sweep_worlds import BOX
from typer.testing import CliRunner

from simkit.cli import app

SWEEP = """
world: box.sdf
duration: 0.1
set: ["world.gravity={side} 0 {g}"]
parameters:
  side: {uniform: [0, 4]}
  g: {uniform: [-1.0, -0.9]}
samples: 16
sampling: saltelli
metrics:
  x: pose('box').x
  z: pose('box').z
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "box.sdf").write_text(BOX, encoding="utf-8")
    (tmp_path / "sweep.yaml").write_text(SWEEP, encoding="utf-8")
    return tmp_path


def command(*words: str, code: int = 0) -> str:
    result = CliRunner().invoke(app, ["sweep", *words], catch_exceptions=False)
    assert result.exit_code == code, result.output
    return result.stdout if "--json" in words else result.output


@pytest.mark.slow
def test_a_sweep_is_run_reported_and_replayed(folder: Path) -> None:
    assert "64 runs: 64 ok, 0 failed" in command("sweep.yaml", "--jobs", "1")
    assert (folder / "sweep_sweep" / "results.csv").read_text().count("\n") == 65
    assert "64 of them before" in command("sweep.yaml")
    command("report", "sweep_sweep")
    page = (folder / "sweep_sweep" / "report.html").read_text()
    rows = [re.sub(r"<[^>]+>", " ", one).split() for one in re.findall(r"<tr><td>.*?</tr>", page, re.DOTALL)]
    first = {(row[0], row[1]): float(row[2]) for row in rows if len(row) == 5 and row[1] in ("side", "g")}
    # x depends on `side` alone and z on `g` alone, so these Sobol indices are 1 and the others 0
    assert first["x", "side"] == pytest.approx(1, abs=0.3) and first["z", "g"] == pytest.approx(1, abs=0.3)
    assert abs(first["x", "g"]) < 0.01 and abs(first["z", "side"]) < 0.01
    assert "<script" not in page and "http://www.w3.org/2000/svg" in page and page.count("<svg") >= 4
    assert "simkit sweep replay sweep_sweep" in page
    assert "same as in the table" in command("replay", "sweep_sweep", "7")
    assert json.loads(command("replay", "sweep_sweep", "7", "--json"))["differences"] == []


@pytest.mark.slow
def test_parts_of_a_sweep_make_one_table(folder: Path) -> None:
    command("sweep.yaml", "-o", "whole")
    assert "no table yet" in command("sweep.yaml", "-o", "parts", "--shard", "0/2")
    command("sweep.yaml", "-o", "parts", "--shard", "1/2", "--jobs", "2")
    assert (folder / "parts" / "results.csv").read_bytes() == (folder / "whole" / "results.csv").read_bytes()


@pytest.mark.slow
def test_a_change_of_the_world_is_another_sweep(folder: Path) -> None:
    command("sweep.yaml", "--jobs", "1")
    (folder / "box.sdf").write_text(BOX.replace("0 0 0.5", "0 0 0.6"), encoding="utf-8")
    assert "SK-SWEEP-003" in command("sweep.yaml", code=2)
    assert "SK-SWEEP-003" in command("replay", "sweep_sweep", "0", code=2)


@pytest.mark.parametrize(
    ("change", "messages"),
    [
        (("uniform: [0, 4]", "unifrm: [0, 4]"), ["sweep.yaml:6: error SK-SWEEP-001", "did you mean 'uniform'"]),
        (("z: pose('box').z", "z: pose('box'.z"), ["sweep.yaml:12: error SK-COND-001"]),
        (("samples: 16", "samples: 0\nseeds: -1"), ["samples", "seeds"]),
        (("saltelli", "saltely"), ["sampling", "saltelli"]),
        (("metrics:", "metric:"), ["SK-SCEN-002", "did you mean 'metrics'"]),
        (("z: pose('box').z", "z: {python: no.py:f}"), ["SK-SWEEP-005"]),
        (("g: {uniform", "h: {uniform"), ["SK-SWEEP-002"]),
    ],
)
def test_problems_of_a_file_name_its_lines(folder: Path, change: Any, messages: list[str]) -> None:
    (folder / "sweep.yaml").write_text(SWEEP.replace(*change), encoding="utf-8")
    found = command("sweep.yaml", "--allow-code", code=2)
    for message in messages:
        assert message in found


def test_correlated_parameters_and_python_metrics_come_from_the_file(folder: Path) -> None:
    (folder / "cost.py").write_text("def cost(sim):\n    return sim.seed * 2\n", encoding="utf-8")
    text = SWEEP.partition("parameters:")[0] + (
        "correlated:\n  - {parameters: [side, g], mean: [1, -1], deviation: [0.1, 0.2],"
        " correlation: [[1, 0.9], [0.9, 1]]}\nseeds: [4, 5]\nsamples: 2\nmetrics: {c: {python: cost.py:cost}}\n"
    )
    (folder / "sweep.yaml").write_text(text, encoding="utf-8")
    command("sweep.yaml", "--jobs", "2", "--plugin-path", ".")
    lines = (folder / "sweep_sweep" / "results.csv").read_text().splitlines()
    assert lines[0].startswith("run,seed,side,g,c,") and [line.split(",")[4] for line in lines[1:]] == ["8", "10"] * 2


@pytest.mark.slow
def test_a_search_continues_and_does_not_depend_on_the_number_of_processes(folder: Path) -> None:
    pytest.importorskip("optuna", reason="pip install 'simkit-robotics[search]'")
    search = ("sweep.yaml", "--optimise", "x", "--maximise")
    command(*search, "--trials", "20", "--jobs", "2", "-o", "a")
    command(*search, "--trials", "10", "--jobs", "1", "-o", "b")
    best = json.loads(command(*search, "--trials", "20", "--jobs", "1", "-o", "b", "--json"))["best"]
    assert (folder / "a" / "results.csv").read_bytes() == (folder / "b" / "results.csv").read_bytes()
    assert best["value"] == pytest.approx(best["values"]["side"] * 0.005, abs=2e-4) and best["values"]["side"] > 3.2
    assert "no metric 'y'" in command("sweep.yaml", "--optimise", "y", code=2)

"""Accuracy of SLAM in a long corridor, in the house and in the office: the runs of `benchmarks/slam.py`."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

pytestmark = pytest.mark.slow  # whole drives


@pytest.fixture(scope="module")
def benchmark_runs() -> ModuleType:
    file = Path(__file__).parents[3] / "benchmarks" / "slam.py"
    spec = importlib.util.spec_from_file_location("benchmark_slam", file)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_loop_of_60_m_closes_below_10_cm(benchmark_runs: ModuleType) -> None:
    drift, last, worst = benchmark_runs.loop()
    assert drift > 2.0
    assert last < 0.05 and worst < 0.10


@pytest.mark.parametrize("world", ["house", "office"])
def test_walls_are_where_they_are_although_the_odometry_drifts(benchmark_runs: ModuleType, world: str) -> None:
    occupied, seen, away, drift = benchmark_runs.simulated(world)
    assert drift > 0.1
    assert occupied >= 0.98 and seen >= 0.95
    assert away < 0.05

"""The history of speed: its statistics, and the page that is made from its entries."""

from __future__ import annotations

import importlib
import importlib.util
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).resolve().parents[1] / "benchmarks" / "history"


@pytest.fixture(scope="module")
def history() -> Iterator[Any]:
    """The command of the folder as a module; afterwards its modules are forgotten."""
    path, before = list(sys.path), set(sys.modules)
    spec = importlib.util.spec_from_file_location("speed_history", FOLDER / "__main__.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    importlib.import_module("page")
    yield module
    sys.path[:] = path
    for name in set(sys.modules) - before:
        if name in ("cases", "checkouts", "page"):
            del sys.modules[name]


def test_the_cost_of_a_side_is_the_sum_of_the_lower_quartiles_of_its_parts(history: Any) -> None:
    ours = [[1.0, 9.0, 2.0, 9.0], [5.0, 4.0, 9.0, 9.0]]
    bare = [[1.0, 1.0, 1.0, 1.0], [2.0, 2.0, 2.0, 9.0]]
    assert history.costs([ours, bare]) == (7.0, 3.0)


def test_the_times_of_two_turns_are_those_of_one_longer_turn(history: Any) -> None:
    assert history.merged([[[[1.0], [2.0]], [[3.0], [4.0]]]] * 2) == [
        [[1.0, 1.0], [2.0, 2.0]],
        [[3.0, 3.0], [4.0, 4.0]],
    ]


def test_a_ratio_has_grown_only_if_the_best_of_the_pairs_reaches_the_limit(history: Any) -> None:
    assert history.has_grown([0.12, 0.08, 0.3])
    assert not history.has_grown([0.12, 0.07, 0.3])


def test_entries_name_their_machine_without_a_host_or_a_path(history: Any) -> None:
    for file in (FOLDER / "entries").glob("*.json"):
        entry = json.loads(file.read_text(encoding="utf-8"))
        assert set(entry["machine"]) == {"processor", "cores", "python", "mujoco", "numpy"}
        assert not any("/" in str(value) for value in entry["machine"].values())


def test_the_page_of_speed_is_what_its_entries_and_figures_give(history: Any) -> None:
    page = sys.modules["page"]
    written = (FOLDER.parents[1] / "docs" / "speed.md").read_text(encoding="utf-8")
    assert written == page.page_text(page.read_entries()), "run python benchmarks/history page"

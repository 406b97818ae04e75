"""Store of a sweep's results: rows survive any end of the program."""

from __future__ import annotations

from pathlib import Path

import pytest

from simkit.errors import InputError
from simkit_learning.sweeps.result_store import ResultStore, block_size


def row(run: int) -> dict[str, object]:
    return {"run": run, "value": run / 3, "wall_time": 0.1}


def new_store(folder: Path, count: int = 200) -> ResultStore:
    store = ResultStore(folder)
    store.begin("f", count, {"parameters": [], "metrics": []})
    return store


def missing(store: ResultStore) -> list[int]:
    return [run for block in store.blocks for run in store.missing(block)]


def test_rows_in_any_order_are_read_in_the_order_of_the_runs(tmp_path: Path) -> None:
    store = new_store(tmp_path)
    for run in reversed(range(200)):
        store.add(row(run))
    assert [one["run"] for one in store.rows()] == list(range(200))
    assert [one["value"] for one in store.rows()] == [run / 3 for run in range(200)]
    assert not list((tmp_path / "rows").glob("*.log")) and missing(new_store(tmp_path)) == []


@pytest.mark.parametrize("torn", [b'{"run":7,"val', b'{"run":7,"value":2.3}', b"\x00" * 40, b'[]\n{"run":"x"}\n'])
def test_an_incomplete_last_line_is_repaired_and_its_run_repeated(tmp_path: Path, torn: bytes) -> None:
    store = new_store(tmp_path)
    for run in (0, 1, 2):
        store.add(row(run))
    store.close()
    log = tmp_path / "rows" / "000000.log"
    assert log.read_bytes().count(b"\n") == 3
    log.write_bytes(log.read_bytes() + torn)
    again = new_store(tmp_path)
    assert missing(again) == list(range(3, 200))
    for run in range(3, 200):
        again.add(row(run))
    assert [one["run"] for one in again.rows()] == list(range(200))


def test_a_kill_between_the_last_row_and_the_ordered_copy_loses_nothing(tmp_path: Path) -> None:
    store = new_store(tmp_path)
    for run in store.runs_of(0):
        store.add(row(run))
    ordered = tmp_path / "rows" / "000000.rows"
    log = ordered.with_suffix(".log")
    ordered.rename(log)  # as if killed before the copy was complete
    again = new_store(tmp_path)
    assert missing(again) == list(range(4, 200)) and ordered.exists() and not log.exists()
    log.write_bytes(ordered.read_bytes())  # as if killed between the copy and the removal of the log
    assert missing(new_store(tmp_path)) == list(range(4, 200))


def test_a_finished_run_is_not_stored_twice(tmp_path: Path) -> None:
    store = new_store(tmp_path)
    store.add(row(5))
    store.add(row(5))
    assert len(list(store.rows())) == 1
    store.close()


def test_a_folder_of_another_sweep_is_refused(tmp_path: Path) -> None:
    new_store(tmp_path)
    with pytest.raises(InputError, match="SK-SWEEP-003"):
        ResultStore(tmp_path).begin("other", 200, {})
    with pytest.raises(InputError, match="SK-SWEEP-008"):
        ResultStore(tmp_path / "none").open()


def test_blocks_are_small_enough_to_share_and_large_enough_for_a_million_runs() -> None:
    assert (block_size(1), block_size(200), block_size(10**4), block_size(10**6)) == (1, 4, 157, 10_000)

"""Reports of long tasks: nested, counted, estimated, and without an effect if nothing displays them."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit
from simkit import progress
from simkit.compiler.meshes import convex_decomposition
from simkit.progress import Task

WORLD = """<sdf version="1.9"><world name="w">{}</world></sdf>"""
BALL = """<model name="m{}"><pose>{} 0 1 0 0 0</pose><link name="l"><collision name="c"><geometry>
<sphere><radius>0.1</radius></sphere></geometry></collision></link></model>"""


class Listed:
    """Display that records when tasks begin and end."""

    def __init__(self) -> None:
        self.begun: list[Task] = []
        self.open: list[Task] = []
        self.depth = 0

    def begin(self, task: Task) -> None:
        self.begun.append(task)
        self.open.append(task)
        self.depth = max(self.depth, len(self.open))

    def end(self, task: Task) -> None:
        self.open.remove(task)


def test_loading_reports_reading_building_and_compiling_with_their_amounts() -> None:
    display = Listed()
    with progress.shown_on(display):
        simkit.load(WORLD.format("".join(BALL.format(i, i) for i in range(3)))).close()
    assert [task.title for task in display.begun] == [
        "reading the world",
        "building models",
        "creating sensors and plugins",
        "compiling 3 moving links",
        "loading plugins",
    ]
    assert [(task.done, task.total) for task in display.begun[1:3]] == [(3, 3), (3, 3)]
    assert display.begun[3].expected == pytest.approx(1.0, abs=1e-4) and not display.open


def test_a_display_is_removed_after_an_error() -> None:
    display = Listed()
    with progress.shown_on(display), pytest.raises(simkit.LoadError):
        simkit.load(WORLD.format("<model name='m'><link name='l'><inertial><mass>-1</mass></inertial></link></model>"))
    assert display.begun and not display.open
    with progress.task("later"):
        assert "later" not in [task.title for task in display.begun]


def test_the_innermost_task_names_the_file() -> None:
    progress.set_item("nothing happens without a task")
    with progress.task("outer") as outer:
        with progress.task("inner") as inner:
            progress.set_item("a.dae")
        progress.set_item("b.dae")
    assert (outer.item, inner.item) == ("b.dae", "a.dae")


def test_the_remaining_time_follows_from_the_finished_part() -> None:
    task = Task("t", total=10.0)
    assert task.seconds_left() is None
    task.begun, task.done = task.begun - 20.0, 4.0
    assert task.seconds_left() == pytest.approx(30.0, abs=0.5)
    task.expected = 25.0
    assert task.seconds_left() == pytest.approx(5.0, abs=0.5), "a time limit ends the task earlier"


def test_a_loop_reports_each_finished_item() -> None:
    display = Listed()
    with progress.shown_on(display):
        counts = [display.begun[0].done for _ in progress.report_each("copying", "abc", 3)]
    assert counts == [0, 1, 2] and display.begun[0].done == 3 and not display.open


def test_the_rounds_of_a_convex_decomposition_become_a_share() -> None:
    task = Task("decomposing", total=6.0)
    shares = []
    for line in ("iter 0 ---- waiting pool: 1", "Processing [50.0%]", "Processing [100.0%]", "iter 3 ---- x", "other"):
        convex_decomposition._read_progress(f"[CoACD] [info] {line}", task)
        shares.append(task.done)
    assert shares == [0.0, 0.5, 0.99, 3.0, 3.0]
    convex_decomposition._read_progress("iter 9 ---- waiting pool: 2", task)
    assert task.total == 9.0, "more rounds than expected"


@pytest.mark.slow
def test_a_decomposition_reports_its_triangles_and_its_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    trimesh, _ = pytest.importorskip("trimesh"), pytest.importorskip("coacd")
    monkeypatch.setenv("SIMKIT_CACHE_DIR", str(tmp_path / "cache"))
    corner = trimesh.util.concatenate(
        [
            trimesh.creation.box((0.31, 0.1, 0.1)),
            trimesh.creation.box((0.1, 0.1, 0.37)).apply_translation((0.1, 0, 0.2)),
        ]
    )
    corner.export(tmp_path / "corner.stl")
    mesh = "<mesh optimization='convex_decomposition'><uri>corner.stl</uri></mesh>"
    link = f"<link name='l'><collision name='c'><geometry>{mesh}</geometry></collision></link>"
    (tmp_path / "w.sdf").write_text(WORLD.format(f"<model name='m'>{link}</model>"))
    display = Listed()
    with progress.shown_on(display):
        simkit.load(tmp_path / "w.sdf").close()
    titles = {task.title: task for task in display.begun}
    assert titles["building models"].item == "corner.stl" and display.depth == 2
    assert titles["decomposing 24 triangles into convex pieces"].done > 0

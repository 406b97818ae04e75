"""`simkit demo`: examples that run the command line itself, complete or not at all."""

from __future__ import annotations

import json
import shlex
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from simkit.cli import demo as demo_module
from simkit.cli.demo import Step, demo_steps


def only(monkeypatch: pytest.MonkeyPatch, source: Path, *commands: Any) -> None:
    """Let the command have one step with other commands."""
    step = Step("small", source, 1, "One step.", commands, ["out.txt"], "simkit")
    monkeypatch.setattr(demo_module, "demo_steps", lambda: {"small": step})


@pytest.fixture
def source(tmp_path: Path) -> Path:
    folder = tmp_path / "source"
    folder.mkdir()
    (folder / "out.txt").write_text("one\ntwo two\n")
    return folder


@pytest.mark.needs_packs
def test_there_are_five_steps_in_order_and_each_has_commands_and_a_picture() -> None:
    steps = demo_steps()
    assert list(steps) == ["lidar", "arm", "drone", "golden", "page"]
    for step in steps.values():
        assert step.title.endswith(".") and step.show
        lines = [shlex.split(str(c if isinstance(c, str) else c.get("run", "simkit"))) for c in step.commands]
        assert all(line[0] == "simkit" for line in lines)
        assert all(any(picture in line for line in lines) for picture in step.pictures)


def test_a_step_does_its_edit_and_its_commands_and_reports_them(
    tmp_path: Path, source: Path, monkeypatch: pytest.MonkeyPatch, simkit_line: Callable[..., Any]
) -> None:
    only(monkeypatch, source, {"edit": "out.txt", "text": "two", "by": "three"}, "simkit --version")
    result = simkit_line("demo", "small", "-o", str(tmp_path / "new" / "folder"), "--json")
    report = json.loads(result.stdout)
    assert result.exit_code == report["exit_code"] == 0
    (step,) = report["steps"]
    assert step["commands"] == ["edit out.txt:2: two becomes three", "simkit --version"]
    assert step["lines"][0].startswith("simkit ")
    assert Path(step["pictures"][0]).read_text() == "one\nthree two\n"
    assert [path.name for path in (tmp_path / "new" / "folder").iterdir()] == ["small"]


def test_a_failed_command_leaves_no_files(
    tmp_path: Path, source: Path, monkeypatch: pytest.MonkeyPatch, simkit_line: Callable[..., Any]
) -> None:
    only(monkeypatch, source, "simkit explain SK-NO-001")
    result = simkit_line("demo", "-o", str(tmp_path / "new"))
    assert result.exit_code == 1
    assert "SK-CLI-063" in result.stderr and "SK-NO-001" in result.stderr
    assert not (tmp_path / "new").exists()


def test_an_existing_folder_and_an_unknown_step_are_errors(
    tmp_path: Path, source: Path, monkeypatch: pytest.MonkeyPatch, simkit_line: Callable[..., Any]
) -> None:
    only(monkeypatch, source, {"edit": "out.txt", "text": "one", "by": "1"})
    (tmp_path / "small").mkdir()
    result = simkit_line("demo", "-o", str(tmp_path))
    assert result.exit_code == 2 and "already exists" in result.stderr and "--force" in result.stderr
    assert simkit_line("demo", "-o", str(tmp_path), "--force").exit_code == 0
    unknown = simkit_line("demo", "smal", "-o", str(tmp_path))
    assert unknown.exit_code == 2 and "did you mean 'small'" in unknown.stderr


def test_a_step_of_a_missing_pack_gets_its_name(
    tmp_path: Path, source: Path, monkeypatch: pytest.MonkeyPatch, simkit_line: Callable[..., Any]
) -> None:
    only(monkeypatch, source, {"edit": "out.txt", "text": "one", "by": "1"})
    monkeypatch.setattr(demo_module, "left_out_names", lambda kind: {"sailing": "boats"})
    missing = simkit_line("demo", "sailing", "-o", str(tmp_path / "new"))
    assert missing.exit_code == 2 and "the step sailing needs the pack boats, which is not installed" in missing.stderr
    assert "pip install" in missing.stderr and not (tmp_path / "new").exists()
    rest = simkit_line("demo", "-o", str(tmp_path / "new"))
    assert rest.exit_code == 0 and "steps of packs that are not installed: sailing\n" in rest.stderr


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no such signals there")
def test_an_interrupt_leaves_no_files(tmp_path: Path) -> None:
    words = [sys.executable, "-P", "-m", "simkit", "demo", "golden", "-o", str(tmp_path / "new")]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path, text=True) as running:
        while not list(tmp_path.glob("new/.golden*/robot.sdf")):
            assert running.poll() is None
        running.send_signal(signal.SIGINT)
        assert running.wait(30) == 130
        assert running.stderr is not None and running.stderr.read() == "interrupted\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.needs_packs
@pytest.mark.parametrize("name", ["lidar", "arm", "drone", "golden", "page"])
def test_each_step_ends_with_its_pictures(name: str, tmp_path: Path, simkit_line: Callable[..., Any]) -> None:
    result = simkit_line("demo", name, "-o", str(tmp_path), "--json")
    assert result.exit_code == 0, result.stderr
    (step,) = json.loads(result.stdout)["steps"]
    assert step["lines"]
    assert all(Path(picture).stat().st_size > 20_000 for picture in step["pictures"])
    if name == "golden":
        assert "radius 0.033 → 0.0335 m" in step["lines"][0]

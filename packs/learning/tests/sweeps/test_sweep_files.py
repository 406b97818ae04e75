"""Files of sweeps: locks are regular files, and a file or folder of a stranger names no file elsewhere."""

from __future__ import annotations

import inspect
import json
import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from sweep_worlds import BOX
from typer.testing import CliRunner

import simkit
from simkit import LoadError, hidden_text
from simkit.cli import app
from simkit.errors import InputError
from simkit_learning.sweeps.design import SweepRow
from simkit_learning.sweeps.result_store import locked_blocks, make_folder
from simkit_learning.sweeps.row_runner import RowResult
from simkit_learning.sweeps.sweep_file import SWEEP_KEYS, read_sweep
from simkit_learning.sweeps.sweep_spec import SWEEP_OPTIONS, SweepOption

posix = pytest.mark.skipif(os.name == "nt", reason="named pipes of POSIX")


def _link(path: Path) -> None:
    (path.parent / "target").write_bytes(b"kept")
    path.symlink_to(path.parent / "target")


KINDS: dict[str, tuple[Callable[[Path], object], str]] = {
    "pipe": (lambda path: os.mkfifo(path), "it is a pipe"),
    "folder": (Path.mkdir, "it is a folder"),
    "link": (_link, "it is a symbolic link"),
    "link to a device": (lambda path: path.symlink_to("/dev/null"), "it is a symbolic link"),
    "link to nowhere": (lambda path: path.symlink_to(path.parent / "new"), "it is a symbolic link"),
}


@posix
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["folder.lock", "000000.lock"])
def test_the_locks_of_a_sweep_are_regular_files(tmp_path: Path, kind: str, name: str) -> None:
    (tmp_path / "locks").mkdir()
    KINDS[kind][0](tmp_path / "locks" / name)
    open_locks = make_folder if name == "folder.lock" else lambda folder: locked_blocks(folder, [0]).__enter__()
    with pytest.raises(InputError, match=rf"SK-CLI-016 .*{name}: {KINDS[kind][1]}"):
        open_locks(tmp_path)


@posix
@pytest.mark.parametrize("name", ["rows", "timings", "locks"])
def test_a_folder_of_a_sweep_does_not_lead_elsewhere(tmp_path: Path, name: str) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "sweep").mkdir()
    (tmp_path / "sweep" / name).symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match="symbolic link"):
        make_folder(tmp_path / "sweep")


@posix
def test_a_sweep_with_a_pipe_as_its_lock_ends_with_a_line(tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text('<sdf version="1.9"><world name="w"/></sdf>')
    (tmp_path / "sweep.yaml").write_text("world: w.sdf\nduration: 0.01\nseeds: 1\nmetrics: {t: time}\n")
    (tmp_path / "out/locks").mkdir(parents=True)
    os.mkfifo(tmp_path / "out/locks/000000.lock")
    result = subprocess.run(
        [sys.executable, "-m", "simkit", "sweep", "run", "sweep.yaml", "-o", "out", "--jobs", "1"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    assert result.returncode == 2 and "it is a pipe" in result.stderr, result.stdout + result.stderr


@pytest.mark.skipif(sys.platform in ("darwin", "win32"), reason="these systems have only names in Unicode")
def test_a_folder_whose_name_is_not_utf8_is_refused(tmp_path: Path) -> None:
    name = os.fsdecode(b"\xff")
    (folder := tmp_path / f"d{name}").mkdir()
    (folder / "w.sdf").write_text(BOX)
    (folder / "sweep.yaml").write_text(
        "world: w.sdf\nduration: 0.05\nparameters:\n  physics.max_step_size: [0.001, 0.002]\n"
    )
    arguments = [sys.executable, "-m", "simkit", "sweep", "run", "sweep.yaml", "-o", f"o{name}"]
    done = subprocess.run(arguments, cwd=folder, capture_output=True, timeout=120, check=False)
    said = (done.stdout + done.stderr).decode()  # the output itself is valid UTF-8
    assert done.returncode == 2 and "SK-CLI-057" in said and "Traceback" not in said, said[-800:]
    assert sorted(path.name for path in folder.iterdir()) == ["sweep.yaml", "w.sdf"]


# ---------------------------------------------------------------------- files of a stranger


def command(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["sweep", *map(str, words)], catch_exceptions=False)
    hidden_text._files.clear()
    return result.exit_code, result.output


@pytest.fixture
def stranger(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of a stranger beside private files; the working directory is another one."""
    for name in ("stranger", "private", "work"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "private" / "ball.sdf").write_text(BOX)
    (tmp_path / "stranger" / "ball.sdf").write_text(BOX)
    model = '<model name="box"><static>true</static><link name="l"/></model>'
    (tmp_path / "private" / "box.sdf").write_text(f'<sdf version="1.9">{model}</sdf>')
    (tmp_path / "private" / "list.csv").write_text("a.b\n1\n")
    monkeypatch.chdir(tmp_path / "work")
    return tmp_path / "stranger"


def test_a_sweep_reads_no_list_and_spawns_no_model_from_elsewhere(stranger: Path) -> None:
    file, private = stranger / "s.yaml", stranger.parent / "private"
    file.write_text("world: ball.sdf\nparameters: ../private/list.csv\n")
    with pytest.raises(LoadError) as caught:
        read_sweep(file)
    assert [(d.code, d.line, d.message.partition(":")[0]) for d in caught.value.diagnostics] == [
        ("SK-URI-003", 2, "parameters")
    ]
    file.write_text(
        f"world: ball.sdf\nduration: 0.1\nspawn: '{{m}}:0,0,0:other'\nparameters: {{m: [{private}/box.sdf]}}\n"
        "metrics: {a: time}\n"
    )
    spec = read_sweep(file)
    with pytest.raises(InputError, match=r"SK-URI-003 spawn\.0: .* is outside the folders of this file"):
        spec.row_spec(spec.design.row(0))
    code, said = command(file, "-o", stranger / "out", "--jobs", 1)
    assert code == 2 and "SK-URI-003" in said
    assert command(file, "-o", stranger / "out", "--jobs", 1, "--resource-path", private)[0] == 0


def test_the_results_of_a_sweep_name_no_file_elsewhere(stranger: Path) -> None:
    private = stranger.parent / "private"
    (private / "s.yaml").write_text("world: ball.sdf\nduration: 0.1\nsecret: 1\n")
    (stranger / "r" / "rows").mkdir(parents=True)
    description = {"format": 1, "count": 1, "block": 1, "file": str(private / "s.yaml"), "fingerprint": ""}
    (stranger / "r" / "sweep.json").write_text(json.dumps(description))
    code, said = command("replay", stranger / "r", 0)
    assert code == 2 and "SK-URI-003" in said and "--file SWEEP.yaml" in said and "secret" not in said
    assert "secret" in command("replay", stranger / "r", 0, "--resource-path", private)[1]


def test_a_row_of_results_can_be_pickled() -> None:
    row = RowResult(SweepRow(3, 1, {"a.b": 0.5}), {"m": 1.0}, message="text", state_hash="0" * 64)
    assert pickle.loads(pickle.dumps(row)) == row and len(pickle.dumps(row)) < 800


def test_the_options_of_a_sweep_have_one_description() -> None:
    parameters = inspect.signature(simkit.sweep).parameters
    page = (Path(__file__).parents[2] / "docs" / "sweeps.md").read_text(encoding="utf-8")
    for option in SWEEP_OPTIONS:
        assert parameters[option.name].default == option.default
    assert all(f"`{key}`" in page for key in SWEEP_KEYS)


@pytest.mark.parametrize("option", SWEEP_OPTIONS, ids=lambda option: option.name)
@pytest.mark.parametrize("value", [-1, True, 1.5, {}, "fialed"], ids=repr)
def test_a_wrong_option_is_an_error_in_python_and_in_a_file(
    option: SweepOption[object], value: object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    if option.allows(value):
        pytest.skip("a pattern of topics")
    with pytest.raises(InputError, match=f"SK-SWEEP-001 {option.name}: found"):
        simkit.sweep(BOX, {"physics.max_step_size": {"uniform": [0.001, 0.002]}}, **{"samples": 1, option.name: value})
    file = {"world": "w.sdf", "parameters": {"physics.max_step_size": [0.001]}, option.key: value}
    Path("sweep.yaml").write_text(json.dumps(file))
    with pytest.raises(LoadError) as raised:
        read_sweep("sweep.yaml")
    assert [d.code for d in raised.value.diagnostics][:1] == ["SK-SCEN-003"]

"""Tests for reading files that users name, and a check that every such file is opened in one place."""

from __future__ import annotations

import ast
import errno
import os
import select
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from simkit.input_file import FileTooLargeError, open_input, read_failure, read_input, read_input_text

ROOT = Path(__file__).resolve().parents[1]
FILES = sorted(
    path
    for path in (*ROOT.glob("simkit/**/*.py"), *ROOT.glob("packs/*/simkit_*/**/*.py"))
    if "packages" not in path.parts  # launch files
)
OWN_FILES = {
    "cli/bench_figures.py": "/proc/self/statm",
    "cli/demo.py": "data of the package, and its copy in a folder that simkit made",
    "cli/diagnostic_catalogue.py": "data of the package",
    "packs/view/simkit_view/view/page_server.py": "data of the package",
    "cli/commands.py": "modules of packs",
    "cli/scores/score_calculation.py": "a temporary file of simkit",
    "cli/scores/folder_search.py": "tables of packs",
    "compiler/meshes/parallel_conversion.py": "a temporary file of simkit",
    "mujoco_import.py": "the list of files that pip has installed",
    "moved_modules.py": "data of a shipped pack",
    "msgs/shipped_interfaces.py": "data of the package",
    "packs.py": "entry points that pip has installed",
    "packs/authoring/simkit_authoring/plugin_reload.py": "modules that Python has imported already",
    "packs/identification/simkit_identification/result_texts.py": "templates of the pack",
    "packs/nodes/simkit_nodes/private_packages.py": "modules that pip has installed",
    "packs/ros/simkit_ros/type_support.py": "/proc/self/maps",
    "registry.py": "modules of the package",
    "sensors/presets/preset.py": "data of the package",
    "sensors/realism/datasheet.py": "data of the package",
    "packs/verification/simkit_verification/testing/bundles/bundle_writer.py": "a temporary folder of simkit",
    "packs/verification/simkit_verification/testing/certify/certification.py": "a temporary file of simkit",
    "packs/verification/simkit_verification/testing/certify/outcome.py": "a temporary file of simkit",
    "testing/run_record/fingerprint.py": "modules of the package",
    "packs/verification/simkit_verification/testing/grading/callback_limit.py": "a stack, and times in /proc",
    "packs/verification/simkit_verification/testing/grading/grading_process.py": "a temporary file of simkit",
    "packs/verification/simkit_verification/testing/grading/judge_process.py": "a temporary file of simkit",
    "packs/launch/simkit_launch/planner.py": "`open` of a launch file, which runs with the rights of the user",
    "packs/launch/simkit_launch/simulator_worlds.py": "the beginning of a file",
    "packs/launch/simkit_launch/temporary_files.py": "temporary files of simkit and of a launch file",
    "packs/nodes/simkit_nodes/known_nodes.py": "tables of packs",
    "packs/nodes/simkit_nodes/ros_modules/__init__.py": "tables of packs",
    "writers/mjcf.py": "assets that the loader has read already",
}
"""Files of the package that read without `simkit.input_file`, and what they read."""


def _reads_directly(call: ast.Call) -> bool:
    """Check whether a call opens a file to read it, except data of the package (`Path(__file__)`, a constant)."""
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    if name not in ("open", "read_text", "read_bytes"):
        return False
    text = ast.unparse(call)
    if "__file__" in text or "devnull" in text or text.lstrip("_").split(".")[0].isupper():
        return False
    if name == "open":
        return text.endswith(("'r')", "'rb')")) or (isinstance(call.func, ast.Name) and "'w" not in text)
    return True


def _direct_reads(file: Path) -> list[int]:
    text = file.read_text(encoding="utf-8")
    if not any(name in text for name in ("open", "read_text", "read_bytes")):  # to parse all files takes seconds
        return []
    tree = ast.parse(text)
    return [node.lineno for node in ast.walk(tree) if isinstance(node, ast.Call) and _reads_directly(node)]


def test_only_the_listed_files_read_without_the_checks_of_input_file() -> None:
    readers = {p.relative_to(ROOT).as_posix().removeprefix("simkit/"): _direct_reads(p) for p in FILES}
    direct = {name: lines for name, lines in readers.items() if lines and name != "input_file.py"}
    assert {n: lines for n, lines in direct.items() if n not in OWN_FILES} == {}
    assert set(OWN_FILES) - set(direct) == set()


@pytest.fixture
def pipe(tmp_path: Path) -> Path:
    """A named pipe that nobody writes to."""
    if not hasattr(os, "mkfifo"):
        pytest.skip("this system has no named pipes")
    path = tmp_path / "pipe"
    os.mkfifo(path)
    return path


@pytest.fixture
def sparse(tmp_path: Path) -> Path:
    """A file of 30 GB without content on the disk."""
    path = tmp_path / "sparse"
    with path.open("wb") as file:
        try:
            file.truncate(30 << 30)
        except OSError:
            pytest.skip("this file system has no sparse files")
    return path


def test_a_named_pipe_is_refused_at_once(pipe: Path) -> None:
    for read in (open_input, lambda path: read_input(path, 100), read_input_text):
        with pytest.raises(OSError, match="it is a pipe, not a regular file"):
            read(pipe)


def test_a_named_pipe_is_read_where_it_is_allowed(pipe: Path) -> None:
    writer = threading.Thread(target=lambda: pipe.write_bytes(b"x" * 50))
    writer.start()
    assert read_input(pipe, 100, allow_pipe=True) == b"x" * 50
    writer.join()


def test_the_pipe_of_a_shell_is_read() -> None:
    reader, writer = os.pipe()
    os.write(writer, b"- {at: 1}")
    os.close(writer)
    assert read_input_text(f"/dev/fd/{reader}") == "- {at: 1}"
    os.close(reader)


def test_a_device_and_a_folder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="it is a device"):
        read_input("/dev/zero", 100)
    with pytest.raises(IsADirectoryError):
        read_input(tmp_path, 100)


def test_a_sparse_file_is_refused_before_it_is_read(sparse: Path) -> None:
    with pytest.raises(FileTooLargeError, match="it is larger than 8 MiB") as raised:
        read_input_text(sparse)
    assert raised.value.errno == errno.EFBIG


def test_a_limit_counts_the_last_byte(tmp_path: Path) -> None:
    file = tmp_path / "five"
    file.write_bytes(b"12345")
    assert read_input(file, 5) == b"12345"
    with pytest.raises(FileTooLargeError, match="it is larger than 4 bytes"):
        read_input(file, 4)


def test_the_reason_names_a_byte_that_is_not_utf_8(tmp_path: Path) -> None:
    file = tmp_path / "latin"
    file.write_bytes(b"caf\xe9")
    with pytest.raises(UnicodeDecodeError) as raised:
        read_input_text(file)
    assert read_failure(raised.value) == "it is not UTF-8 text (byte 3)"


def test_line_ends_of_windows_are_line_feeds(tmp_path: Path) -> None:
    file = tmp_path / "windows"
    file.write_bytes(b"a\r\nb\r")
    assert read_input_text(file) == "a\nb\n"


def test_an_impossible_name_is_an_os_error() -> None:
    with pytest.raises(OSError, match="the name has a zero byte"):
        read_input("a\0b", 10)


COMMANDS = {
    "script": "run empty --duration 0.01 --script {0}",
    "parameters of a run": "run empty --duration 0.01 --params-file {0}",
    "scenario": "golden record {0} --out {1}",
    "exercise": "grade {0} {0}",
    "golden data": "golden check {0}",
    "bundle": "replay {0}",
    "bag": "bag info {0}.mcap",
    "bag export": "bag export {0}.mcap --output {1}",
    "playback": "run empty --duration 0.01 --play {0}.mcap",
    "parameters of a node": "param load /x {0}",
}


@pytest.mark.parametrize("kind", ["pipe", "sparse", "device"])
@pytest.mark.parametrize("arguments", COMMANDS.values(), ids=COMMANDS.keys())
def test_a_command_refuses_what_is_no_regular_file(
    arguments: str, kind: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    bad = Path("/dev/zero") if kind == "device" else Path(request.getfixturevalue(kind))
    file = tmp_path / "file.yaml"
    file.symlink_to(bad)
    Path(f"{file}.mcap").symlink_to(bad)
    done = subprocess.run(
        [sys.executable, "-m", "simkit", *arguments.format(file, tmp_path / "out").split()],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 2, done.stderr
    assert "Traceback" not in done.stderr
    assert "SK-" in done.stderr


@pytest.mark.parametrize(
    ("name", "command"), [("golden.json", "golden check {0}"), ("metadata.yaml", "bag info {0}")], ids=str
)
def test_a_command_refuses_a_pipe_in_a_folder(name: str, command: str, pipe: Path, tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    pipe.rename(folder / name)
    (folder / "run.mcap").write_bytes(b"")
    arguments = [sys.executable, "-m", "simkit", *command.format(folder).split()]
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=60)
    assert (done.returncode, "Traceback" in done.stderr) == (2, False), done.stderr


@pytest.mark.skipif(not os.access("/proc/kmsg", os.R_OK), reason="only the administrator of a Linux system reads it")
def test_a_file_that_has_no_content_yet_is_refused() -> None:
    with open("/proc/kmsg", "rb") as messages:
        if select.select([messages], [], [], 0)[0]:
            pytest.skip("the kernel has written a message that nobody has read")
    with pytest.raises(OSError, match="unavailable"):
        open_input("/proc/kmsg")

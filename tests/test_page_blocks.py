"""Every Python block of every page runs when it is pasted alone; the shell commands of a page run in their order."""

from __future__ import annotations

import faulthandler
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Final, NamedTuple

import pytest

from tests.cli.terminals import Terminal
from tests.page_blocks import ROOT, Block, blocks, page_name, pages, write_files

PYTHON: Final = [
    pytest.param(page, block, id=f"{page_name(page)}:{block.line}")
    for page in pages()
    for block in blocks(page, "python")
    if not block.title  # a program for ROS, which another test runs
]
SHELL: Final = ("sh", "bash", "prompt")

# Pages whose commands another test runs, among them all pages with several terminals (`console`).
OTHER_TESTS: Final = {
    "docs/adding_a_format.md": "tests/test_adding_pages.py",
    "docs/adding_a_plugin.md": "tests/test_adding_pages.py",
    "docs/adding_a_sensor.md": "tests/test_adding_pages.py",
    "docs/ci.md": "tests/examples/test_ci_page.py",
    "docs/commands/demo.md": "tests/cli/test_demo.py",
    "docs/commands/doctor.md": "tests/cli/test_commands.py",
    "docs/cours.md": "tests/labs/test_course_page.py",
    "docs/course.md": "tests/labs/test_course_page.py",
    "docs/course/ros2_graph.md": "tests/cli/course_page.py",
    "packs/verification/docs/certify.md": "packs/verification/tests/test_certify_page.py",
    "docs/golden.md": "tests/examples/test_golden_page.py",
    "labs/02_interfaces/README.fr.md": "tests/labs/test_languages.py",
    "labs/02_interfaces/README.md": "tests/labs/test_02_interfaces.py",
    "labs/03_gazebo/README.fr.md": "tests/labs/test_languages.py",
    "labs/03_gazebo/README.md": "tests/labs/test_03_gazebo.py",
    "packs/launch/docs/course_launch.md": "packs/launch/tests/test_course_page.py",
    "packs/nodes/docs/course_ros1.md": "packs/nodes/tests/processes/test_course_pages.py",
    "packs/nodes/docs/course_ros2.md": "packs/nodes/tests/processes/test_course_pages.py",
    "packs/terminal/docs/terminal.md": "packs/terminal/tests/test_terminal_page.py",
}


class LeftOut(NamedTuple):
    """Reason why a test cannot run the commands of a pattern, and the number of these commands on all pages."""

    reason: str
    number: int


LEFT_OUT: Final = {
    r"pip (un)?install|git clone|podman|-m venv |simkit fetch|simkit fleet": LeftOut("network", 32),
    r"articubot_one/|vectored|pal\b|tiago_gazebo|go2_desc|burger\.urdf|depot\.sdf|~/|baxter_sim": LeftOut(
        "robots of public repositories", 15
    ),
    r"base\.yaml|controllers\.yaml|bow|arena\.wo|\.sdf --score|my_robots|finger\.urdf|harbour|map_saver/|-v 4": LeftOut(
        "worlds and robots that the page does not show", 11
    ),
    r"pytest -n auto|-m pytest|ruff|\.ci/|golden/sensor_bench|lab (?:start|grade)|carry\.py|^cd |> docs/"
    r"|grade leave\.yaml (hand_ins/)?wander\.py": LeftOut("other tests run it, or it changes the repository", 81),
    r"^ros2 |^simkit ros$|--ros(?: |$)": LeftOut("ROS 2", 7),
    r"ray start|--cluster|SLURM": LeftOut("a cluster", 3),
    r"contact-nets|--quick|benchmarks/history|train_turtlebot3|toss1": LeftOut("hours, or data of a real cube", 3),
}
SHORTER: Final = {
    "samples: 64": "samples: 3", "duration: 10\n": "duration: 4\n", "--trials 200": "--trials 2",
    "--duration 10 --video": "--duration 0.1 --video", "--duration 10 --gif": "--duration 0.2 --gif",
    "--duration 10 --record drive.mcap --skip": "--duration 0.1 --record drive.mcap --skip",
    "sensor_bench --duration 5": "sensor_bench --duration 1", "--duration 36 --picture": "--duration 1 --picture",
    "bench turtlebot3_world": "bench turtlebot3_world --rounds 1",
    ".venv/bin/simkit golden check golden": ".venv/bin/simkit golden check golden/drive",  # CI checks the others
    "hits --steps 1,0.25": "hits --steps 4 --quick", "stepping.py": "stepping.py --rounds 1",
    "--rounds 20": "--rounds 1", "--jobs 8": "--jobs 2", "motion play wave home": "motion play home",
    "certify turtlebot3_world": "certify turtlebot3_world --runs 2",
    "--foxglove --rosbridge": "--foxglove 0 --rosbridge 0",  # free ports: other programs may use 8765 and 9090
}  # fmt: skip
LONGEST: Final = 3.0  # [s] of simulated time
LIMIT: Final = 900.0  # [s] of wall time for a command: a busy machine needs ten times the time of a free one
IN_CLONE: Final = re.compile(r"(?<!\S)(?:\.venv|benchmarks|examples|packs|tests|worlds)/")
WRITES_FILES: Final = re.compile(r"write_text\(|Recorder\(")
UNTIL_INTERRUPT: Final = re.compile(
    r"simkit (?:(?:run|view|launch)\b(?:(?!.* --(?:duration|until|html|play)\b)|.* --(?:web|rtf)\b)"
    r"|(?:bag record|node run)\b(?!.* --duration)|topic (?:pub|echo)\b(?!.* (?:--once|-1|-t|--bag)\b))"
)
WORLD: Final = re.compile(r"simkit (?:run|view|launch)\b")


def commands(block: Block) -> Iterator[tuple[str, str, list[str]]]:
    """Yield the commands of a block, their comments, and the lines of their output that the block shows."""
    lines = block.text.replace("\\\n", " ").splitlines()
    is_command = [line.startswith("$ ") or block.language != "prompt" for line in lines]
    starts = [number for number, starts in enumerate(is_command) if starts]
    for start, end in zip(starts, [*starts[1:], len(lines)], strict=True):
        command, _, comment = lines[start].removeprefix("$ ").partition(" #")
        if command and not command.startswith("#"):
            yield re.sub(" +", " ", command).strip(), comment.strip(), lines[start + 1 : end]


def pattern_of(command: str) -> str:
    """Return the pattern of a command that a test cannot run; empty if a test can."""
    return next((pattern for pattern in LEFT_OUT if re.search(pattern, command)), "")


def shorter(text: str) -> str:
    """Return a command or a file with fewer or shorter runs, or with free ports."""
    for long, short in SHORTER.items():
        text = text.replace(long, short)
    return text


def shell_pages() -> dict[str, Path]:
    """Return the pages with commands that a test can run."""
    return {
        page_name(page): page
        for page in pages()
        if page_name(page) not in OTHER_TESTS
        and not page.name.endswith(".fr.md")  # tests/labs/test_languages.py compares it with the English page
        and any(not pattern_of(command) for block in blocks(page, *SHELL) for command, *_ in commands(block))
    }


class Reader:
    """Reader of a page, who pastes its blocks one after the other.

    A command that only an interrupt ends runs in a terminal of its own until the page ends, or until the next
    such command of the same program.

    Args:
        folder: folder of the reader.
        programs: folder for the commands `simkit`, `python` and `pytest`, which come first on the search path.
        stack: owner of the terminals.
    """

    def __init__(self, folder: Path, programs: Path, stack: ExitStack) -> None:
        self._folder, self._stack = folder, stack
        self._output = ""
        self._running: dict[str, Terminal] = {}
        for name, module in (("simkit", " -m simkit"), ("python", ""), ("pytest", " -m pytest")):
            (programs / name).write_text(f'#!/bin/sh\nexec "{sys.executable}"{module} "$@"\n', encoding="utf-8")
            (programs / name).chmod(0o755)
        path = f"{programs}{os.pathsep}{os.environ['PATH']}"
        self._environment = {"PATH": path, "PYTHONPATH": str(ROOT), "BROWSER": "true"}

    def paste(self, block: Block) -> None:
        """Run the commands of a block, each of which ends with exit code 0 or with the code in its comment.

        The lines that the block shows below a command, and those of a block of text after the commands, are lines of
        the output; `…` is any text.
        """
        if block.language == "text":
            self._compare(block.text.splitlines() if self._output else [])
            return
        self._output = ""
        if block.language == "python":
            run_python(block, self._folder)
            return
        for command, comment, shown in commands(block):
            if pattern_of(command):
                continue
            command = shorter(command)
            if WORLD.search(command) or UNTIL_INTERRUPT.search(command):
                self._end_of(command)
            if UNTIL_INTERRUPT.search(command):
                self._begin(command)
                continue
            if not shown:
                command = re.sub(
                    r"--duration (\S+)", lambda found: f"--duration {min(float(found[1]), LONGEST)}", command
                )
            output, code = self._run(command)
            self._output += output
            codes = {0, *map(int, re.findall(r"exit code (\d+)", comment))}
            assert code in codes, f"line {block.line}: $ {command}\n{output}\nexit code {code}"
            self._compare(shown)

    def _run(self, command: str) -> tuple[str, int]:
        """Run a command to its end; return its output and its exit code."""
        with tempfile.TemporaryFile("w+", encoding="utf-8") as output:
            process = subprocess.Popen(
                ["bash", "-c", command], cwd=self._folder, env={**os.environ, **self._environment},
                stdin=subprocess.DEVNULL, stdout=output, stderr=output,
            )  # fmt: skip
            self._wait_for(process)
            output.seek(0)
            return output.read(), process.returncode

    def _wait_for(self, process: subprocess.Popen[bytes]) -> None:
        """Wait for the end of a process, and read what the terminals show: a program that nobody reads waits."""
        end = time.monotonic() + LIMIT
        while process.poll() is None:
            for terminal in self._running.values():
                terminal.read(0.02)
            time.sleep(0.02)
            if time.monotonic() > end:
                process.kill()

    def _compare(self, lines: list[str]) -> None:
        output = re.sub(" +", " ", self._output)  # columns are as wide as the lines that a page shows
        for line in lines:
            line = re.sub(" +", " ", line)
            pattern = "[^\n]*".join(map(re.escape, line.split("…")))
            assert re.search(f"^{pattern}$", output, re.MULTILINE), f"{line}\nis not in\n{self._output}"

    def _begin(self, command: str) -> None:
        terminal = Terminal("bash", "-c", command, cwd=self._folder, size=(40, 160), environment=self._environment)
        self._running[program_of(command)] = self._stack.enter_context(terminal)
        started = r"http://" if "simkit view" in command else r"t = [1-9]|paused" if WORLD.search(command) else r"\n"
        assert "error" not in terminal.wait_for(rf"{started}|error.*\n.*")[0]

    def _end_of(self, command: str) -> None:
        if terminal := self._running.get(program_of(command)):
            terminal.press("\x03")
            self._wait_for(terminal.process)
            del self._running[program_of(command)]
            assert terminal.wait() in (0, 130, -signal.SIGINT), terminal.seen  # a shell says 130 for both

    def end(self) -> None:
        """Interrupt the commands that still run, the world last."""
        for program in sorted(self._running, key="run".__eq__):
            self._end_of(f"simkit {program}")


def program_of(command: str) -> str:
    """Return the command of simkit; `run` for all that show a world."""
    words = command.partition("simkit ")[2].split()
    return "run" if WORLD.search(command) else " ".join(words[:2])


def run_python(block: Block, folder: Path) -> None:
    """Run a block as a program in a folder; a traceback shows the line of the page."""
    script = folder / "pasted.py"
    script.write_text("\n" * (block.line - 1) + block.text, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, script.name], cwd=folder, env=environment, capture_output=True, text=True, timeout=LIMIT
    )
    assert done.returncode == 0, f"block at line {block.line}\n{done.stderr}"


def copy_clone(folder: Path, programs: Path) -> None:
    """Copy the folders of this repository, with the programs as its virtual environment."""
    ignored = shutil.ignore_patterns("node_modules", "__pycache__", ".*_cache")
    for name in ("assets", "benchmarks", "examples", "golden", "packs", "simkit", "worlds"):
        shutil.copytree(ROOT / name, folder / name, ignore=ignored, dirs_exist_ok=True)
    (folder / ".venv").mkdir()
    (folder / ".venv" / "bin").symlink_to(programs)


@pytest.mark.slow
@pytest.mark.parametrize(("page", "block"), PYTHON)
def test_a_block_runs_alone(page: Path, block: Block, tmp_path: Path) -> None:
    faulthandler.cancel_dump_traceback_later()
    run_python(block, tmp_path)


@pytest.mark.slow
@pytest.mark.needs_packs
@pytest.mark.parametrize("page", shell_pages().values(), ids=shell_pages())
def test_the_commands_of_a_page_run(page: Path, tmp_path: Path) -> None:
    faulthandler.cancel_dump_traceback_later()  # each command has a limit of its own
    programs, folder = tmp_path / "programs", tmp_path / "folder"
    programs.mkdir()
    parts = blocks(page, *SHELL, "python", "text")
    while parts[-1].language == "python":  # files of programs that no command uses
        parts.pop()
    write_files(page, folder)
    if page.name == "README.md" and "examples" in page.parts:
        shutil.copytree(page.parent, folder, dirs_exist_ok=True)
    elif any(IN_CLONE.search(part.text) for part in parts if part.language in SHELL):
        copy_clone(folder, programs)
    for file in folder.glob("*.yaml"):
        file.write_text(shorter(file.read_text("utf-8")), encoding="utf-8")
    with ExitStack() as stack:
        reader = Reader(folder, programs, stack)
        for part in parts:
            if part.language in (*SHELL, "text") or (not part.title and WRITES_FILES.search(part.text)):
                reader.paste(part)
        reader.end()


def test_no_more_commands_are_left_out_than_are_stated() -> None:
    left_out = Counter(
        pattern_of(command)
        for page in pages()
        if page_name(page) not in OTHER_TESTS
        for block in blocks(page, *SHELL)
        for command, *_ in commands(block)
    )
    del left_out[""]
    grown = {
        LEFT_OUT[pattern].reason: number for pattern, number in left_out.items() if number > LEFT_OUT[pattern].number
    }
    assert not grown, "let a test run the new commands, or state the larger number"


def test_another_test_reads_each_page_that_is_left_to_it() -> None:
    for page, test in OTHER_TESTS.items():
        assert Path(page).stem.removesuffix(".fr") in (ROOT / test).read_text("utf-8"), page
    assert {page_name(page) for page in pages() if blocks(page, "console")} <= OTHER_TESTS.keys()

"""The course's page about the ROS 2 graph, worked through: its files are written, each of its terminals is a shell.

On the page, `…` is any text, or any lines where it is alone on a line. A number with a decimal point is any such
number; whole numbers are what they are. The exit code of a command is 0, unless the page asks for it or presses Ctrl-C.
"""

from __future__ import annotations

import os
import re
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Final, NamedTuple

from tests.cli.terminals import Terminal

ROOT: Final = Path(__file__).resolve().parents[2]
PAGE: Final = ROOT / "docs" / "course" / "ros2_graph.md"
TEXT: Final = PAGE.read_text(encoding="utf-8")
WITHOUT_ROS, _, WITH_ROS = TEXT.partition("## The same graph in ROS 2")
DECIMAL: Final = re.compile(r"-?\d+\.\d+(?:e[-+]?\d+)?")
MORE: Final = r"(?:[^\n]*\n)*?"
PROMPT: Final = r"\[(\d+)\]\$ "


class Block(NamedTuple):
    """A file of the page, or what a terminal shows."""

    kind: str
    title: str
    text: str
    paragraph: str


def blocks(text: str) -> list[Block]:
    """The blocks with a title, in the order of the page."""
    found = re.finditer(r'((?:[^\n]+\n)*)\n```(\w+) title="([^"]+)"\n(.*?)^```$', text, re.MULTILINE | re.DOTALL)
    return [Block(match[2], match[3], match[4], match[1].replace("\n", " ").strip()) for match in found]


def pattern_of(expected: str, *, after_more: bool = False) -> str:
    """The regular expression of an output on the page; with `after_more`, omitted lines may come before it."""
    found = rf"\A{MORE}" if after_more else r"\A"
    for line in expected.splitlines():
        if line == "…":
            found += MORE
            continue
        pieces = [DECIMAL.split(piece) for piece in line.split("…")]
        found += r"[^\n]*".join(DECIMAL.pattern.join(map(re.escape, piece)) for piece in pieces) + r"\n"
    return found


class Shell:
    """A terminal of the page: a shell, whose prompt has the exit code of the last command."""

    def __init__(self, terminal: Terminal) -> None:
        self._terminal = terminal
        self._is_busy = self._is_interrupted = self._may_show_more = False
        terminal.wait_for(PROMPT)
        terminal.press("stty -onlcr\n")  # line ends as on the page
        terminal.wait_for(PROMPT)

    def play(self, text: str) -> None:
        """Type the commands and press the keys of a block, and compare what the terminal shows."""
        for part in re.split(r"(?=^\$ |^\^C$)|(?<=^\^C\n)", text, flags=re.MULTILINE):
            if part == "^C\n":
                self._interrupt()
                continue
            if part.startswith("$ "):
                command, _, part = part[2:].partition("\n")
                self.finish(is_code_shown=command == "echo $?")
                self._terminal.press(command + "\n")
                self._terminal.wait_for(rf"\A{re.escape(command)}\n")
                self._is_busy, self._is_interrupted, self._may_show_more = True, False, False
            if part:  # lines omitted at the end of a block may be written after the block was read
                self._terminal.wait_for(pattern_of(part, after_more=self._may_show_more))
                self._may_show_more = part.endswith("…\n")

    def finish(self, *, is_code_shown: bool = False) -> None:
        """Wait for the end of a command, which shows no more than the page does."""
        if self._is_busy:
            more = MORE if self._may_show_more else r"\n?"
            code = self._terminal.wait_for(rf"\A{more}{PROMPT}")[1]
            assert is_code_shown or code == "0" or (self._is_interrupted and code == "130")
            self._is_busy = False

    def _interrupt(self) -> None:
        self._terminal.press("\x03")
        self._terminal.wait_for(rf"\A{MORE if self._may_show_more else ''}\^C\n?")
        self._is_interrupted = True


class Desk:
    """The folder and the terminals of somebody who works through the page."""

    def __init__(self, folder: Path, stack: ExitStack, environment: dict[str, str]) -> None:
        self._folder, self._stack, self._shells = folder, stack, dict[str, Shell]()
        programs = folder / ".bin"
        programs.mkdir()
        for name, module in (("simkit", "-m simkit "), ("python3", "")):
            (programs / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {module}"$@"\n', encoding="utf-8")
            (programs / name).chmod(0o755)
        path = {"PATH": f"{programs}{os.pathsep}{os.environ['PATH']}", "PYTHONPATH": str(ROOT)}
        self._environment = {**path, "PS1": "[$?]$ ", "TERM": "dumb", "ENV": "", **environment}

    def play(self, text: str, *, only_files: bool = False) -> None:
        """Write the files of a text of the page, and do what its terminals do."""
        for block in blocks(text):
            if block.kind != "console":
                path = self._folder / block.title
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(block.text, encoding="utf-8")
            elif not only_files:
                self._shell(block.title).play(block.text)

    def _shell(self, title: str) -> Shell:
        if title not in self._shells:
            terminal = Terminal("sh", "-i", cwd=self._folder, size=(50, 200), environment=self._environment)
            self._shells[title] = Shell(self._stack.enter_context(terminal))
        return self._shells[title]

    def finish(self) -> None:
        """Wait for the end of all commands."""
        for shell in self._shells.values():
            shell.finish()

"""The page about the commands of another terminal: everything on it is run, against the worlds that it names."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import pytest

PAGE = Path(__file__).resolve().parents[1] / "docs" / "terminal.md"
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def sessions() -> list[tuple[str, list[tuple[str, str]]]]:
    """Return each world with its commands and their outputs."""
    found = []
    for part in PAGE.read_text(encoding="utf-8").split("<!-- run: ")[1:]:
        steps = []
        for block in re.findall(r"```console\n(.*?)```", part, re.DOTALL):
            for step in re.split(r"^(?=\$ )", block, flags=re.MULTILINE)[1:]:
                line, _, output = step.partition("\n")
                steps.append((line[2:], output))
        found.append((part.split(" -->")[0], steps))
    return found


def fits(expected: str, printed: str) -> bool:
    """Whether the output is as on the page: `…` is anything, alone on a line any lines; a number is any number."""
    pattern = ""
    for line in expected.splitlines():
        if line.strip() == "…":
            pattern += r"(?:[^\n]*\n)*?"
            continue
        pieces = []
        for piece in line.split("…"):
            last, text = 0, ""
            for number in NUMBER.finditer(piece):
                text += re.escape(piece[last : number.start()]) + NUMBER.pattern
                last = number.end()
            pieces.append(text + re.escape(piece[last:]))
        inside = re.sub(
            r"(?<=\S)(?:\\ )+", lambda _: r"\ +", r"[^\n]*".join(pieces)
        )  # columns are as wide as their numbers
        pattern += inside + r"\n"
    return re.fullmatch(pattern, printed) is not None


@pytest.mark.slow
@pytest.mark.parametrize(("world", "steps"), sessions(), ids=[world for world, _ in sessions()])
def test_the_commands_of_the_page_work(
    world: str,
    steps: list[tuple[str, str]],
    start: Any,
    simkit_line: Any,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    monkeypatch.chdir(tmp_path)
    start(world, world=world)
    for line, output in steps:
        result = simkit_line(*shlex.split(line)[1:])
        assert fits(output, result.stdout + result.stderr), f"$ {line}\n{result.stdout}{result.stderr}"
        assert result.exit_code == 0

"""The page about bags does what it says: its commands, one after the other, and its Python."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import pytest

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "bags.md").read_text(encoding="utf-8")
STATE = re.compile(r"^state ([0-9a-f]{64})$", re.MULTILINE)


@pytest.mark.slow
def test_the_page_works_from_its_beginning_to_its_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, simkit_line: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```sh\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    assert len(lines) == 8
    states = []
    for line in lines:
        words = shlex.split(line)
        assert words[0] == "simkit"
        done = simkit_line(*words[1:])
        assert done.exit_code == 0, (line, done.stderr)
        states += STATE.findall(done.stdout)
    assert len(states) == 3 and len(set(states)) == 1, "the run that is played is the one that was recorded"
    for name in ("drive.svg", "path.png", "both.svg", "drive/index.json", "drive/odom.csv"):
        assert (tmp_path / name).stat().st_size > 300
    (program,) = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    exec(compile(program, "bags.md", "exec"), {})

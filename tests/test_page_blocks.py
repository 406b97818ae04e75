"""Every Python block of every page runs when it is pasted alone into a new file in an empty folder."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *ROOT.glob("docs/**/*.md"), *ROOT.glob("examples/**/*.md")]
PAGES += (page for page in ROOT.glob("packs/**/*.md") if "node_modules" not in page.parts)


def blocks(page: Path) -> list[tuple[int, str]]:
    """Return the Python blocks of a page with their line numbers."""
    text = page.read_text(encoding="utf-8")
    found = re.finditer(r"^```python\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)
    return [(text[: match.start()].count("\n") + 2, match[1]) for match in found]


BLOCKS = [
    pytest.param(page, line, code, id=f"{page.relative_to(ROOT)}:{line}")
    for page in sorted(PAGES)
    for line, code in blocks(page)
]


@pytest.mark.slow
@pytest.mark.parametrize(("page", "line", "code"), BLOCKS)
def test_a_block_runs_alone(page: Path, line: int, code: str, tmp_path: Path) -> None:
    script = tmp_path / "pasted.py"
    script.write_text("\n" * (line - 1) + code, encoding="utf-8")  # a traceback shows the line of the page
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, script.name], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, f"{page.relative_to(ROOT)}, block at line {line}\n{done.stderr}"

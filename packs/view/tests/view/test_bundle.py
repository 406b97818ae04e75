"""The page in the wheel is what its sources give."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from simkit_view.view.page_server import PAGE

SOURCES = Path(__file__).parents[2] / "view_page"


def test_the_page_is_what_its_sources_give(tmp_path: Path) -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("there is no node; install Node.js 20 or newer")
    if not (SOURCES / "node_modules" / "esbuild").is_dir():
        pytest.skip("the page's packages are missing; run `npm ci` in view_page")
    subprocess.run([node, "build.mjs", str(tmp_path)], cwd=SOURCES, check=True, timeout=120)
    built = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert built == {path.name: path.read_bytes() for path in PAGE.iterdir()}

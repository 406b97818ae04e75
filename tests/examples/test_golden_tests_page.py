"""The tests of docs/testing_with_golden.md: written as they stand there, they pass once their golden runs are there."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def pytest_says(folder: Path, *arguments: str) -> str:
    alone = ["-p", "simkit.pytest_plugin", "-p", "no:cacheprovider", "-q", "--rootdir", str(folder), "-c", os.devnull]
    environment = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", "PYTHONPATH": str(ROOT), "COLUMNS": "120"}
    command = [sys.executable, "-m", "pytest", *alone, *arguments]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


@pytest.mark.slow
def test_every_test_of_the_page_passes_once_its_golden_run_is_written(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "testing_with_golden.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    count = sum(block.count("def test_") for block in blocks)
    (tmp_path / "test_robot.py").write_text("\n\n".join(blocks))
    assert f"{count} failed" in pytest_says(tmp_path)
    assert f"{count} passed" in pytest_says(tmp_path, "--simkit-update-golden")
    assert f"{count} passed" in pytest_says(tmp_path)
    assert (tmp_path / "golden/test_robot/test_scan_unchanged/golden.json").is_file()


def test_every_option_of_the_page_is_one(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "testing_with_golden.md").read_text(encoding="utf-8")
    options = set(re.findall(r"--simkit-[a-z-]+", text))
    assert options == set(re.findall(r"--simkit-[a-z-]+", pytest_says(tmp_path, "--help")))

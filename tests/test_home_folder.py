"""Runs of a user without a home folder."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

# A user number without an account, as in a container. A test may not edit the table of accounts, so this replaces it.
PROGRAM = """
import pwd, sys
def no_account(number): raise KeyError(number)
pwd.getpwuid = no_account
from simkit.cli import main
sys.argv = ["simkit", "run", "turtlebot3_empty", "--duration", "0.01"]
main()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="it has no table of accounts")
def test_a_user_without_account_and_home_folder_runs_a_world(tmp_path: Path) -> None:
    command = [sys.executable, "-c", PROGRAM]
    environment = {name: value for name, value in os.environ.items() if name not in ("HOME", "XDG_CACHE_HOME")}
    environment |= {"PYTHONPATH": os.pathsep.join(sys.path), "SIMKIT_CACHE_DIR": str(tmp_path / "cache")}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "simulated 0.010 s" in done.stdout

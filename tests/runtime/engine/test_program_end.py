"""Simulations that still run when Python ends."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
SCRIPT = """
import threading
import simkit
sim = simkit.load('<sdf version="1.9"><world name="w"/></sdf>')
started = threading.Event()
def run():
    while True:
        sim.run(5.0)
        started.set()
threading.Thread(target=run, daemon=True).start()
assert started.wait(60)
print("done")
"""


def test_a_simulation_on_a_daemon_thread_ends_silently_with_the_program() -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], env=environment, capture_output=True, text=True, timeout=120, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "done\n", "")

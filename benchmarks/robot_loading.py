"""The second load of a robot beside plain MuJoCo reading and compiling what `simkit convert` made of it.

python benchmarks/robot_loading.py [ROBOT [RESOURCE_PATH ...]]

Without a robot: TIAGo, where the package example-robot-data is installed. Both sides twice: in fresh processes, imports
not counted and converted meshes in simkit's cache; and again and again within one process.
"""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import measure  # noqa: F401 - finds simkit in the checkout
import mujoco

import simkit
from simkit.writers.mjcf import write_mjcf

ROUNDS = 9
_ROBOT = Path("robots", "tiago_description", "robots", "tiago.urdf")


def tiago() -> list[str]:
    """The file and its resource folder; empty where the package is not here."""
    found = importlib.util.find_spec("cmeel")
    for site in {Path(p) for p in sys.path} | ({Path(found.origin).parents[1]} if found and found.origin else set()):
        share = site / "cmeel.prefix" / "share"
        if (share / "example-robot-data" / _ROBOT).is_file():
            return [str(share / "example-robot-data" / _ROBOT), str(share)]
    return []


def timed(action: Callable[[], Any]) -> float:
    """CPU time [s] of one call; what it returns is let go outside."""
    start = time.process_time()
    kept = action()
    taken = time.process_time() - start
    del kept
    return taken


def ours(source: str, *paths: str) -> Any:
    return simkit.load(source, resource_paths=paths)


def bare(file: str) -> Any:
    model = mujoco.MjModel.from_xml_path(file)
    return model, mujoco.MjData(model)


def once(side: str, modules: str, *rest: str) -> None:
    """One timing in a process of its own; `modules` are imported before (empty: printed after)."""
    for name in filter(None, modules.split(",")):
        with contextlib.suppress(ImportError):  # some are only names that a package puts there
            importlib.import_module(name)
    taken = timed(lambda: {"ours": ours, "bare": bare}[side](*rest))
    print(taken if modules else ",".join(m for m in sys.modules if not m.startswith("__")))


def in_fresh_process(side: str, modules: str, *rest: str) -> str:
    command = [sys.executable, __file__, "--once", side, modules, *rest]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()[-1]


def compare(robot: list[str]) -> list[str]:
    """Two lines, one for each reading."""
    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder) / "robot.xml")
        with ours(*robot) as sim:
            write_mjcf(sim.engine.compiled.builder, Path(file))
        modules = in_fresh_process("ours", "", *robot)
        fresh = [
            (float(in_fresh_process("ours", modules, *robot)), float(in_fresh_process("bare", "mujoco", file)))
            for _ in range(ROUNDS)
        ]
        bare(file)
        again = [(timed(lambda: ours(*robot)), timed(lambda: bare(file))) for _ in range(ROUNDS)]
    return [line("in fresh processes", fresh), line("within one process", again)]


def line(name: str, rows: list[tuple[float, float]]) -> str:
    load, plain = (statistics.median(column) for column in zip(*rows, strict=True))
    return f"{name}: load {load:.3f} s, MuJoCo alone {plain:.3f} s, ratio {load / plain:.2f}   aim <= 1.5"


def main() -> None:
    if sys.argv[1:2] == ["--once"]:
        once(*sys.argv[2:])
        return
    robot = sys.argv[1:] or tiago()
    print("\n".join(compare(robot)) if robot else "TIAGo is not here")


if __name__ == "__main__":
    main()

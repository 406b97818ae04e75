"""The command line and the lines printed, shared by the benchmarks."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))


def report(figures: Iterable[Any]) -> None:
    """Prints one line for each `simkit.cli.bench_figures.Figure`."""
    for f in figures:
        beside = "" if f.ratio is None else f"   bare {f.bare * 1e6:9.2f} us   ratio {f.ratio:6.3f}"
        aim = "" if f.aim is None else f"   aim <= {f.aim:.2f}"
        print(f"{f.name:60s} {f.ours * 1e6:9.2f} us a {f.unit}{beside}{aim}", flush=True)


def arguments(description: str | None, rounds: int) -> argparse.Namespace:
    """`--world`, `--rounds` and `--full` of a benchmark's command line."""
    parser = argparse.ArgumentParser(description=(description or "").splitlines()[0])
    parser.add_argument("--world", default="turtlebot3_world", help="file, or bare name of a world")
    parser.add_argument("--rounds", type=int, default=rounds, help="timings taken of each side")
    parser.add_argument("--full", action="store_true", help="memory: a whole simulated hour")
    return parser.parse_args()

"""Fair pairs of timings: both sides in turn, several times, and the median of each."""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))


def median_times(sides: dict[str, Callable[[], None]], rounds: int) -> dict[str, float]:
    """Median CPU time of one call [s] for each side; the sides alternate, so that a busy machine hits all alike."""
    taken: dict[str, list[float]] = {name: [] for name in sides}
    for run in sides.values():
        run()
    for _ in range(rounds):
        for name, run in sides.items():
            start = time.process_time()
            run()
            taken[name].append(time.process_time() - start)
    return {name: statistics.median(values) for name, values in taken.items()}


def report(title: str, ours: float, bare: float, limit: float | None, unit: str = "us", scale: float = 1e6) -> float:
    """Prints one line: ours, bare, their ratio, and the limit it is held to. Returns the ratio."""
    ratio = ours / bare
    aim = f"   aim <= {limit:.2f}" if limit is not None else ""
    print(f"{title:44s} {ours * scale:10.2f} {unit}   bare {bare * scale:10.2f} {unit}   ratio {ratio:6.3f}{aim}")
    return ratio


def arguments(description: str | None, rounds: int) -> argparse.Namespace:
    """`--world` and `--rounds` of a benchmark's command line."""
    parser = argparse.ArgumentParser(description=(description or "").splitlines()[0])
    parser.add_argument("--world", default="turtlebot3_world", help="file, or bare name of a world")
    parser.add_argument("--rounds", type=int, default=rounds, help="timings taken of each side")
    return parser.parse_args()

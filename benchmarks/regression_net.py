"""How good the net of golden runs is: changes of four worlds, drawn by rule, are checked against golden runs.

Every change that matters should be caught, and its cause be named; nothing that does not matter should be.

    python benchmarks/regression_net.py [--each 1] [--world workshop] [--out net.md]
"""

from __future__ import annotations

import argparse
import math
import os
import re
import shutil
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import measure  # noqa: F401 - puts the checkout on the path
from changes import Change, changes, harmless

from simkit.errors import SimkitError

HERE = Path(__file__).resolve().parent
WORLDS: dict[str, dict[str, Any]] = {
    "turtlebot3_world": {
        "duration": 2.0,
        "skip": ("/camera/*points",),
        "commands": ({"at": 0.2, "topic": "/cmd_vel", "message": {"linear": {"x": 0.22}, "angular": {"z": 0.3}}},),
    },
    "sensor_bench": {
        "duration": 1.0,
        "skip": ("*points",),
        "commands": ({"at": 0.1, "topic": "/cmd_vel", "message": {"linear": {"x": 0.3}}},),
    },
    "tiago_table": {"duration": 1.0, "skip": ("/head_front_camera/*",)},
    "workshop": {},
}
BUDGET = 30.0  # [s] of wall time for the causes of one difference


@dataclass
class Result:
    """What a check said of a change."""

    world: str
    change: Change
    caught: bool
    named: bool
    words: str
    seconds: float


def prepare(name: str, folder: Path) -> Any:
    """A copy of a world with all that it needs, as a scenario, and its golden run beside it."""
    from simkit.build import describe
    from simkit.run_spec import RunSpec
    from simkit.testing.golden.store import write_golden
    from simkit.testing.run_record.run_recorder import record_run
    from simkit.testing.scenarios.scenario_file import read_scenario
    from simkit.writers.vendored_folder import vendor

    place = folder / name
    if name == "workshop":
        shutil.copytree(HERE / "workshop", place)
        scenario = replace(read_scenario(place / "workshop.yaml"), file=None)
    else:
        vendor(name, place, describe)
        scenario = RunSpec(f"{name}.sdf", folder=place, **WORLDS[name])
    write_golden(folder / f"{name}.golden", record_run(scenario), reason="as it is")
    return scenario


def checked(golden: Path, scenario: Any, causes: bool = True) -> Any:
    from simkit.testing.golden.check import check_golden

    return check_golden(golden, scenario=scenario, causes=causes, budget_s=BUDGET)


def try_change(name: str, folder: Path, scenario: Any, change: Change) -> Result:
    """A check of the world with one change."""
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory(dir=folder) as place:
        copied = _copy(folder / name, Path(place) / name, {change.file: change.content})
        try:
            verdict = checked(folder / f"{name}.golden", replace(scenario, folder=copied))
        except SimkitError as error:  # a world that cannot be opened any more is caught, with its line
            text = f"{type(error).__name__}: {error}"
            named = f"{change.file.name}:{change.line}" in text or any(n in text for n in change.named[1:2])
            return Result(name, change, True, named, text.splitlines()[0], time.perf_counter() - begun)
    causes = verdict.explanation.causes if verdict.explanation else []
    words = causes[0].words if causes else "; ".join(d.words for d in verdict.comparison.differences[:1])
    named = bool(causes) and is_named(change, causes[0])
    return Result(name, change, not verdict.passed, named, words, time.perf_counter() - begun)


def is_named(change: Change, cause: Any) -> bool:
    """Whether a cause is the change: by file and line, or by its owner together with the element or the new value."""
    if change.line and cause.where.endswith(f"{change.file.name}:{change.line}"):
        return True
    text = f"{cause.words} {cause.path}"
    owner = any(name in text for name in change.named[1:2] or change.named)
    tag = any(word in text for word in change.named[0].split())
    numbers = [float(n) for n in re.findall(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?", cause.words)]
    new = [float(n) for n in re.findall(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?", change.new)]
    new += [math.radians(n) for n in new]
    shown = any(abs(a - b) <= 5e-3 * abs(b) for a in numbers for b in new if b)
    shown = shown or (change.new in ("true", "false") and f"→ {change.new}" in cause.words)
    return (owner and (tag or shown or not change.new)) or (tag and shown)


def harmless_cases(name: str, folder: Path, scenario: Any) -> Iterator[tuple[str, bool, str]]:
    """What nobody may notice: name, whether it was noticed, and what was said."""
    golden = folder / f"{name}.golden"
    for number, (words, files) in enumerate(harmless(folder / name, 1)):
        copied = _copy(folder / name, folder / f"{name}_harmless_{number}", files)
        verdict = checked(golden, replace(scenario, folder=copied), causes=False)
        yield words, not verdict.passed, _first(verdict)
    before = Path.cwd()
    os.chdir(tempfile.gettempdir())
    try:
        verdict = checked(golden, scenario, causes=False)
    finally:
        os.chdir(before)
    yield "another working directory", not verdict.passed, _first(verdict)
    yield "one more subscriber to everything", *_with_subscribers(golden, scenario)


def _with_subscribers(golden: Path, scenario: Any) -> tuple[bool, str]:
    from simkit.testing.golden.compare.runs import compare
    from simkit.testing.golden.store import read_golden
    from simkit.testing.run_record.run_recorder import record_run
    from simkit.testing.scenarios.scenario_run import open_scenario

    with open_scenario(scenario) as sim:
        for topic in sim.topics():
            sim.subscribe(topic, lambda message: None)
        found = compare(read_golden(golden), record_run(scenario, sim=sim))
    return not found.passed, found.differences[0].words if found.differences else ""


def _first(verdict: Any) -> str:
    return verdict.comparison.differences[0].words if verdict.comparison.differences else ""


def _copy(source: Path, target: Path, files: dict[Path, bytes]) -> Path:
    shutil.copytree(source, target)
    for file, content in files.items():
        (target / file).parent.mkdir(parents=True, exist_ok=True)
        (target / file).write_bytes(content)
    return target


def _work(job: tuple[str, Path, Any, Change]) -> Result:
    return try_change(*job)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--world", action="append", help="only this world; repeatable")
    parser.add_argument("--each", type=int, default=1, help="changes of each kind")
    parser.add_argument("--most", type=int, default=0, help="at most so many changes of a world")
    parser.add_argument("--seed", type=int, default=0, help="of the draw")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--out", type=Path, help="the table as Markdown")
    given = parser.parse_args()
    lines = ["| world | change | caught | named | said |", "|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as scratch, ProcessPoolExecutor(given.jobs, get_context("spawn")) as pool:
        folder = Path(scratch)
        for name in given.world or WORLDS:
            scenario = prepare(name, folder)
            drawn = changes(folder / name, given.seed, given.each)
            drawn = drawn[:: max(1, -(-len(drawn) // given.most))] if given.most else drawn
            results = list(pool.map(_work, [(name, folder, scenario, change) for change in drawn]))
            for one in results:
                lines.append(_row(one))
                if not (one.caught and one.named):
                    print(_row(one), flush=True)
            caught, named = sum(r.caught for r in results), sum(r.named for r in results)
            seconds = sum(r.seconds for r in results) / max(1, len(results))
            print(f"{name}: {len(results)} changes, {caught} caught, {named} named, {seconds:.1f} s each", flush=True)
            for words, noticed, said in harmless_cases(name, folder, scenario):
                print(f"{name}: {'NOTICED' if noticed else 'quiet'}: {words} {said}", flush=True)
    if given.out is not None:
        given.out.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _row(one: Result) -> str:
    what = f"{one.change.kind}: {one.change.words} ({one.change.file.name})"
    said = one.words.replace("|", "/")
    return f"| {one.world} | {what} | {'yes' if one.caught else 'NO'} | {'yes' if one.named else 'NO'} | {said} |"


if __name__ == "__main__":
    main()

"""Contact beside analytic answers, recordings and other engines: accuracy and time of a step.

python benchmarks/contact.py [--list] [--case GLOB] [--steps MS,MS] [--engines NAME,NAME] [--quick] [--tosses FOLDER]
    [--json FILE] [--plot FILE.svg] [--write PAGE.md]

Each case is data and one measure, in the file of its table. The same cases run in simkit, in simkit with MuJoCo's own
contact law, and in PyBullet, Drake and DART where they are installed (extra `compare`). `--write` replaces the tables
of a page, which is docs/accuracy.md. Times are processor times; the engines take turns.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import math
import platform
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import measure  # noqa: F401  (finds simkit beside it)
from contact_engines import DivergedError, Engine, UnsupportedCaseError, engines, versions
from contact_hits import BOUNCES_AND_DROPS, HITS
from contact_piles import DICE, DOMINO_WAVE, FALLING_HEAPS, LOADS, PYRAMIDS
from contact_record import record
from contact_scene import Case, Table
from contact_sliding import PUSHED, SLIDING_BOXES, SLIDING_SHAPES
from contact_tables import Results, markdown, section, write_page
from contact_tosses import tosses
from contact_turning import DISC, EDGES, PENDULUMS, PRECESSIONS, TURNTABLE

import simkit

TIMED_STEPS = 200  # at most, of one round
ROUNDS = 3

Makers = Mapping[str, Callable[[Case, Path], Engine]]


def tables(folder: Path | None) -> tuple[Table, ...]:
    """Every table, in the order of the page."""
    piles = (LOADS, DOMINO_WAVE, DICE, PYRAMIDS, FALLING_HEAPS)
    turning = (EDGES, DISC, PRECESSIONS, TURNTABLE, PENDULUMS)
    sliding = (SLIDING_BOXES, SLIDING_SHAPES, PUSHED)
    return (tosses(folder), HITS, BOUNCES_AND_DROPS, *sliding, *turning, *piles)


def run_case(case: Case, table: Table, makers: Makers) -> dict[str, dict[str, float]]:
    """Run one case in every engine that has its shapes, then time them in turn; by engine and quantity."""
    made: dict[str, Engine] = {}
    results: dict[str, dict[str, float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name in table.engines:
            if name not in makers:
                continue
            try:
                engine = makers[name](case, Path(folder))
            except UnsupportedCaseError:
                continue
            made[name] = engine
            try:
                results[name] = dict(case.measure(record(engine, case)))
            except (simkit.SimulationDiverged, DivergedError):
                results[name] = dict.fromkeys(table.quantities, math.nan)
                made.pop(name).close()
        if table.timed:
            for name, taken in step_times(made, case).items():
                results[name]["step_us"] = 1e6 * taken
        for engine in made.values():
            engine.close()
    return results


def step_times(made: Mapping[str, Engine], case: Case) -> dict[str, float]:
    """Median processor time of a step from the start of the motion on [s]; the engines alternate."""
    count = min(TIMED_STEPS, max(10, round(min(case.moves_for, case.duration) / case.timestep)))
    taken: dict[str, list[float]] = {name: [] for name in made}
    for turn in range(ROUNDS + 1):
        for name, engine in made.items():
            engine.rewind()
            start = time.process_time()
            engine.advance(count)
            if turn:
                taken[name].append((time.process_time() - start) / count)
    return {name: statistics.median(times) for name, times in taken.items()}


def chosen_cases(table: Table, args: argparse.Namespace) -> Iterator[tuple[float, Case]]:
    """The cases of a table that the command line asks for, each with its step in the table."""
    for step in chosen_steps(table, args):
        for case in table.cases(step, args.quick):
            if any(fnmatch.fnmatch(name, args.case) for name in (case.name, table.name, f"{table.name}/{case.name}")):
                yield step, case


def chosen_steps(table: Table, args: argparse.Namespace) -> tuple[float, ...]:
    """Time steps that the command line asks for [s]; tables that are not about steps keep theirs."""
    if args.steps and table.by_step:
        return tuple(float(step) / 1e3 for step in args.steps.split(","))
    return table.quick_steps if args.quick else table.steps


def run_table(table: Table, args: argparse.Namespace, makers: Makers) -> Results:
    """Run the chosen cases of a table."""
    results = Results(table, chosen_steps(table, args))
    for step, case in chosen_cases(table, args):
        for engine, found in run_case(case, table, makers).items():
            results.add(case.row, engine, step, found)
    return results


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--list", action="store_true", help="print the names of the tables and cases")
    parser.add_argument("--case", default="*", metavar="GLOB", help="cases to run: name of a case, table or table/case")
    parser.add_argument("--steps", metavar="MS,MS", help="time steps of the tables with a column for each step [ms]")
    parser.add_argument("--engines", default="", metavar="NAME,NAME", help="engines to run; all installed by default")
    parser.add_argument("--quick", action="store_true", help="fewer cases and steps")
    parser.add_argument("--tosses", type=Path, metavar="FOLDER", help="folder `data` of ContactNets' recorded tosses")
    parser.add_argument("--json", type=Path, metavar="FILE", help="where to write the numbers of the tables")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="where to draw them (.svg or .png)")
    parser.add_argument("--write", type=Path, metavar="PAGE", help="page whose tables are replaced")
    return parser.parse_args()


def provenance(names: list[str]) -> str:
    """Line that names the engines and the machine."""
    found = ", ".join(f"{name} {number}" for name, number in versions(names).items())
    return f"Measured with {found}, on {platform.machine()} with Python {platform.python_version()}."


def main() -> None:
    args = arguments()
    every = tables(args.tosses)
    if args.list:
        for table in every:
            names = dict.fromkeys(case.name for _, case in chosen_cases(table, args))
            print(f"{table.name}: {table.title}", *(f"    {name}" for name in names), sep="\n")
        return
    makers = engines([name for name in args.engines.split(",") if name])
    done: list[Results] = []
    for table in every:
        start = time.process_time()
        results = run_table(table, args, makers)
        if results.found:
            done.append(results)
            print(f"## {table.title} ({table.name})\n\n{markdown(results)}\n", flush=True)
            print(f"({time.process_time() - start:.0f} s)\n", flush=True)
    if not done:
        raise SystemExit(f"no case is named {args.case}: --list shows the names")
    if args.json:
        args.json.write_text(json.dumps(as_json(done), indent=1).replace("NaN", "null") + "\n", encoding="utf-8")
    if args.write:
        sections = {results.table.name: section(results) for results in done if results.table.is_on_page}
        write_page(args.write, {"engines": provenance(list(makers)), **sections})
    if args.plot:
        from contact_plot import draw

        draw(done, str(args.plot))


def as_json(done: list[Results]) -> list[dict[str, object]]:
    """The results with one entry for each row, engine and step."""
    return [
        {"table": results.table.name, "row": row, "engine": engine, "step": step, "cases": cases}
        for results in done
        for (row, engine, step), cases in results.found.items()
    ]


if __name__ == "__main__":
    main()

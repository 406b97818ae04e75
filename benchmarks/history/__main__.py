"""Speed of each version, as ratios to MuJoCo alone in the same run.

python benchmarks/history measure [COMMIT ...] [--case NAME ...]   appends an entry for each commit (default: HEAD)
python benchmarks/history page                                     writes docs/speed.md and its plots
python benchmarks/history check [BEFORE [AFTER]] [--case NAME ...] exit 1 if a ratio grew by 8 % (default: HEAD^ HEAD)

Every ratio is measured in new processes that import the commit from a folder of its own, with the packages of this
environment. simkit and MuJoCo take turns in each process, in parts of a few milliseconds of CPU time. Of each part, the
lower quartile of its times is used, so that other programs hardly count. `check` alternates between a process of each
commit as well. A ratio fails if it is 8 % above the one before in each of three pairs of processes, that is in the best
of three; a pair below ends the case.
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parents[1])]

from checkouts import Checkout, Failed, Worker, checked_out, fingerprint, git  # noqa: E402

ENTRIES = FOLDER / "entries"
LIMIT = 0.08
PAIRS = 3
TURNS = 4  # changes between the two processes of a pair


def lower_quartile(times: Sequence[float]) -> float:
    """Return the value below which a quarter of the times lie."""
    return sorted(times)[len(times) // 4]


def costs(times: list[list[list[float]]]) -> tuple[float, float]:
    """Return the costs of both sides: sums over the parts."""
    ours, bare = (sum(lower_quartile(part) for part in side) for side in times)
    return ours, bare


def merged(found: Sequence[list[list[list[float]]]]) -> list[list[list[float]]]:
    """Return the times of several requests as those of one."""
    return [
        [list(itertools.chain.from_iterable(parts)) for parts in zip(*side, strict=True)]
        for side in zip(*found, strict=True)
    ]


def has_grown(growths: Sequence[float]) -> bool:
    """Check whether the least growth of all pairs, the best one, reaches the limit."""
    return min(growths) >= LIMIT


def measured(checkouts: Sequence[Checkout], name: str, rounds: int) -> list[tuple[float, float]]:
    """Return the costs of both sides for each checkout, whose processes take turns."""
    turns = min(TURNS, rounds) if len(checkouts) > 1 else 1
    workers: list[Worker] = []
    try:
        for checkout in checkouts:
            workers.append(Worker(checkout, name).__enter__())
        found: list[list[list[list[list[float]]]]] = [[] for _ in workers]
        for turn in range(turns):
            order = list(zip(workers, found, strict=True))
            for worker, times in order if turn % 2 == 0 else reversed(order):
                times.append(worker.times(max(1, rounds // turns)))
        return [costs(merged(times)) for times in found]
    finally:
        for worker in workers:
            worker.__exit__()


def entry(checkout: Checkout, names: Sequence[str], processes: int) -> dict[str, Any]:
    """Measure a commit: the least ratio of several processes for each case."""
    from cases import CASES

    ratios: dict[str, Any] = {}
    for name in names:
        try:
            pairs = [measured([checkout], name, CASES[name].rounds)[0] for _ in range(processes)]
        except Failed as problem:
            print(f"  {name:16s} not measured: {problem}", flush=True)
            continue
        ours, bare = min(pairs, key=lambda pair: pair[0] / pair[1])
        ratios[name] = {"ratio": round(ours / bare, 4), "ours": float(f"{ours:.4g}"), "bare": float(f"{bare:.4g}")}
        print(f"  {name:16s} {ours / bare:7.3f}   of {' '.join(f'{a / b:.3f}' for a, b in pairs)}", flush=True)
    date, subject = git("show", "-s", "--format=%cI%n%s", checkout.commit).split("\n", 1)
    tags = git("tag", "--points-at", checkout.commit).split()
    return {
        "commit": checkout.commit, "date": date, "subject": subject, "release": tags[0] if tags else None,
        "machine": fingerprint(), "ratios": ratios,
    }  # fmt: skip


def measure(commits: Sequence[str], names: Sequence[str], processes: int) -> None:
    """Write an entry for each commit."""
    for commit in commits:
        with checked_out(commit) as (checkout,):
            print(git("show", "-s", "--format=%h %cs %s", checkout.commit), flush=True)
            found = entry(checkout, names, processes)
        file = ENTRIES / f"{found['date'][:10]}_{found['commit'][:10]}.json"
        if file.is_file():  # other cases of the same commit stay
            old = json.loads(file.read_text(encoding="utf-8"))
            if old["machine"] == found["machine"]:
                found["ratios"] = {**old["ratios"], **found["ratios"]}
        ENTRIES.mkdir(exist_ok=True)
        file.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def check(before: str, after: str, names: Sequence[str]) -> int:
    """Compare the ratios of two commits; return the exit code."""
    from cases import CASES

    grown = []
    with checked_out(before, after) as checkouts:
        for name in names:
            growths: list[float] = []
            try:
                while len(growths) < PAIRS and (not growths or has_grown(growths)):
                    (ours, bare), (ours_now, bare_now) = measured(checkouts, name, CASES[name].rounds)
                    growths.append(ours_now / bare_now / (ours / bare) - 1)
                    last = ours / bare, ours_now / bare_now
            except Failed as problem:
                print(f"{name:16s} not compared: {problem}", flush=True)
                continue
            fails = has_grown(growths)
            if fails:
                grown.append(name)
            each = " ".join(f"{100 * growth:+.1f} %" for growth in growths)
            print(f"{name:16s} {last[0]:7.3f} → {last[1]:7.3f}   {each}{'   GREW' if fails else ''}", flush=True)
    if grown:
        print(f"these ratios grew by {100 * LIMIT:g} % or more: {', '.join(grown)}")
    return 1 if grown else 0


def main() -> None:
    parser = argparse.ArgumentParser(description="Speed of each version, as ratios to MuJoCo alone in the same run.")
    commands = parser.add_subparsers(dest="command", required=True)
    measuring = commands.add_parser("measure", help="append an entry for each commit")
    measuring.add_argument("commits", nargs="*", default=["HEAD"])
    measuring.add_argument("--processes", type=int, default=PAIRS, help="the least ratio of so many processes")
    commands.add_parser("page", help="write docs/speed.md and its plots")
    checking = commands.add_parser("check", help="fail if a ratio grew by 8 %%")
    checking.add_argument("before", nargs="?", default=None)
    checking.add_argument("after", nargs="?", default="HEAD")
    for command in (measuring, checking):
        command.add_argument("--case", action="append", help="only this case; repeatable")
    args = parser.parse_args()
    if args.command == "page":
        from page import write_page

        write_page()
        return
    from cases import CASES

    names = args.case or list(CASES)
    if unknown := sorted(set(names) - set(CASES)):
        parser.error(f"no case {', '.join(unknown)}; there are {', '.join(CASES)}")
    if args.command == "measure":
        measure(args.commits, names, args.processes)
    else:
        raise SystemExit(check(args.before or f"{args.after}^", args.after, names))


if __name__ == "__main__":
    main()

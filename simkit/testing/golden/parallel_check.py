"""Check several golden runs, one after the other or in parallel processes."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.errors import SimkitError

if TYPE_CHECKING:
    from simkit.testing.golden.compare.difference import Verdict


@dataclass(frozen=True)
class CheckOptions:
    """How golden runs are checked; fields as the arguments of `simkit.testing.golden.check.check_golden`."""

    bless: str | None = None
    other_renderer: bool = False
    causes: bool = True
    budget_s: float = 60.0


@dataclass
class CheckResult:
    """What became of one golden run.

    Attributes:
        folder: where it is.
        verdict: None where it could not be checked.
        error: then why.
    """

    folder: Path
    verdict: Verdict | None = None
    error: SimkitError | None = None

    @property
    def rank(self) -> tuple[int, str]:
        """Worst first: what could not be checked, what differs, what passed."""
        if self.verdict is None:
            return 0, str(self.folder)
        return 2 if self.verdict.passed else 1, str(self.folder)


def check_goldens(paths: Sequence[Path], wanted: CheckOptions, jobs: int = 1) -> list[CheckResult]:
    """Checks golden runs, and those in folders; the worst first.

    Args:
        paths: of golden runs or of folders that hold some.
        wanted: how.
        jobs: how many at once, each in a process of its own.
    """
    from simkit.testing.golden.store import find_goldens

    results: list[CheckResult] = []
    folders: dict[Path, None] = {}
    for path in paths:
        try:
            folders.update(dict.fromkeys(find_goldens(path)))
        except SimkitError as error:
            results.append(CheckResult(path, error=error))
    if jobs > 1 and len(folders) > 1:
        results += _check_in_parallel(list(folders), wanted, min(jobs, len(folders)))
    else:
        results += [check_golden_folder(folder, wanted) for folder in folders]
    return sorted(results, key=lambda result: result.rank)


def check_golden_folder(folder: Path, wanted: CheckOptions) -> CheckResult:
    """Checks one golden run."""
    from simkit.testing.golden.check import check_golden

    try:
        return CheckResult(folder, check_golden(folder, **vars(wanted)))
    except SimkitError as error:
        return CheckResult(folder, error=error)


def _check_in_parallel(folders: list[Path], wanted: CheckOptions, jobs: int) -> list[CheckResult]:
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    context = multiprocessing.get_context("spawn")  # a graphics library does not survive a fork
    with ProcessPoolExecutor(jobs, context, _end_with_parent) as pool:
        return list(pool.map(_check_in_process, folders, [wanted] * len(folders)))


def _end_with_parent() -> None:
    """In another process: ends it once the one that began it is gone, however that went."""
    import multiprocessing
    from multiprocessing.connection import wait

    parent = multiprocessing.parent_process()
    if parent is None:
        return
    sentinel = parent.sentinel

    def watch() -> None:
        wait([sentinel])
        os._exit(1)

    threading.Thread(target=watch, name="simkit ends with its parent", daemon=True).start()


def _check_in_process(folder: Path, wanted: CheckOptions) -> CheckResult:
    """Of another process: without what cannot leave it."""
    with redirect_stdout(sys.stderr):  # what a plugin prints there; standard output is the parent's
        result = check_golden_folder(folder, wanted)
    if result.error is not None:
        result.error.__cause__ = result.error.__context__ = None
    if result.verdict is not None:
        result.verdict.run.error = None
    return result

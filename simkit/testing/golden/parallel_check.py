"""Check of several golden runs, one after another or in parallel processes."""

from __future__ import annotations

import sys
from collections.abc import Collection, Sequence
from contextlib import AbstractContextManager, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from simkit import progress
from simkit.errors import SimkitError
from simkit.process_control import end_with_parent, safe_path, without_interrupts
from simkit.run_spec import FilePath

if TYPE_CHECKING:
    from simkit.testing.golden.compare.difference import Verdict


@dataclass(frozen=True)
class CheckOptions:
    """Options of a check; the fields are arguments of `simkit.testing.golden.check.check_golden`."""

    bless: str | None = None
    other_renderer: bool = False
    causes: bool = True
    budget_s: float = 60.0
    pictures: bool = False
    allow_code: bool = False
    plugin_paths: tuple[Path, ...] = ()
    folders: tuple[FilePath, ...] = ()


@dataclass
class CheckResult:
    """Result of checking one golden run.

    Attributes:
        folder: Folder of the golden run.
        verdict: Verdict; None if the check failed with an error.
        error: Error that prevented the check; None without an error.
    """

    folder: Path
    verdict: Verdict | None = None
    error: SimkitError | None = None

    @property
    def rank(self) -> tuple[int, str]:
        """Key for sorting: runs that could not be checked are first, then runs that differ, then runs that passed."""
        if self.verdict is None:
            return 0, str(self.folder)
        return 2 if self.verdict.passed else 1, str(self.folder)


def check_goldens(paths: Sequence[Path], options: CheckOptions, jobs: int = 1) -> list[CheckResult]:
    """Check golden runs and return the results, worst first.

    Args:
        paths: Golden runs, or folders that contain golden runs.
        options: Options of each check.
        jobs: Number of parallel processes.
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
        results += _check_in_parallel(list(folders), options, min(jobs, len(folders)))
    else:
        with _progress(folders) as task:
            for folder in folders:
                task.item = folder.name
                results.append(check_golden_folder(folder, options))
                task.advance()
    return sorted(results, key=lambda result: result.rank)


def check_golden_folder(folder: Path, options: CheckOptions) -> CheckResult:
    """Check one golden run and return its verdict or error."""
    from simkit.testing.golden.check import check_golden

    try:
        return CheckResult(folder, check_golden(folder, **vars(options)))
    except SimkitError as error:
        return CheckResult(folder, error=error)


def _check_in_parallel(folders: list[Path], options: CheckOptions, jobs: int) -> list[CheckResult]:
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    context = multiprocessing.get_context("spawn")  # graphics libraries do not work in a forked process
    results: list[CheckResult] = []
    with ProcessPoolExecutor(jobs, context, end_with_parent) as pool, _progress(folders) as task:
        try:
            with without_interrupts(), safe_path():
                checks = pool.map(_check_in_process, folders, [options] * len(folders))
            for result in checks:
                results.append(result)
                task.advance()
        except BaseException:  # for Ctrl-C too; otherwise, the pool would wait for all checks
            pool.shutdown(wait=False, cancel_futures=True)
            for process in multiprocessing.active_children():
                process.kill()
            raise
    return results


def _progress(folders: Collection[Path]) -> AbstractContextManager[progress.Task]:
    return progress.task("checking golden runs", len(folders))


def _check_in_process(folder: Path, options: CheckOptions) -> CheckResult:
    """Check a golden run in a child process; remove data that cannot be pickled from the result."""
    with redirect_stdout(sys.stderr):  # plugins may print, but the parent process prints its report to standard output
        result = check_golden_folder(folder, options)
    if result.error is not None:
        result.error.__cause__ = result.error.__context__ = None
    if result.verdict is not None:
        result.verdict.run.error = None
    return result

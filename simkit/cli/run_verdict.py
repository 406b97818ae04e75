"""Verdict on a run: its conditions and its time limits."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, Final

from simkit.cli.terminal.json_report import add_to_report, print_report_now
from simkit.cli.terminal.output import print_message, stdout_console
from simkit.cli.wall_time_limit import WallTimeExceeded, WallTimeLimit
from simkit.errors import RegressionError, SimkitError
from simkit.run_spec import RunSpec

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.testing.conditions import CheckResult, Watch

FAILED: Final = RegressionError.exit_code
INTERRUPT: Final = "an interrupt"
"""Reason for the end of a run by Ctrl-C or SIGTERM."""


class RunVerdict:
    """Verdict on a run; a context manager around the run, including loading.

    Args:
        spec: run specification.

    Attributes:
        name: name of the run for reports.
        begun: start of the run, of `time.perf_counter` [s].
        reports: callbacks after the end of the run, also after an error, which they receive. They run in another
            thread if the run is blocked beyond its wall time limit.
        code: exit code.
        reason: reason for the end of the run, as in `Watch.results`; empty before the end.
        results: results of the conditions.
    """

    def __init__(self, spec: RunSpec) -> None:
        self.code = 0
        self.reason = ""
        self.results: tuple[CheckResult, ...] = ()
        self._end = ""  # for the JSON report
        self.reports: list[Callable[[BaseException | None], object]] = []
        self._spec = spec
        self.name = spec.world if "<" not in spec.world else "world"
        self._watch: Watch | None = None
        self._has_begun = self._has_end = False
        self.begun = time.perf_counter()
        self._wall = WallTimeLimit(spec.wall_timeout, print_message, self._give_up)

    def __enter__(self) -> RunVerdict:
        self._wall.__enter__()
        return self

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> bool:
        """Write the reports. The interrupt of the wall time limit fails the run, but its exception is suppressed."""
        self._wall.__exit__()
        if error is not None and not self.reason:
            self._conclude(error)
        if isinstance(error, WallTimeExceeded):
            self.code = FAILED
            if not self._has_begun:
                print_message(self.wall_timeout_text())
        if error is None or isinstance(error, (SimkitError, KeyboardInterrupt)):
            self._report(error)
        return isinstance(error, WallTimeExceeded)

    # ------------------------------------------------------------------ the run

    def watch(self, sim: Simulation, longest: float | None) -> AbstractContextManager[object]:
        """Return the watch on the conditions, a context manager around the run; without conditions, it does nothing.

        Args:
            sim: loaded simulation.
            longest: longest simulated time [s] of the run; None if the run continues until Ctrl-C.

        Raises:
            InputError: an expression is invalid, or names something that the world does not have.
        """
        self._has_begun, self._has_end = True, longest is not None
        if not (self._spec.checks or self._spec.until):
            return nullcontext()
        from simkit.testing.conditions import Watch  # 20 ms, which a run without conditions need not take

        self._watch = Watch(sim, self._spec.checks, until=self._spec.until, timeout=longest)
        return self._watch

    def is_over(self) -> bool:
        """Check whether the run must end: the condition holds, or the wall time limit is reached."""
        return self._wall.is_over or (self._watch is not None and self._watch.ended)

    def end(self, error: BaseException | None, interrupted_by: str) -> None:
        """Determine the verdict after the end of the run.

        Args:
            error: error that ended the run, if any.
            interrupted_by: reason for an early end; empty if the run was not interrupted.
        """
        self._wall.end()
        self._conclude(error, interrupted_by)
        self._end = "interrupt" if interrupted_by else self.reason
        if error is not None and self.reason != "wall_timeout":
            self._end = "error"
        if error is None and not interrupted_by and not self._has_passed:
            self.code = FAILED

    def print_results(self) -> None:
        """Print one line per condition."""
        if self.reason == "wall_timeout":
            stdout_console().print(f"FAILED  {self.wall_timeout_text()}", style="red")
        for result in self.results:
            word, style = ("passed", None) if result.passed else ("FAILED", "red")
            stdout_console().print(f"{word}  {result.check.title}: {result.message}", style=style)
        add_to_report(
            end=self._end,
            conditions=[
                {"condition": r.check.title, "passed": r.passed, "message": r.message, "time": r.time}
                for r in self.results
            ],
        )

    @property
    def _has_passed(self) -> bool:
        return self.reason != "wall_timeout" and all(result.passed for result in self.results)

    def _conclude(self, error: BaseException | None, interrupted_by: str = "") -> None:
        self.reason = self._reason(error, interrupted_by)
        if self._watch is not None:
            self.results = self._watch.results(self.reason)

    def _reason(self, error: BaseException | None, interrupted_by: str) -> str:
        if isinstance(error, WallTimeExceeded):
            return "wall_timeout"
        if error is not None:
            return str(error).splitlines()[0] if str(error) else type(error).__name__
        if self._watch is not None and self._watch.ended:
            return "until"
        if self._wall.is_over:
            return "wall_timeout"
        if interrupted_by and self._has_end:
            return interrupted_by
        return "timeout" if self._spec.until else "duration"

    def wall_timeout_text(self) -> str:
        """Return the failure message of a run that reached its wall time limit."""
        blocked = f", while it waited for {self._wall.blocked_by}" if self._wall.blocked_by else ""
        return f"the run was stopped after {self._wall.seconds:g} s of wall time (--wall-timeout){blocked}"

    def _report(self, error: BaseException | None) -> None:
        for report in self.reports:
            report(error)

    def _give_up(self) -> int:
        """Write the reports from the time limit's thread, because the run is blocked; return the exit code."""
        self.reason = "wall_timeout"
        self._report(None)
        add_to_report(end=self.reason)
        print_report_now(FAILED)
        return FAILED

"""Run part `--junit`: write the conditions of a run as a JUnit XML report."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

from simkit.cli.run_part import RunPart
from simkit.cli.run_verdict import INTERRUPT, RunVerdict
from simkit.cli.terminal.options import option
from simkit.run_spec import RunSpec

if TYPE_CHECKING:
    from simkit.testing.junit import JunitCase


@dataclass
class JunitReport(RunPart):
    """Report with one case for the run and one for each condition."""

    place: ClassVar[int] = 30

    junit: Annotated[Path | None, option("JUnit XML report to write.", "FILE.xml")] = None

    @contextmanager
    def around_run(self, spec: RunSpec, verdict: RunVerdict) -> Iterator[None]:
        """Check the file, and write the report when the verdict is final."""
        if self.junit is not None:
            from simkit.writers.atomic_output import check_writable

            check_writable(self.junit)
            verdict.reports.append(partial(self._write, self.junit, verdict))
        yield

    def _write(self, path: Path, verdict: RunVerdict, error: BaseException | None) -> None:
        from simkit.testing.junit import write_junit

        write_junit(path, f"simkit run {verdict.name}", _cases(verdict, error))


def _cases(verdict: RunVerdict, error: BaseException | None) -> list[JunitCase]:
    from simkit.testing.junit import JunitCase

    seconds, group = time.perf_counter() - verdict.begun, f"simkit.{verdict.name.replace('.', '_')}"
    text = verdict.wall_timeout_text() if verdict.reason == "wall_timeout" else ""
    failed = (text, text) if text else None
    raised = None
    if verdict.reason == INTERRUPT:
        raised = (f"ended with {INTERRUPT}",) * 2
    elif error is not None and not text:
        lines = str(error).splitlines() or [type(error).__name__]
        raised = (lines[0], "\n".join(lines))
    cases = [JunitCase("run", group, seconds, failure=failed, error=raised)]
    for result in verdict.results:
        failure = None if result.passed else (result.message, f"{result.check.title}: {result.message}")
        cases.append(
            JunitCase(result.check.title, group, failure=failure, output=result.message if result.passed else "")
        )
    return cases

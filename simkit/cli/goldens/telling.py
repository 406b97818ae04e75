"""What is said of golden runs that were checked."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.cli.console import out, show_error
from simkit.cli.goldens.checking import Result
from simkit.errors import RegressionError

if TYPE_CHECKING:
    from simkit.golden.difference import Verdict


def tell(
    results: Sequence[Result],
    *,
    blessed: bool = False,
    html: Path | None = None,
    junit: Path | None = None,
    as_json: bool = False,
    quiet: bool = False,
) -> int:
    """Prints results, the worst first, and writes what else is asked for.

    Args:
        results: of the checks.
        blessed: whether what differed has become golden.
        html, junit: where reports go.
        as_json: whether one JSON value is printed instead of text.
        quiet: whether nothing is said of what passed.

    Returns:
        The exit code: of what could not be checked, else 5 where something differs.
    """
    verdicts = [result.verdict for result in results if result.verdict is not None]
    if html is not None:
        from simkit.golden.report import write_html

        write_html(html, verdicts)
    if junit is not None:
        _write_junit(junit, results, verdicts)
    if as_json:
        out().print(json.dumps([plain(result) for result in results], indent=2, ensure_ascii=False, allow_nan=False))
    else:
        _print(results, blessed=blessed, quiet=quiet)
    for result in results:
        if result.error is not None:
            return int(result.error.exit_code)
    failed = [v for v in verdicts if not (_was_blessed(v, blessed) or v.passed)]
    return RegressionError.exit_code if failed else 0


def _print(results: Sequence[Result], *, blessed: bool, quiet: bool) -> None:
    from simkit.golden.report import text_report

    width = max(60, min(out().width, 160)) if out().is_terminal else 120
    for result in results:
        verdict = result.verdict
        if result.error is not None:
            show_error(result.error)
        elif verdict is not None and _was_blessed(verdict, blessed):
            count = len(verdict.comparison.differences)
            out().print(f"{verdict.name}: golden now, with {count} difference{'s' if count > 1 else ''}:")
            for one in verdict.comparison.differences[:5]:
                out().print(f"  {one.words}")
        elif verdict is not None and not (verdict.passed and quiet):
            for line in text_report(verdict, width):
                out().print(line)
    if len(results) > 1:
        passed = sum(r.verdict is not None and r.verdict.passed for r in results)
        out().print(f"{passed} of {len(results)} golden runs passed")


def _was_blessed(verdict: Verdict, blessed: bool) -> bool:
    return blessed and not verdict.comparison.passed and all(check.passed for check in verdict.checks)


def _write_junit(path: Path, results: Sequence[Result], verdicts: list[Verdict]) -> None:
    from simkit.golden.report import junit_cases
    from simkit.sinks.junit import Case, write_junit

    cases = [
        Case("run", f"golden.{result.folder.name}", error=(str(result.error).partition("\n")[0], str(result.error)))
        for result in results
        if result.error is not None
    ]
    write_junit(path, "simkit golden", [*cases, *junit_cases(verdicts)])


def plain(result: Result) -> dict[str, Any]:
    """A result for programs."""
    if result.verdict is None:
        code = getattr(result.error, "code", "")
        return {"folder": str(result.folder), "passed": False, "error": {"code": code, "message": str(result.error)}}
    verdict = result.verdict
    comparison, explanation = verdict.comparison, verdict.explanation
    found: dict[str, Any] = {
        "folder": str(result.folder),
        "name": verdict.name,
        "passed": verdict.passed,
        "tier": comparison.tier,
        "elapsed": round(verdict.elapsed, 3),
        "end": verdict.run.end,
        "differences": [_plain(vars(one) if hasattr(one, "__dict__") else one) for one in comparison.differences],
        "notes": list(comparison.notes),
        "machine": {name: {"golden": a, "run": b} for name, (a, b) in comparison.machine.items()},
        "checks": [
            {"title": one.check.title, "passed": one.passed, "message": one.message, "time": _plain(one.time)}
            for one in verdict.checks
        ],
    }
    if explanation is not None:
        found["explanation"] = {
            "lines": list(explanation.lines),
            "tick": _plain(explanation.tick),
            "time": _plain(explanation.time),
            "quantity": explanation.quantity,
            "causes": [_plain(vars(cause)) for cause in explanation.causes],
        }
    return found


def _plain(value: Any) -> Any:
    """As JSON has it: what is no number is null."""
    if isinstance(value, dict):
        return {str(key): _plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)) or hasattr(value, "tolist"):
        return _plain(value.tolist()) if hasattr(value, "tolist") else [_plain(one) for one in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if isinstance(value, (bool, int, str)) or value is None else str(value)

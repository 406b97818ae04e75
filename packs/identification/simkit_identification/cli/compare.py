"""Compare two recordings, a recording with the run that repeats its commands, or two sets of runs."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

from typer import Option

from simkit.cli.run_options import NONE_GIVEN, scenario_spec
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.json_report import add_to_report, report_errors_and_json
from simkit.cli.terminal.options import validate_word
from simkit.cli.terminal.output import stdout_console
from simkit.errors import InputError
from simkit.extend import GivenOptions, argument, option, with_run_options
from simkit.writers.atomic_output import check_writable

if TYPE_CHECKING:
    from simkit import RunSpec
    from simkit_identification.comparison.alignment import Align

_INVALID = "SK-COMPARE-003"
_ALIGNMENTS = ("auto", "none", "start", "correlation")


@report_errors_and_json
@with_run_options(
    *("file", "world", "topics", "skip", "play_topics"),
    without={
        "run": "the recording decides how long the run lasts, and which commands it gets",
        "session": "nobody follows the run of a comparison",
    },
)
def compare(
    a: Annotated[
        str,
        argument("Bag: .mcap, .db3 or a rosbag2 folder. Or a set of runs: a folder of a sweep or of bags.", "BAG|DIR"),
    ],
    b: Annotated[
        str | None,
        argument(
            "Bag, or world that repeats the commands of the first; or the second set of runs. "
            "Without it, the figures of the first bag are listed.",
            "[BAG|WORLD|DIR]",
            completion.scenarios,
        ),
    ] = None,
    map_: Annotated[
        list[str], option("Topic of the second source for a topic of the first; repeatable.", "/TOPIC=/OTHER", "--map")
    ] = [],
    align: Annotated[str, option("How the clocks are aligned.", "auto|none|start|correlation", "--align")] = "auto",
    tolerance: Annotated[
        list[str],
        option(
            "Difference that counts as none, for QUANTITY, /TOPIC or /TOPIC:QUANTITY; default: 0.1%; repeatable.",
            "PATTERN=SIZE|PERCENT%",
            "--tolerance",
        ),
    ] = [],
    confidence: Annotated[
        float, option("Confidence of each interval, and of all verdicts together.", "SHARE", min=0.5, max=0.9999)
    ] = 0.95,
    all_: Annotated[bool, Option("--all", "-a", help="List all rows instead of those that differ.")] = False,
    html: Annotated[Path | None, option("Page to write, with plots.", "OUT.html")] = None,
    check: Annotated[bool, Option("--check", help="End with exit code 5 if a row differs.")] = False,
    given: GivenOptions = NONE_GIVEN,
    allow_code: options.AllowCode = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
) -> int:
    """Compare two recordings, a recording with the run that repeats its commands, or two sets of runs.

    One row for each quantity of each topic: rate, gaps, latency, bias, noise, valid share, spectrum, speeds,
    drift and delays, with the difference, its confidence interval and a verdict.
    """
    from simkit_identification.comparison.compare import compare as compare_sources

    check_writable(html)
    validate_word("--align", align, _ALIGNMENTS)
    own = {name: given.values.get(name, ()) for name in ("topics", "skip", "play_topics")}
    of_run = GivenOptions({name: value for name, value in given.values.items() if name not in own})
    table = compare_sources(
        a,
        _second(b, of_run, allow_code=allow_code),
        names=_pairs(map_, "--map", "/TOPIC=/OTHER"),
        topics=own["topics"],
        skip=own["skip"],
        commands=own["play_topics"],
        align=cast("Align", align),
        tolerances=_pairs(tolerance, "--tolerance", "PATTERN=SIZE"),
        confidence=confidence,
        allow_code=allow_code,
    )
    add_to_report(**table.as_dict())
    if html is not None:
        table.write_html(html)
    stdout_console().print(table.text(everything=all_))
    return 5 if check and not table.is_same else 0


def _second(b: str | None, given: GivenOptions, *, allow_code: bool) -> str | RunSpec | None:
    """Return the second source: a run specification for a world.

    Raises:
        InputError: SK-COMPARE-003 an option of a run is given without a world.
    """
    from simkit_identification.comparison.paired_runs import is_set
    from simkit_identification.comparison.sources import is_bag

    if b is None or is_bag(Path(b)) or is_set(b):
        if given.values:
            text = f"{', '.join(given.names())}: options of a run, but no world is run"
            raise InputError(_INVALID, text, help="give a world as second source")
        return b
    return scenario_spec(b, given, allow_code=allow_code)


def _pairs(texts: Iterable[str], name: str, expected: str) -> dict[str, str]:
    """Return the parts before and after the last `=` of each text.

    Raises:
        InputError: SK-COMPARE-003 with all texts that have none.
    """
    found: dict[str, str] = {}
    problems: list[str] = []
    for text in texts:
        first, equals, second = text.rpartition("=")
        if equals and first and second:
            found[first] = second
        else:
            problems.append(f"{name}: found {text!r}; expected {expected}")
    if problems:
        raise InputError(_INVALID, f"\n{_INVALID} ".join(problems))
    return found

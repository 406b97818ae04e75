"""Fit parameters of a world to recordings of its robot."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, cast

from typer import Option

from simkit.cli.run_options import NONE_GIVEN, scenario_spec
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_diagnostics, add_to_report, report_errors_and_json
from simkit.cli.terminal.output import print_diagnostics, print_status, stdout_console
from simkit.extend import GivenOptions, argument, option, with_run_options
from simkit.writers.atomic_output import check_writable


@report_errors_and_json
@with_run_options(
    *("file", "world"),
    without={"seed": "--seed is that of the search; the repeated runs have no noise"},
)
def fit(
    world: options.Scenario,
    bags: Annotated[list[Path], argument("Recordings: bags with commands that the world hears.", "BAG...")],
    vary: Annotated[
        list[str],
        option("Parameter to fit: a path of --set, with a first value or bounds; repeatable.", "PATH[=LOW:HIGH]"),
    ] = [],
    output: Annotated[
        Path | None, option("Scenario file to write, with the fitted values.", "FITTED.yaml", "--output", "-o")
    ] = None,
    report: Annotated[Path | None, option("Page to write: values and plots before and after.", "FIT.html")] = None,
    plot: Annotated[Path | None, option("Chart to write: .png or .svg.", "FIT.png")] = None,
    compare: Annotated[
        list[str],
        option("Topic to compare, or a field of it; repeatable. Default: all of both.", "TOPIC[.FIELD]"),
    ] = [],
    skip: Annotated[float, option("Seconds at the beginning that are not compared.", "S", min=0)] = 0.0,
    duration: Annotated[float | None, option("Seconds of each bag to use; default: all.", "S", min=0)] = None,
    play_topic: Annotated[
        list[str], option("Topic of the commands, optionally under a new name; repeatable.", "TOPIC[:=NEW]")
    ] = [],
    motion: Annotated[
        str, option("Free motion of a model, with its poses on this topic, instead of commands.", "MODEL=TOPIC")
    ] = "",
    window: Annotated[
        float | None, option("Length of the parts into which a free motion is cut; default: whole.", "S", min=0)
    ] = None,
    method: Annotated[
        str, option("Search: least squares, CMA-ES for noisy costs, or chosen.", "auto|least-squares|cma")
    ] = "auto",
    robust: Annotated[
        bool, Option("--robust", help="Reduce the influence of large residuals; always for free motions.")
    ] = False,
    jobs: Annotated[
        int | None, option("Number of parallel processes; default: one per processor core.", "N", "--jobs", "-n", min=1)
    ] = None,
    seed: Annotated[int, option("Seed of the first points and of CMA-ES.", "N", min=0)] = 0,
    given: GivenOptions = NONE_GIVEN,
    allow_code: options.AllowCode = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
    quiet: Annotated[bool, Option("--quiet", "-q", help="Print nothing but errors and warnings.")] = False,
) -> None:
    """Fit parameters of a world to recordings of its robot.

    The world runs with the recorded commands again and again, until its readings are those of the recording. Each
    fitted value has an interval, and parameters that the recording cannot tell apart are named.
    """
    from simkit.recording.charts.chart import check_suffix
    from simkit_identification.fitting.fit import FitOptions, fit_run
    from simkit_identification.fitting.search import METHODS, Method

    options.validate_word("--method", method, METHODS)
    if plot is not None:
        check_suffix(plot.name)
    for path in (output, report, plot):
        check_writable(path)
    chosen = FitOptions(
        tuple(compare), skip, duration, motion, window, tuple(play_topic), cast(Method, method), robust or None, jobs,
        seed,
    )  # fmt: skip
    spec = scenario_spec(world, given, allow_code=allow_code)
    on_stage: Callable[[str], None] = (lambda _: None) if quiet else print_status
    result = fit_run(spec, bags, vary, chosen, on_stage)
    add_to_report(**result.as_dict())
    add_diagnostics(result.diagnostics)
    if not quiet:
        for line in result.lines():
            stdout_console().print(line, markup=False, soft_wrap=True)
    print_diagnostics(result.diagnostics, verbose=True)
    writers = (output, result.save), (report, result.report), (plot, result.plot)
    written = [write(path) for path, write in writers if path is not None]
    add_to_report(files=[str(path) for path in written])
    for path in written:
        on_stage(f"wrote {path}")

"""Command `simkit bench`: compare the speed of a world with bare MuJoCo."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from typer import Option

from simkit import progress
from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_to_report, report_errors_and_json
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import stdout_console

if TYPE_CHECKING:
    from simkit.cli.bench_figures import Figure

_HOUR = 3600.0


@report_errors_and_json
@with_run_options(
    *("file", "world"),
    without={
        "run": "the comparison sends no commands, and chooses the durations and topics",
        "session": "the comparison runs at full speed",
    },
)
def bench(
    world: options.World,
    rounds: Annotated[int, option("Number of measurements of simkit and of MuJoCo.", "N", min=1)] = 9,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
    full: Annotated[bool, Option("--full", help="Measure memory over a simulated hour, not a minute.")] = False,
    given: GivenOptions = NONE_GIVEN,
) -> None:
    """Compare the speed of a world with bare MuJoCo."""
    from simkit.mujoco_import import import_mujoco

    import_mujoco()
    from simkit.build import load
    from simkit.cli.bench_figures import compare_with_bare_mujoco, measure_import_time, measure_memory_growth

    spec = given.run_spec(world)
    figures: list[Figure] = []
    for figure in progress.report_each("measuring", compare_with_bare_mujoco(spec, rounds=rounds)):
        if not figures:  # after the load, whose errors need no table
            stdout_console().print(f"{'':<52}{'simkit':>12}{'bare':>12}{'ratio':>8}{'goal':>8}")
        figures.append(figure)
        bare = "" if figure.bare is None else f"{figure.bare * 1e6:.1f} µs"
        ratio = "" if figure.ratio is None else f"{figure.ratio:.2f}"
        aim = f"{figure.most * 1e6:.0f} µs" if figure.most else "" if figure.aim is None else f"{figure.aim:.2f}"
        stdout_console().print(
            f"{figure.name:<52}{figure.ours * 1e6:>9.1f} µs{bare:>12}{ratio:>8}{aim:>8}  a {figure.unit}"
        )
    import_time = measure_import_time(rounds)
    stdout_console().print(f"{'import simkit':<52}{import_time:>9.3f} s{'':>21}{'0.3 s':>8}")
    with load(spec.world, **spec.load_arguments()) as sim, progress.task("measuring the memory"):
        growth = measure_memory_growth(sim, _HOUR if full else 60.0) * _HOUR
    stdout_console().print(f"{'memory':<52}{growth / 1e6:>9.2f} MB  a simulated hour")
    add_to_report(
        figures=[
            {"name": f.name, "unit": f.unit, "simkit": f.ours, "mujoco": f.bare, "ratio": f.ratio, "goal_ratio": f.aim,
             "goal_time": f.most}
            for f in figures
        ],
        import_time=import_time,
        memory_growth=growth,
    )  # fmt: skip

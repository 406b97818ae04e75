"""Verify that a run is bit-identical in different environments."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from simkit.cli.run_options import NONE_GIVEN, scenario_spec
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_to_report, report_errors_and_json
from simkit.cli.terminal.output import print_status, stdout_console
from simkit.extend import GivenOptions, option, with_run_options
from simkit.writers.atomic_output import check_writable, write_atomically

_DIFFERENT = 5
_DEFAULT_DURATION = 5.0  # [s] for a world without a scenario


@report_errors_and_json
@with_run_options(
    *("file", "world", "run"),
    usual={"duration": "the scenario's, else 5", "wall_timeout": "ten times the first run's, at least 60"},
    without={
        "checks": "a certificate compares runs and tells nothing about conditions",
        "session": "nobody follows the runs of a certificate",
    },
)
def certify(
    world: options.Scenario,
    given: GivenOptions = NONE_GIVEN,
    runs: Annotated[int, option("Number of runs, each in a fresh process.", "N")] = 6,
    jobs: Annotated[int, option("Number of parallel processes.", "N", "--jobs", "-j", min=1)] = 1,
    allow_code: options.AllowCode = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
    output: Annotated[Path | None, option("Certificate to write, as JSON.", "FILE.json", "--out", "-o")] = None,
) -> int:
    """Verify that a run is bit-identical in different environments."""
    from simkit.testing import open_scenario
    from simkit.testing.scenarios.scenario_run import resolve_commands
    from simkit_verification.testing.certify import VARIATIONS, certificate
    from simkit_verification.testing.certify import certify as certify_scenario

    check_writable(output)
    scenario = scenario_spec(world, given, allow_code=allow_code, usual_duration=_DEFAULT_DURATION)
    if scenario.velocity is not None or scenario.script is not None:
        with open_scenario(scenario) as sim:
            scenario = resolve_commands(scenario, sim.communication.bus)
    print_ = stdout_console().print

    def print_row(row: certificate.Row) -> None:
        if row.variation is VARIATIONS[0]:  # an error before the end of the first run has no table
            print_(certificate.table_header())
        print_(certificate.table_row(row))

    report = certify_scenario(
        replace(scenario, wall_timeout=None),  # the limit of a process, which does not end a run early
        runs=runs,
        jobs=jobs,
        wall_timeout=scenario.wall_timeout,
        on_row=print_row,
    )
    for line in certificate.conclusion_text(report):
        print_(line)
    code = 0 if report.passed else _DIFFERENT
    data = {**report.to_dict(), "diagnostics": [], "exit_code": code}  # the file has the keys of the report, too
    add_to_report(**data)
    if output is not None:
        write_atomically(output, (json.dumps(data, indent=1) + "\n").encode())
        print_status(f"wrote {output}")
    return code

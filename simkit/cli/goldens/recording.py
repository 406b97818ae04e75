"""What `simkit golden record` does."""

from __future__ import annotations

from contextlib import chdir
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.cli.running.asked import Asked
    from simkit.golden.record import Record


def keep(asked: Asked, folder: Path, *, force: bool = False) -> Record:
    """Runs what is asked for and makes it golden.

    Returns:
        The record; its simulation is still open.

    Raises:
        SimkitError: what went wrong; then nothing is written.
    """
    from simkit.golden.capture import run_record
    from simkit.golden.store import MAIN, write_golden
    from simkit.overrides import check_used
    from simkit.scenario.run import open_scenario

    if (folder / MAIN).exists() and not force:
        raise InputError(
            f"SK-GOLDEN-005 {folder} is a golden run already and is not overwritten\n"
            "    help: simkit golden check --bless 'REASON' changes it and keeps why; --force begins anew",
            "SK-GOLDEN-005",
        )
    scenario = asked.scenario()
    if asked.changes_scenario:  # what differs from the file is kept in the golden run itself
        scenario = replace(scenario, file=None)
    with chdir("."):  # a plugin that goes elsewhere as it is loaded
        sim = open_scenario(scenario)
    try:
        check_used(sim.diagnostics)
        scenario = asked.commanded(scenario, sim.topics())
        record = run_record(scenario, sim=sim)
        if record.error is not None:
            raise record.error
        write_golden(folder, record)
    except BaseException:
        sim.close()
        raise
    return record

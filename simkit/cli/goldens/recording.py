"""What `simkit golden record` does."""

from __future__ import annotations

from contextlib import chdir
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.cli.options import Source, source
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.golden.record import Record
    from simkit.scenario import Scenario
    from simkit.sinks.commands import Command


@dataclass(frozen=True)
class Given:
    """What is to be recorded; one field an option."""

    world: str
    duration: float | None = None
    seed: int | None = None
    topics: tuple[str, ...] = ()
    skip: tuple[str, ...] = ()
    overrides: tuple[str, ...] = ()
    spawn: tuple[str, ...] = ()
    params_files: tuple[str, ...] = ()
    cmd_vel: str | None = None
    script: Path | None = None
    plugin_paths: tuple[Path, ...] = ()
    source: Source = field(default_factory=lambda: source((), (), ()))


def keep(given: Given, folder: Path, *, force: bool = False) -> Record:
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
    scenario = scenario_of(given)
    with chdir("."):  # a plugin that goes elsewhere as it is loaded
        sim = open_scenario(scenario)
    try:
        check_used(sim.diagnostics)
        scenario = replace(scenario, commands=(*scenario.commands, *_commands(given, sim.topics())))
        record = run_record(scenario, sim=sim)
        if record.error is not None:
            raise record.error
        write_golden(folder, record)
    except BaseException:
        sim.close()
        raise
    return record


def scenario_of(given: Given) -> Scenario:
    """The scenario of a file, or of a world, with what the options say over it."""
    from simkit.scenario import Scenario
    from simkit.scenario.read import is_scenario_file, read_scenario

    asked: dict[str, Any] = {
        name: getattr(given, name) for name in ("duration", "seed") if getattr(given, name) is not None
    }
    asked |= {name: getattr(given, name) for name in ("topics", "skip") if getattr(given, name)}
    options: dict[str, Any] = {key: value for key, value in given.source.items() if value and value != "auto"}
    if given.plugin_paths:
        options["plugin_paths"] = given.plugin_paths
    if given.params_files:
        options["params_files"] = given.params_files
    if is_scenario_file(given.world):
        scenario = read_scenario(given.world)
        changed = bool(asked or options or given.overrides or given.spawn or given.cmd_vel or given.script)
        # what differs from the file is kept in the golden run itself
        scenario = replace(scenario, file=None if changed else scenario.file)
    else:
        scenario = Scenario(given.world)
    return replace(
        scenario,
        overrides=(*scenario.overrides, *given.overrides),
        spawn=(*scenario.spawn, *given.spawn),
        options={**scenario.options, **options},
        **asked,
    )


def _commands(given: Given, topics: dict[str, str]) -> list[dict[str, Any]]:
    from simkit.sinks.commands import read_script, steady_velocity

    found: list[Command] = []
    if given.cmd_vel is not None:
        found.append(steady_velocity(given.cmd_vel, topics))
    if given.script is not None:
        found += read_script(given.script, topics)
    return [_plain(command) for command in found]


def _plain(command: Command) -> dict[str, Any]:
    plain = {"at": command.at, "topic": command.topic, "message": command.message, "where": command.where}
    if command.until is not None:
        plain |= {"until": command.until, "rate": command.rate}
    return plain

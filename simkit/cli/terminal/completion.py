"""Shell completion with names from the running simulation or the bag.

Typer passes the incomplete command line to each function. The parameters of its context are the words before the
completed word.
"""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, redirect_stderr
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from simkit.cli.terminal.topic_sources import Source
    from simkit.live import Client

Completer = Callable[[typer.Context, str], list[str]]
"""Function that returns the completions of an incomplete word."""
_TIMEOUT = 1.0  # [s] of wall time that a shell waits at most
_INCOMPLETE = __name__  # key of the incomplete word in the context's meta


def silent(complete: Callable[[typer.Context], Iterable[str]]) -> Completer:
    """Return a completer that offers nothing after an error, because an error message would disturb the prompt."""

    def matching_names(ctx: typer.Context, incomplete: str) -> list[str]:
        try:
            ctx.meta[_INCOMPLETE] = incomplete
            with redirect_stderr(io.StringIO()):
                return [name for name in complete(ctx) if name.startswith(incomplete)]
        except Exception:  # noqa: BLE001
            return []

    return matching_names


@contextmanager
def connect_client(ctx: typer.Context) -> Iterator[Client]:
    """Connect to the running simulation that the line names."""
    from simkit.live import connect

    with connect(ctx.params.get("sim") or os.environ.get("SIMKIT_SIM"), timeout=_TIMEOUT) as client:
        yield client


@contextmanager
def open_topics(ctx: typer.Context) -> Iterator[Source]:
    """Open the bag or the running simulation that the line names, to read its topics."""
    from simkit.cli.terminal.topic_sources import BagSource, LiveSource
    from simkit.recording.bags.reader import open_bag_to_read

    bag = ctx.params.get("bag")
    if bag is not None:
        with open_bag_to_read(Path(bag)) as reader:
            yield BagSource(reader)
        return
    with connect_client(ctx) as client:
        yield LiveSource(client)


_WORLD_SUFFIXES = (".sdf", ".world", ".urdf", ".xacro", ".xml", ".model", ".mjcf")
_SCENARIO_SUFFIXES = (".yaml", ".yml", ".py")
_READ_SUFFIXES = (*_WORLD_SUFFIXES, ".yaml", ".yml")  # a scenario in Python is code, which no completion runs
_BAG_SUFFIXES = (".mcap", ".db3")


def incomplete_word(ctx: typer.Context) -> str:
    """Return the beginning of the word that a completer must complete."""
    return str(ctx.meta[_INCOMPLETE])


@silent
def worlds(ctx: typer.Context) -> Iterable[str]:
    """Complete names of bundled worlds and models, and world and model files."""
    return _worlds_and_files(ctx, _WORLD_SUFFIXES)


@silent
def scenarios(ctx: typer.Context) -> Iterable[str]:
    """Complete the same names as `worlds`, and scenario files."""
    return _worlds_and_files(ctx, _WORLD_SUFFIXES + _SCENARIO_SUFFIXES)


@silent
def runs(ctx: typer.Context) -> Iterable[str]:
    """Complete the same names as `scenarios`, and bundles; a folder can be a golden run."""
    return _worlds_and_files(ctx, _WORLD_SUFFIXES + _SCENARIO_SUFFIXES + (".zip",))


@silent
def bags(ctx: typer.Context) -> Iterable[str]:
    """Complete bags, and folders, which can be bags."""
    return _files(incomplete_word(ctx), _BAG_SUFFIXES)


@silent
def sources_and_fields(ctx: typer.Context) -> Iterable[str]:
    """Complete worlds, scenarios and bags; after a bag, a slash begins a topic of it."""
    if not incomplete_word(ctx).startswith("/"):
        return _worlds_and_files(ctx, _WORLD_SUFFIXES + _SCENARIO_SUFFIXES + _BAG_SUFFIXES)
    return _source_topics(ctx)


@silent
def source_topics(ctx: typer.Context) -> Iterable[str]:
    """Complete topics of the bag, or of the world or scenario with its spawned models, that the line names."""
    return _source_topics(ctx)


def _source_topics(ctx: typer.Context) -> list[str]:
    from simkit.loaders.resources.bundled_models import bundled_names
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit.testing.scenarios.scenario_file import read_run
    from simkit.testing.scenarios.scenario_run import open_scenario

    given = (value if isinstance(value, (list, tuple)) else [value] for value in ctx.params.values())
    sources = [str(word) for values in (*given, ctx.args) for word in values]
    bag = next((word for word in sources if word.endswith(_BAG_SUFFIXES)), None)
    if bag is not None:
        with open_bag_to_read(Path(bag)) as reader:
            return list(dict.fromkeys(topic.name for topic in reader.topics))
    source = next(word for word in sources if word.lower().endswith(_READ_SUFFIXES) or word in bundled_names())
    run = read_run(source)
    spawn = (*run.spawn, *(ctx.params.get("spawn_") or ()))
    with open_scenario(replace(run, spawn=spawn)) as sim:
        return list(sim.communication.bus.topics())


def realism(ctx: typer.Context) -> Iterable[str]:
    """Return the words, sets and files of `--realism`."""
    from simkit.sensors.realism import IDEAL_OR_DATASHEET, realism_sets

    return [*IDEAL_OR_DATASHEET, *realism_sets(), *_files(incomplete_word(ctx), (".yaml", ".yml"))]


def _worlds_and_files(ctx: typer.Context, suffixes: tuple[str, ...]) -> list[str]:
    from simkit.loaders.resources.bundled_models import bundled_names

    incomplete = incomplete_word(ctx)
    return list(dict.fromkeys([*bundled_names(), *_files(incomplete, suffixes)]))


def _files(incomplete: str, suffixes: tuple[str, ...]) -> list[str]:
    """Return the files and folders that begin with `incomplete`.

    A single folder is replaced by its content, because a shell ends a single completion with a space.
    """
    base, _, beginning = incomplete.rpartition("/")
    folder = f"{base}/" if "/" in incomplete else ""
    names: list[str] = []
    with os.scandir(folder or ".") as entries:
        for entry in entries:
            is_folder = entry.is_dir()
            if not entry.name.startswith(beginning) or (entry.name.startswith(".") and not beginning):
                continue
            if is_folder or entry.name.lower().endswith(suffixes):
                names.append(f"{folder}{entry.name}/" if is_folder else f"{folder}{entry.name}")
    if len(names) == 1 and names[0].endswith("/") and names[0] != incomplete:
        return _files(names[0], suffixes) or names
    return sorted(names)


@silent
def simulations(_: typer.Context) -> Iterable[str]:
    """Complete names of running simulations."""
    from simkit.live import simulations as running

    return [simulation.name for simulation in running()]


@silent
def topics(ctx: typer.Context) -> Iterable[str]:
    """Complete topics, with or without the leading slash."""
    with open_topics(ctx) as source:
        names = list(source.topics())
    incomplete = incomplete_word(ctx)
    return names if incomplete.startswith("/") or not incomplete else [n.removeprefix("/") for n in names]

"""Repetition of a recording's commands in a world: the run that lasts as long and hears the same messages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from simkit import RunSpec
from simkit.errors import InputError
from simkit.recording import open_bag_to_read
from simkit.recording.bags.playback import Playback

if TYPE_CHECKING:
    from simkit import Simulation

_NO_COMMANDS = "SK-BAG-016"


def repeated_run(run: RunSpec, bag: Path, topics: Sequence[str] = (), duration: float | None = None) -> RunSpec:
    """Return the run that repeats the commands of a recording; `run_scenario` runs it.

    Args:
        run: run of the world, without a bag.
        bag: recording.
        topics: topics of the commands, `TOPIC` or `OLD:=NEW`; empty for every topic that the world subscribes to.
        duration: longest simulated time [s]; None for the length of the recording.

    Raises:
        InputError: SK-CLI-035 the bag cannot be read.
    """
    with open_bag_to_read(bag) as reader:
        length = reader.duration
    length = length if duration is None else min(length, duration)
    return replace(run, play=str(bag.absolute()), play_topics=tuple(topics), duration=length, until="", timeout=None)


def command_topics(sim: Simulation, bag: Path, topics: Sequence[str] = ()) -> dict[str, str]:
    """Return the topics of a recording that a world hears, each with its topic in the world; empty for none.

    Args:
        sim: loaded world.
        bag: recording.
        topics: topics to play, `TOPIC` or `OLD:=NEW`; empty for every topic that the world subscribes to.

    Raises:
        InputError: SK-CLI-030 a topic is not there; SK-CLI-035 the bag cannot be read; SK-BAG-015 a type differs.
    """
    try:
        with Playback(sim, bag, topics) as playback:
            return dict(playback.names)
    except InputError as error:
        if error.code == _NO_COMMANDS:
            return {}
        raise

"""`simkit bag play`: the commands of a bag, into a running simulation, at their times."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from simkit.cli.options import Json
from simkit.cli.talking.options import Sim
from simkit.cli.talking.pace import SimClock
from simkit.cli.talking.printed import absolute, as_json, aside, quiet
from simkit.cli.talking.sources import running
from simkit.errors import InputError


@quiet
def play(
    recording: Annotated[
        Path, typer.Argument(help="An .mcap or .db3 file, or a folder of rosbag2.", metavar="BAG", show_default=False)
    ],
    topics: Annotated[
        list[str], typer.Option("--topics", help="Only this one; repeatable. Else all that the world takes.")
    ] = [],
    rate: Annotated[
        float, typer.Option("--rate", "-r", help="Times as fast, of simulated time.", metavar="N", min=1e-3)
    ] = 1.0,
    start: Annotated[
        float, typer.Option("--start-offset", help="Begins so far into the bag.", metavar="S", min=0)
    ] = 0.0,
    remap: Annotated[
        list[str], typer.Option("--remap", "-m", help="Plays OLD on NEW; repeatable.", metavar="OLD:=NEW")
    ] = [],
    loop: Annotated[bool, typer.Option("--loop", "-l", help="Again and again until Ctrl-C.")] = False,
    sim: Sim = None,
    json_: Json = False,
) -> int:
    """Plays the messages of a bag into a running simulation, by its clock."""
    from simkit.sinks.bag_reader import open_bag_to_read

    names = _remapped(remap)
    with open_bag_to_read(recording) as reader, running(sim) as client:
        there = list(dict.fromkeys(t.name for t in reader.topics))
        wanted = [absolute(t) for t in topics] or _taken(client, there, names)
        if not wanted:
            text = f"nothing of {recording} is taken here; --topics says what is to be played"
            raise InputError(f"SK-CLI-030 {text}", "SK-CLI-030")
        for unknown in [t for t in wanted if t not in there][:1]:
            next(reader.messages([unknown]))
        publishers = {
            t.name: client.advertise(names.get(t.name, t.name), t.type_name) for t in reader.topics if t.name in wanted
        }
        if not json_:
            aside(f"[INFO] [rosbag2_player]: playing {', '.join(publishers)}")
        count = _played(client, reader, publishers, rate, start)
        while loop and count:  # a round of nothing takes no time
            count += _played(client, reader, publishers, rate, start)
        client.flush()
    if json_:
        as_json({"messages": count, "topics": list(publishers)})
    return 0


def _remapped(pairs: list[str]) -> dict[str, str]:
    found = {}
    for text in pairs:
        old, sign, new = text.partition(":=")
        if not sign or not old or not new:
            raise InputError(f"SK-CLI-018 --remap: found {text!r}, allowed is OLD:=NEW", "SK-CLI-018")
        found[absolute(old)] = absolute(new)
    return found


def _taken(client: Any, topics: list[str], names: dict[str, str]) -> list[str]:
    """Those that the world's plugins take; its own readings are not said to it again."""
    inputs = {row["name"] for row in client.topics() if any(s.get("kind") != "client" for s in row["subscribers"])}
    return [t for t in topics if names.get(t, t) in inputs]


def _played(client: Any, reader: Any, publishers: dict[str, Any], rate: float, start: float) -> int:
    """Plays the bag once; how many messages that was."""
    clock = SimClock(client)
    first_ns = reader.start + round(start * 1e9)
    begun_ns = clock.now_ns()
    count = 0
    for message in reader.messages(list(publishers), first_ns):
        due_ns = begun_ns + round((message.time_ns - first_ns) / rate)
        if not clock.wait_until(due_ns, begun_ns):
            aside("note: the simulation was reset; what is left is not played")
            break
        publishers[message.topic].publish(message.data)
        count += 1
    return count

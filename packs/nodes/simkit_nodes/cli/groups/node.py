"""Run a program beside a running simulation; ping and end nodes of such programs."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.run_options import NONE_GIVEN
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.output import (
    JsonObject,
    absolute_name,
    not_found_error,
    print_line,
    print_status,
    without_interrupt_message,
)
from simkit.cli.terminal.topic_sources import connect_to_simulation, connection_name
from simkit.errors import InputError
from simkit.extend import GivenOptions, add_to_report, argument, option, report_errors, with_run_options

if TYPE_CHECKING:
    from simkit.live import Client

_PROCESS = "SK-NODE-070"
_WORDS = {"ignore_unknown_options": True, "allow_interspersed_args": False}

node = typer.Typer()


@completion.silent
def _complete_nodes(ctx: typer.Context) -> list[str]:
    """Complete nodes of the running simulation."""
    with completion.connect_client(ctx) as client:
        return list(client.ask("nodes"))


Name = Annotated[str, argument("Name of the node.", "NODE", _complete_nodes)]


@node.command(context_settings=_WORDS)
@report_errors
@without_interrupt_message
@with_run_options("package_paths")
def run(
    program: Annotated[str, argument("Python file, or PACKAGE/EXECUTABLE of a workspace.", "PROGRAM")],
    words: Annotated[
        list[str], argument("Arguments of the program, such as --ros-args -r a:=b.", "[ARGUMENT]...")
    ] = [],
    sim: options.Sim = None,
    wait: Annotated[float, option("Longest wait for a simulation that has not started yet.", "S")] = 0.0,
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> int:
    """Run a program for ROS in a process of its own, beside a running simulation. Options come before the program."""
    from simkit.live import connect
    from simkit_nodes.known_nodes import KnownNode
    from simkit_nodes.live_host import LiveHost
    from simkit_nodes.live_program import LiveProgram
    from simkit_nodes.node_options import NodeOptions
    from simkit_nodes.programs import program_source

    paths = given.values.get("package_paths", ())
    source = program_source(program, paths)
    if isinstance(source, KnownNode) and source.nothing:
        print_status(f"note: {source.name} has no effect here: {source.nothing}")
    with connect(sim, wait=wait) as client:
        path = client.path
    host = LiveHost(path, program.rpartition("/")[2].removesuffix(".py"))
    started = LiveProgram(host, source, NodeOptions(args=tuple(words), package_paths=paths))
    host.start(started)
    add_to_report(program=program)
    try:
        code = started.execute()
    finally:
        host.close()
    if host.closed is not None and code:
        raise host.closed
    if host.closed is not None:
        print_status(host.closed.message)
    return code


@node.command()
@report_errors
@without_interrupt_message
def ping(
    node: Name,
    count: Annotated[int, Option("--count", "-c", help="Number of pings.", min=1)] = 1,
    sim: options.Sim = None,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> None:
    """Measure how long a program in its own process, or the simulation of another node, needs to respond."""
    from simkit_nodes.live_host import PING

    with connect_to_simulation(sim) as client:
        name = _known_node(client, node)
        is_process = f"{name}/{PING}" in client.services()
        pings: list[JsonObject] = []
        for _ in range(count):
            begun = time.perf_counter()
            if is_process:
                place = f"process {client.call(f'{name}/{PING}').message}"
            else:
                client.flush()
                place = "part of the simulation"
            elapsed = (time.perf_counter() - begun) * 1e3
            pings.append({"node": name, "place": place, "milliseconds": round(elapsed, 3)})
            add_to_report(pings=pings)
            print_line(f"{name}: {place}, {elapsed:.1f} ms")


@node.command()
@report_errors
@without_interrupt_message
def kill(
    nodes: Annotated[list[str], argument("Names of the nodes.", "NODE...", _complete_nodes)],
    sim: options.Sim = None,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> None:
    """End programs in their own processes, as Ctrl-C does."""
    from simkit_nodes.live_host import KILL

    with connect_to_simulation(sim) as client:
        names = [_program_node(client, each) for each in nodes]
        add_to_report(ended=names)
        for name in names:
            client.call(f"{name}/{KILL}")
            print_line(f"{name}: ended")


def _program_node(client: Client, node: str) -> str:
    """Return the full name of a node of a program in its own process.

    Raises:
        InputError: there is no such node, or it is a part of the simulation.
    """
    from simkit_nodes.live_host import PING

    name = _known_node(client, node)
    if f"{name}/{PING}" not in client.services():
        text = f"node {name!r} runs in the process of the simulation, or in one that simkit did not start"
        raise InputError(_PROCESS, text, help="only nodes of `simkit node run` can be ended")
    return name


def _known_node(client: Client, node: str) -> str:
    """Return the full name of a node.

    Raises:
        InputError: there is no such node.
    """
    name = absolute_name(node)
    names = list(client.ask("nodes"))
    if name not in names:
        raise not_found_error("node", name, names, "SK-CLI-034", connection_name(client))
    return name

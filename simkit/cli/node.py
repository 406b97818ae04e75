"""The command `simkit node`: show plugins and sensors of a running simulation as nodes, as `ros2 node` does."""

from __future__ import annotations

from typing import Annotated

import typer
from typer import Option

from simkit.cli.terminal import completion, options
from simkit.cli.terminal.options import argument, live_command
from simkit.cli.terminal.output import (
    JsonObject,
    absolute_name,
    is_hidden,
    not_found_error,
    print_json,
    print_line,
    print_names,
)
from simkit.cli.terminal.topic_sources import connect_to_simulation, connection_name, node_names

node = typer.Typer(help="Nodes of a running simulation: its plugins, sensors and clients.", no_args_is_help=True)
Hidden = Annotated[bool, Option("--all", "-a", "--include-hidden", help="Shows hidden ones too.")]


@live_command(node, "list")
def list_(
    hidden: Hidden = False,
    count: Annotated[bool, Option("--count-nodes", "-c", help="Says only how many.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Lists the nodes."""
    with connect_to_simulation(sim) as client:
        found = node_names(client, hidden=hidden)
    print_names(found, count=count, json_=json_)


@live_command(node)
def info(
    node: Annotated[str, argument("Name of a node.", "NODE", completion.all_nodes)],
    hidden: Hidden = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Says what a node publishes, takes and offers."""
    with connect_to_simulation(sim) as client:
        nodes: dict[str, JsonObject] = client.ask("nodes")
    wanted = absolute_name(node)
    if wanted not in nodes:
        raise not_found_error(
            "node", wanted, [n for n in nodes if not is_hidden(n)], "SK-CLI-034", connection_name(client)
        )
    found = nodes[wanted]
    if json_:
        print_json({"name": wanted, **found})
        return
    print_line(wanted)
    for title, key in (
        ("Subscribers", "subscribers"),
        ("Publishers", "publishers"),
        ("Service Servers", "services"),
        ("Service Clients", ""),
        ("Action Servers", "actions"),
        ("Action Clients", ""),
    ):
        print_line(f"  {title}:")
        rows = [(n, t) for n, t in sorted(found.get(key, {}).items()) if hidden or not is_hidden(n)]
        for name, types in rows:
            print_line(f"    {name}: {', '.join(types)}")
        if not rows:
            print_line()

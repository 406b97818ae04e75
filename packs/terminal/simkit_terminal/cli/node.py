"""List the nodes of a running simulation."""

from __future__ import annotations

from typing import Annotated

import typer
from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import absolute_name, print_json, print_line
from simkit.cli.terminal.topic_sources import connect_to_simulation
from simkit.extend import argument
from simkit.msgs.topic_names import is_hidden
from simkit_terminal.cli.terminal import completion
from simkit_terminal.cli.terminal.live_command import live_command
from simkit_terminal.cli.terminal.name_lists import print_names
from simkit_terminal.cli.terminal.named_endpoints import node_endpoints, node_names

LISTED_AFTER = "action"

node = typer.Typer(help="List the nodes of a running simulation.", no_args_is_help=True)
Hidden = Annotated[bool, Option("--all", "-a", "--include-hidden", help="Include hidden names.")]


@live_command(node, "list")
def list_(
    hidden: Hidden = False,
    count: Annotated[bool, Option("--count-nodes", "-c", help="Print only the number of nodes.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """List the nodes."""
    with connect_to_simulation(sim) as client:
        names = node_names(client, hidden=hidden)
    print_names(names, count=count, json_=json_)


@live_command(node)
def info(
    node: Annotated[str, argument("Name of the node.", "NODE", completion.all_nodes)],
    hidden: Hidden = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Print the publishers, subscribers, services and actions of a node."""
    with connect_to_simulation(sim) as client:
        endpoints = node_endpoints(client, node)
    node_name = absolute_name(node)
    if json_:
        print_json({"name": node_name, **endpoints})
        return
    print_line(node_name)
    for title, key in (
        ("Subscribers", "subscribers"),
        ("Publishers", "publishers"),
        ("Service Servers", "services"),
        ("Service Clients", "service_clients"),
        ("Action Servers", "actions"),
        ("Action Clients", "action_clients"),
    ):
        print_line(f"  {title}:")
        rows = [(n, t) for n, t in sorted(endpoints.get(key, {}).items()) if hidden or not is_hidden(n)]
        for name, types in rows:
            print_line(f"    {name}: {', '.join(types)}")
        if not rows:
            print_line()

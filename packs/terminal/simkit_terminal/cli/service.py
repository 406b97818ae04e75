"""List and call the services of a running simulation."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import absolute_name, print_json, print_line
from simkit.cli.terminal.topic_sources import connect_to_simulation
from simkit.extend import argument, option
from simkit.msgs.topic_names import is_hidden
from simkit_terminal.cli.terminal import completion
from simkit_terminal.cli.terminal.live_command import live_command
from simkit_terminal.cli.terminal.message_arguments import (
    check_type,
    is_same_type,
    make_message,
    split_type_and_words,
)
from simkit_terminal.cli.terminal.name_lists import print_names, print_names_and_types
from simkit_terminal.cli.terminal.named_endpoints import interface_type, node_endpoints
from simkit_terminal.cli.terminal.positional_values import read_fields

if TYPE_CHECKING:
    from simkit.live import Client
    from simkit.msgs import Message

LISTED_AFTER = "topic"

_VALUES_HELP = "Request as YAML: '{data: true}', or one value for each field, as in `rosservice call`."
service = typer.Typer(help="List and call the services of a running simulation.", no_args_is_help=True)
Name = Annotated[str, argument("Name of the service.", "SERVICE", completion.services)]
Count = Annotated[bool, Option("--count-services", "--count", "-c", help="Print only the number of services.")]


@live_command(service, "list")
def list_(
    show_types: options.ShowTypes = False,
    count: Count = False,
    hidden: Annotated[bool, Option("--include-hidden-services", "-a", "--all", help="Include hidden names.")] = False,
    node: Annotated[str | None, option("List only those of this node.", "NODE", complete=completion.nodes)] = None,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """List the services."""
    with connect_to_simulation(sim) as client:
        type_by_service = {n: t for n, t in sorted(client.services().items()) if hidden or not is_hidden(n)}
        if node is not None:
            offered = node_endpoints(client, node)["services"]
            type_by_service = {n: t for n, t in type_by_service.items() if n in offered}
    print_names_and_types(type_by_service, show_types=show_types, count=count, json_=json_)


@live_command(service, "type")
def type_(service: Name, sim: options.Sim = None, json_: options.Json = False) -> None:
    """Print the type of a service."""
    with connect_to_simulation(sim) as client:
        known_type = interface_type(client, "service", client.services(), service)
    print_names([known_type], json_=json_)


@live_command(service)
def info(service: Name, sim: options.Sim = None, json_: options.Json = False) -> None:
    """Print type, clients and servers of a service."""
    with connect_to_simulation(sim) as client:
        known_type = interface_type(client, "service", client.services(), service)
        nodes = client.ask("nodes")
    name = absolute_name(service)
    clients = sum(name in has["service_clients"] for has in nodes.values())
    if json_:
        print_json({"name": name, "types": [known_type], "clients": clients, "services": 1})
    else:
        print_line(f"Type: {known_type}\nClients count: {clients}\nServices count: 1")


@live_command(service)
def args(service: Name, sim: options.Sim = None, json_: options.Json = False) -> None:
    """Print the names of the fields of a service's request, as `rosservice args`."""
    from simkit.msgs.interface_definitions import prototype

    with connect_to_simulation(sim) as client:
        known_type = interface_type(client, "service", client.services(), service)
        client.interfaces()  # the type may be one that only the simulation knows
    names = list(prototype(known_type))
    if json_:
        print_json(names)
    else:
        print_line(" ".join(names))


@live_command(service)
def find(
    service_type: Annotated[str, argument("Type such as std_srvs/srv/Empty.", "TYPE", completion.service_types)],
    count: Count = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """List the services of a type."""
    with connect_to_simulation(sim) as client:
        names = [name for name, full in sorted(client.services().items()) if is_same_type(service_type, full)]
    print_names(names, count=count, json_=json_)


@live_command(service)
def call(
    service: Name,
    service_type: Annotated[
        str | None, argument("Type of the service (optional).", "[TYPE]", completion.service_types)
    ] = None,
    values: Annotated[list[str] | None, argument(_VALUES_HELP, "[VALUES]...", completion.service_values)] = None,
    stdin: Annotated[bool, Option("--stdin", help="Read the request from standard input.")] = False,
    rate: Annotated[
        float | None, option("Repeat the call N times a second (wall time).", "N", "--rate", "-r", min=1e-3)
    ] = None,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Call a service and print the response."""
    service_type, words = split_type_and_words(service_type, values)
    if stdin:
        words = [sys.stdin.read()]
    with connect_to_simulation(sim) as client:
        name = absolute_name(service)
        known_type = interface_type(client, "service", client.services(), service)
        check_type(service_type, [known_type], name)
        fields = read_fields(f"{known_type}_Request", words, "the request")
        request = make_message(f"{known_type}_Request", fields)
        while True:
            begun = time.monotonic()
            _call_once(client, name, request, json_)
            if rate is None:
                return
            time.sleep(max(0.0, begun + 1.0 / rate - time.monotonic()))


def _call_once(client: Client, name: str, request: Message, json_: bool) -> None:
    from simkit.msgs.message_text import message_to_dict, to_python

    if not json_:
        print_line(f"requester: making request: {to_python(request)}\n")
    response = client.call(name, request)
    if json_:
        print_json(message_to_dict(response))
    else:
        print_line(f"response:\n{to_python(response)}\n")

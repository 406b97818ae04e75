"""`simkit service`: the services of a running simulation, as `ros2 service` shows and calls them."""

from __future__ import annotations

import sys
import time
from typing import Annotated, Any

import typer

from simkit.cli.options import Json
from simkit.cli.talking import completion
from simkit.cli.talking.options import Ros2Command, Sim
from simkit.cli.talking.printed import absolute, as_json, given, is_hidden, line, none_of, quiet
from simkit.cli.talking.sources import running
from simkit.cli.talking.topic_pub import type_and_values
from simkit.errors import InputError, MessageError

service = typer.Typer(help="Services of a running simulation.", no_args_is_help=True)
Name = Annotated[
    str,
    typer.Argument(
        help="Name of a service.", metavar="SERVICE", show_default=False, autocompletion=completion.services
    ),
]


@service.callback()
def _group() -> None:
    """Services of a running simulation."""


@service.command("list", cls=Ros2Command)
@quiet
def list_(
    show_types: Annotated[bool, typer.Option("--show-types", "-t", help="Shows the types too.")] = False,
    count: Annotated[bool, typer.Option("--count-services", "--count", "-c", help="Says only how many.")] = False,
    hidden: Annotated[
        bool, typer.Option("--include-hidden-services", "-a", "--all", help="Shows hidden ones too.")
    ] = False,
    sim: Sim = None,
    json_: Json = False,
) -> int:
    """Lists the services."""
    with running(sim) as client:
        found = {n: t for n, t in sorted(client.services().items()) if hidden or not is_hidden(n)}
    if json_:
        as_json(len(found) if count else [{"name": n, "types": [t]} for n, t in found.items()])
    elif count:
        line(str(len(found)))
    else:
        for name, type_name in found.items():
            line(f"{name} [{type_name}]" if show_types else name)
    return 0


@service.command("type", cls=Ros2Command)
@quiet
def type_(service: Name, sim: Sim = None, json_: Json = False) -> int:
    """Prints a service's type."""
    with running(sim) as client:
        found = type_of(client, service)
    if json_:
        as_json([found])
    else:
        line(found)
    return 0


@service.command(cls=Ros2Command)
@quiet
def info(service: Name, sim: Sim = None, json_: Json = False) -> int:
    """Says of what type a service is."""
    with running(sim) as client:
        found = type_of(client, service)
    if json_:
        as_json({"name": absolute(service), "types": [found], "clients": 0, "services": 1})
    else:
        line(f"Type: {found}\nClients count: 0\nServices count: 1")
    return 0


@service.command(cls=Ros2Command)
@quiet
def find(
    service_type: Annotated[
        str,
        typer.Argument(
            help="Such as std_srvs/srv/Empty.",
            metavar="TYPE",
            show_default=False,
            autocompletion=completion.service_types,
        ),
    ],
    count: Annotated[bool, typer.Option("--count-services", "--count", "-c", help="Says only how many.")] = False,
    sim: Sim = None,
    json_: Json = False,
) -> int:
    """Lists the services of a type."""
    package, _, short = service_type.partition("/")
    with running(sim) as client:
        found = [n for n, t in sorted(client.services().items()) if t in (service_type, f"{package}/srv/{short}")]
    if json_:
        as_json(len(found) if count else found)
    else:
        for name in [str(len(found))] if count else found:
            line(name)
    return 0


@service.command(cls=Ros2Command)
@quiet
def call(
    service: Name,
    service_type: Annotated[
        str | None,
        typer.Argument(
            help="Its type, which need not be said.",
            metavar="[TYPE]",
            show_default=False,
            autocompletion=completion.service_types,
        ),
    ] = None,
    values: Annotated[
        str | None,
        typer.Argument(
            help="The request as YAML: '{data: true}'.",
            metavar="[VALUES]",
            show_default=False,
            autocompletion=completion.service_values,
        ),
    ] = None,
    stdin: Annotated[bool, typer.Option("--stdin", help="Reads the request from standard input.")] = False,
    rate: Annotated[
        float | None,
        typer.Option("--rate", "-r", help="Calls it again N times a second (wall time).", metavar="N", min=1e-3),
    ] = None,
    sim: Sim = None,
    json_: Json = False,
) -> int:
    """Calls a service and prints the response."""
    service_type, values = type_and_values(service_type, values)
    fields = given(sys.stdin.read() if stdin else values or "{}", "the request")
    with running(sim) as client:
        name = absolute(service)
        found = type_of(client, service)
        check(service_type, found, name)
        request = made(f"{found}_Request", fields)
        while True:
            begun = time.monotonic()
            _one_call(client, name, request, json_)
            if rate is None:
                return 0
            time.sleep(max(0.0, begun + 1.0 / rate - time.monotonic()))


def _one_call(client: Any, name: str, request: Any, json_: bool) -> None:
    from simkit.msgs.text import plain, python_of

    if not json_:
        line(f"requester: making request: {python_of(request)}\n")
    response = client.call(name, request)
    if json_:
        as_json(plain(response))
    else:
        line(f"response:\n{python_of(response)}\n")


def type_of(client: Any, name: str) -> str:
    """The type of a service.

    Raises:
        InputError: SK-CLI-037 there is none of that name.
    """
    services = client.services()
    wanted = absolute(name)
    if wanted not in services:
        raise none_of("service", wanted, services, "SK-CLI-037", f"the simulation {client.info.get('name', '')!r}")
    return str(services[wanted])


def check(said: str | None, found: str, name: str) -> None:
    """Raises where a service or action is of another type than was said.

    Raises:
        InputError: SK-CLI-032 it is.
    """
    if (
        said is not None
        and said.split("/")[0::2][:2] != found.split("/")[0::2]
        and said.split("/") != (found.split("/")[0::2])
    ):
        raise InputError(f"SK-CLI-032 {name} is of type {found}, found {said!r}", "SK-CLI-032")


def made(type_name: str, fields: dict[str, Any]) -> Any:
    """A message of what was given.

    Raises:
        InputError: SK-CLI-031 it does not fit the type.
    """
    from simkit import msgs

    try:
        return msgs.make(type_name, **fields)
    except MessageError as error:
        raise InputError(f"SK-CLI-031 {error}", "SK-CLI-031") from None

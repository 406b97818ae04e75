"""List and show the types of messages, services and actions."""

from __future__ import annotations

import sys
from contextlib import suppress
from typing import Annotated

import typer
from typer import Argument, Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import not_found_error, print_json, print_line, without_interrupt_message
from simkit.errors import InputError, MessageError
from simkit.extend import argument, report_errors
from simkit_terminal.cli.terminal import completion
from simkit_terminal.cli.terminal.name_lists import print_names

LISTED_AFTER = "log"

_KINDS = (("msg", "Messages"), ("srv", "Services"), ("action", "Actions"))
interface = typer.Typer(help="List and show the types of messages, services and actions.", no_args_is_help=True)
TypeName = Annotated[
    str, argument("Type such as geometry_msgs/msg/Twist; - for standard input.", "TYPE", completion.interfaces)
]


@interface.command("list")
@report_errors
@without_interrupt_message
def list_(
    only_msgs: Annotated[bool, Option("--only-msgs", "-m", help="List only message types.")] = False,
    only_srvs: Annotated[bool, Option("--only-srvs", "-s", help="List only service types.")] = False,
    only_actions: Annotated[bool, Option("--only-actions", "-a", help="List only action types.")] = False,
    json_: options.Json = False,
) -> None:
    """List the types that simkit knows."""
    from simkit.msgs.interface_definitions import interface_names

    requested_kinds = {"msg": only_msgs, "srv": only_srvs, "action": only_actions}
    kinds = [(kind, title) for kind, title in _KINDS if requested_kinds[kind] or not any(requested_kinds.values())]
    if json_:
        print_json({kind: interface_names(kind) for kind, _ in kinds})
        return
    for kind, title in kinds:
        print_line(f"{title}:")
        for name in interface_names(kind):
            print_line(f"    {name}")


@interface.command()
@report_errors
@without_interrupt_message
def packages(json_: options.Json = False) -> None:
    """List the packages that define types."""
    from simkit.msgs.interface_definitions import interface_names

    package_names = sorted({name.split("/")[0] for kind, _ in _KINDS for name in interface_names(kind)})
    print_names(package_names, json_=json_)


@interface.command()
@report_errors
@without_interrupt_message
def package(name: Annotated[str, Argument(metavar="PACKAGE", show_default=False)], json_: options.Json = False) -> None:
    """List the types of a package."""
    from simkit.msgs.interface_definitions import interface_names

    known = [n for kind, _ in _KINDS for n in interface_names(kind)]
    matching = [n for n in known if n.split("/")[0] == name]
    if not matching:
        raise not_found_error("package", name, sorted({n.split("/")[0] for n in known}), "SK-CLI-032", "simkit")
    print_names(matching, json_=json_)


@interface.command()
@report_errors
@without_interrupt_message
def show(
    type_: TypeName,
    all_comments: Annotated[bool, Option("--all-comments", help="Print the comments of nested types, too.")] = False,
    no_comments: Annotated[bool, Option("--no-comments", help="Leave out comments.")] = False,
    bag: options.Bag = None,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Print the definition of a type, followed by the definitions of its nested types."""
    from simkit.msgs.interface_definitions import interface_text

    name = _read(type_)
    try:
        if bag is None:
            _define_if_unknown(name, sim)
            text = interface_text(name, comments=not no_comments, all_comments=all_comments)
        else:
            text = _of_bag(name, bag, comments=not no_comments, all_comments=all_comments)
    except MessageError as error:
        raise InputError("SK-CLI-032", str(error)) from None
    if json_:
        print_json({"type": name, "definition": text})
    else:
        print_line(text)


def _of_bag(name: str, bag: object, *, comments: bool, all_comments: bool) -> str:
    """Return the definition of a type as stored in a bag."""
    from simkit.msgs.interface_definitions import interface_text
    from simkit.recording.bags.reader import open_bag_to_read

    with open_bag_to_read(str(bag)) as reader:
        package_name, _, short = name.partition("/")
        long = name if name.count("/") == 2 else f"{package_name}/msg/{short}"
        return interface_text(long, comments=comments, all_comments=all_comments, store=reader.store_of(long))


@interface.command()
@report_errors
@without_interrupt_message
def proto(
    type_: TypeName,
    no_quotes: Annotated[bool, Option("--no-quotes", help="Leave out the quotes around the text.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Print a message with all fields, as a template."""
    from simkit.msgs.interface_definitions import prototype
    from simkit.msgs.message_text import to_yaml

    name = _read(type_)
    _define_if_unknown(name, sim)
    try:
        fields = prototype(name)
    except MessageError as error:
        raise InputError("SK-CLI-032", str(error)) from None
    if json_:
        print_json(fields)
    else:
        text = to_yaml(fields)
        print_line(text if no_quotes else f'"{text}"')


def _define_if_unknown(type_name: str, sim: str | None) -> None:
    """Define the types that a running simulation knows, if this process does not know a type."""
    from simkit.live import LiveError, connect, simulations
    from simkit.msgs.interface_definitions import full_interface_name

    try:
        full_interface_name(type_name)
    except MessageError:
        for name in [sim] if sim else [each.name for each in simulations()]:
            with suppress(LiveError), connect(name) as client:
                client.interfaces()


def _read(type_name: str) -> str:
    return sys.stdin.readline().strip() if type_name == "-" else type_name

"""The command `simkit param`: show and change live parameters of a running simulation, as `ros2 param` does."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.terminal import completion, options
from simkit.cli.terminal.message_arguments import compile_pattern
from simkit.cli.terminal.options import argument, live_command, option
from simkit.cli.terminal.output import (
    JsonObject,
    absolute_name,
    not_found_error,
    print_json,
    print_line,
    print_note,
    report_errors_quietly,
)
from simkit.cli.terminal.parameter_values import KINDS, parse_parameter_value, plain_value, read_parameter_file
from simkit.cli.terminal.topic_sources import LIST_PARAMETERS, connect_to_simulation, connection_name, parameter_nodes
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.live import Client
    from simkit.msgs import ParameterValue

param = typer.Typer(help="Live parameters of a running simulation.", no_args_is_help=True)
Node = Annotated[str, argument("Name of a node.", "NODE", completion.nodes)]
Names = Annotated[list[str], argument("Names of parameters.", "NAME...", completion.parameters)]
Name = Annotated[str, argument("Name of a parameter.", "NAME", completion.parameters)]


@live_command(param, "list")
def list_(
    node: Annotated[str | None, argument("Only of this one.", "[NODE]", completion.nodes)] = None,
    param_type: Annotated[bool, Option("--param-type", help="Shows the types too.")] = False,
    prefix: Annotated[list[str], option("Only names that begin so; repeatable.", "PREFIX", "--param-prefixes")] = [],
    filter_: Annotated[str | None, option("Only names this regular expression fits.", "REGEX", "--filter")] = None,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Lists nodes with parameters and these."""
    wanted = compile_pattern(filter_, "--filter")
    found: dict[str, dict[str, str]] = {}
    with connect_to_simulation(sim) as client:
        for name in parameter_nodes(client) if node is None else [_resolve_node(client, node)]:
            names = sorted(client.call(name + LIST_PARAMETERS, {"prefixes": prefix}).result.names)
            names = [n for n in names if wanted is None or wanted.search(n)]
            types = client.call(f"{name}/get_parameter_types", {"names": names}).types if names else []
            found[name] = {n: KINDS[int(t)] for n, t in zip(names, types, strict=True)}
    if json_:
        print_json(found)
        return
    for name, parameters in found.items():
        if node is None:
            print_line(f"{name}:")
        for parameter, kind in parameters.items():
            print_line(f"  {parameter} (type: {kind})" if param_type else f"  {parameter}")


@live_command(param)
def get(
    node: Node,
    name: Name,
    hide_type: Annotated[bool, Option("--hide-type", help="The value alone.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Prints the value of a parameter."""
    with connect_to_simulation(sim) as client:
        full = _resolve_node(client, node)
        found = _existing_values(client, full, [name])[0]
    value = plain_value(found)
    if json_:
        print_json(value)
    elif hide_type:
        print_line(str(value))
    else:
        kind = KINDS[int(found.type)]
        label = kind.removesuffix(" array").capitalize()
        print_line(f"{label} {'values are' if kind.endswith('array') else 'value is'}: {_value_text(value, kind)}")


def _value_text(value: object, kind: str) -> str:
    code = {"double array": "d", "integer array": "q"}.get(kind)
    return f"array('{code}', {value!r})" if code and value else f"array('{code}')" if code else str(value)


@param.command("set", cls=options.Ros2Command, context_settings={"ignore_unknown_options": True})
@report_errors_quietly
def set_(
    node: Node,
    pairs: Annotated[list[str], argument("Names and values: p_gain 12.5.", "NAME VALUE...", completion.parameters)],
    atomic: Annotated[bool, Option("--atomic", help="All of them or none.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> int:
    """Changes parameters; exit code 2 where one is refused."""
    if len(pairs) % 2:
        text = f"found {len(pairs)} words, allowed are pairs: name value [name value ...]"
        raise InputError(f"SK-CLI-031 the parameters: {text}", "SK-CLI-031")
    values = list(zip(pairs[::2], [parse_parameter_value(text) for text in pairs[1::2]], strict=True))
    with connect_to_simulation(sim) as client:
        return _set_values(client, _resolve_node(client, node), values, atomic, json_)


def _set_values(client: Client, node: str, values: list[tuple[str, JsonObject]], atomic: bool, json_: bool) -> int:
    request = {"parameters": [{"name": n, "value": v} for n, v in values]}
    if atomic:
        results = [client.call(f"{node}/set_parameters_atomically", request).result]
    else:
        results = client.call(f"{node}/set_parameters", request).results
    if json_:
        print_json([{"successful": bool(r.successful), "reason": r.reason} for r in results])
    for (name, _), result in zip(values, results, strict=not atomic):
        if json_:
            break
        head = f"{name}: " if len(values) > 1 and not atomic else ""
        what = "parameters atomically" if atomic else "parameter"
        good, bad = f"{head}Set {what} successful", f"{head}Setting {what} failed"
        reason = f": {result.reason}" if result.reason else ""
        (print_line if result.successful else print_note)((good if result.successful else bad) + reason)
    return 0 if all(r.successful for r in results) else 2


@live_command(param)
def delete(node: Node, name: Name, sim: options.Sim = None, json_: options.Json = False) -> int:
    """Deletes a parameter, which no node here allows."""
    with connect_to_simulation(sim) as client:
        full = _resolve_node(client, node)
        _existing_values(client, full, [name])
    text = f"Deleting parameter failed: {name} is declared by {full}, which needs it"
    if json_:
        print_json({"successful": False, "reason": text.partition(": ")[2]})
    else:
        print_note(text)
    return 2


@live_command(param)
def describe(node: Node, names: Names, sim: options.Sim = None, json_: options.Json = False) -> None:
    """Says what parameters are, and what they take."""
    from simkit.msgs.message_text import message_to_dict

    with connect_to_simulation(sim) as client:
        full = _resolve_node(client, node)
        _existing_values(client, full, names)
        found = client.call(f"{full}/describe_parameters", {"names": names}).descriptors
    if json_:
        print_json([message_to_dict(d) | {"type": KINDS[int(d.type)]} for d in found])
        return
    for one in found:
        print_line(f"Parameter name: {one.name}\n  Type: {KINDS[int(one.type)]}")
        if one.description:
            print_line(f"  Description: {one.description}")
        print_line("  Constraints:")
        if one.read_only:
            print_line("    Read only: true")
        for bounds in [*one.floating_point_range, *one.integer_range][:1]:
            print_line(f"    Min value: {bounds.from_value}\n    Max value: {bounds.to_value}")
            if bounds.step:
                print_line(f"    Step: {bounds.step}")
        if one.additional_constraints:
            print_line(f"    Additional constraints: {one.additional_constraints}")


@live_command(param)
def dump(node: Node, sim: options.Sim = None, json_: options.Json = False) -> None:
    """Prints all parameters of a node as a parameter file."""
    from simkit.msgs.message_text import to_yaml as as_yaml

    with connect_to_simulation(sim) as client:
        full = _resolve_node(client, node)
        names = sorted(client.call(full + LIST_PARAMETERS, {}).result.names)
        values = client.call(f"{full}/get_parameters", {"names": names}).values
    tree: JsonObject = {}
    for name, value in zip(names, values, strict=True):
        *above, last = name.split(".")
        place = tree
        for part in above:
            place = place.setdefault(part, {})
        place[last] = plain_value(value)
    found = {full: {"ros__parameters": tree}}
    if json_:
        print_json(found)
    else:
        print_line(as_yaml(found))


@live_command(param)
def load(
    node: Node,
    file: Annotated[Path, argument("A parameter file.", "FILE.yaml")],
    no_wildcard: Annotated[bool, Option("--no-use-wildcard", help="Leaves out what stands for all: /**.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> int:
    """Takes the values of a parameter file for a node; exit code 2 where one is refused."""
    with connect_to_simulation(sim) as client:
        full = _resolve_node(client, node)
        values = read_parameter_file(file, full, wildcard=not no_wildcard)
        request = {"parameters": [{"name": n, "value": v} for n, v in values]}
        results = client.call(f"{full}/set_parameters", request).results
    rows = [(n, bool(r.successful), str(r.reason)) for (n, _), r in zip(values, results, strict=True)]
    if json_:
        print_json([{"name": n, "successful": good, "reason": reason} for n, good, reason in rows])
    for name, good, reason in () if json_ else rows:
        text = f"Set parameter {name} {'successful' if good else 'failed'}{': ' + reason if reason else ''}"
        (print_line if good else print_note)(text)
    return 0 if all(good for _, good, _ in rows) else 2


def _resolve_node(client: Client, name: str) -> str:
    nodes = parameter_nodes(client)
    wanted = absolute_name(name)
    if wanted not in nodes:
        raise not_found_error("node with parameters", wanted, nodes, "SK-CLI-034", connection_name(client))
    return wanted


def _existing_values(client: Client, node: str, names: list[str]) -> list[ParameterValue]:
    """The values of parameters, which are there."""
    values = list(client.call(f"{node}/get_parameters", {"names": names}).values)
    for name, value in zip(names, values, strict=True):
        if not int(value.type):
            there = client.call(node + LIST_PARAMETERS, {}).result.names
            raise not_found_error("parameter", name, sorted(there), "SK-CLI-034", f"node {node}")
    return values

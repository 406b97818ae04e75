"""List, read and set the parameters of a running simulation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.options import compile_pattern
from simkit.cli.terminal.output import (
    JsonObject,
    JsonValue,
    absolute_name,
    not_found_error,
    print_json,
    print_line,
    print_message,
    without_interrupt_message,
)
from simkit.cli.terminal.topic_sources import connect_to_simulation, connection_name
from simkit.errors import InputError
from simkit.extend import argument, counted, option, report_errors
from simkit_terminal.cli.terminal import completion
from simkit_terminal.cli.terminal.global_parameters import GlobalParameters, read_parameter_tree
from simkit_terminal.cli.terminal.live_command import Ros2Command, live_command
from simkit_terminal.cli.terminal.named_endpoints import LIST_PARAMETERS, parameter_nodes
from simkit_terminal.cli.terminal.parameter_values import (
    KINDS,
    parse_parameter_value,
    plain_value,
    plain_yaml,
    read_parameter_file,
)

if TYPE_CHECKING:
    from simkit.live import Client
    from simkit.msgs import ParameterValue

LISTED_AFTER = "service"

param = typer.Typer(help="List, read and set the parameters of a running simulation.", no_args_is_help=True)
Node = Annotated[str, argument("Name of the node.", "NODE", completion.nodes)]
NodeOrName = Annotated[
    str, argument("Name of the node, or global name of a parameter as in rosparam.", "NODE", completion.nodes)
]
OptionalName = Annotated[str | None, argument("Name of the parameter.", "[NAME]", completion.parameters)]
Names = Annotated[list[str], argument("Names of the parameters.", "NAME...", completion.parameters)]
Name = Annotated[str, argument("Name of the parameter.", "NAME", completion.parameters)]


@live_command(param, "list")
def list_(
    node: Annotated[str | None, argument("Name of a node; default: all nodes.", "[NODE]", completion.nodes)] = None,
    param_type: Annotated[bool, Option("--param-type", help="Show the types, too.")] = False,
    prefix: Annotated[list[str], option("Prefix of the names; repeatable.", "PREFIX", "--param-prefixes")] = [],
    filter_: Annotated[str | None, option("List only names that match.", "REGEX", "--filter")] = None,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """List the nodes and their parameters."""
    pattern = compile_pattern(filter_, "--filter")
    types_by_node: dict[str, dict[str, str]] = {}
    with connect_to_simulation(sim) as client:
        for name in parameter_nodes(client) if node is None else [_resolve_node(client, node)]:
            names = sorted(client.call(name + LIST_PARAMETERS, {"prefixes": prefix}).result.names)
            names = [n for n in names if pattern is None or pattern.search(n)]
            types = client.call(f"{name}/get_parameter_types", {"names": names}).types if names else []
            types_by_node[name] = {n: KINDS[int(t)] for n, t in zip(names, types, strict=True)}
    if json_:
        print_json(types_by_node)
        return
    for name, parameters in types_by_node.items():
        if node is None:
            print_line(f"{name}:")
        for parameter, kind in parameters.items():
            print_line(f"  {parameter} (type: {kind})" if param_type else f"  {parameter}")


@live_command(param)
def get(
    node: NodeOrName,
    name: OptionalName = None,
    hide_type: Annotated[bool, Option("--hide-type", help="Print only the value.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Print the value of a parameter, or with one global name all values below it, as `rosparam get /`."""
    if name is None:
        _print_global_value(node, sim, json_)
        return
    with connect_to_simulation(sim) as client:
        full = _resolve_node(client, node)
        parameter_value = _existing_values(client, full, [name])[0]
    value = plain_value(parameter_value)
    if json_:
        print_json(value)
    elif hide_type:
        print_line(str(value))
    else:
        kind = KINDS[int(parameter_value.type)]
        label = kind.removesuffix(" array").capitalize()
        print_line(f"{label} {'values are' if kind.endswith('array') else 'value is'}: {_value_text(value, kind)}")


def _print_global_value(name: str, sim: str | None, json_: bool) -> None:
    from simkit.msgs.message_text import to_yaml as as_yaml

    with connect_to_simulation(sim) as client:
        value = GlobalParameters(client).value(absolute_name(name))
    if json_:
        print_json(value)
    else:
        print_line(as_yaml(value).rstrip("\n") if isinstance(value, dict | list) else str(value))


def _value_text(value: object, kind: str) -> str:
    code = {"double array": "d", "integer array": "q"}.get(kind)
    return f"array('{code}', {value!r})" if code and value else f"array('{code}')" if code else str(value)


@param.command("set", cls=Ros2Command, context_settings={"ignore_unknown_options": True})
@report_errors
@without_interrupt_message
def set_(
    node: NodeOrName,
    pairs: Annotated[list[str], argument("Names and values: p_gain 12.5.", "NAME VALUE...", completion.parameters)],
    atomic: Annotated[bool, Option("--atomic", help="Set all parameters or none.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> int:
    """Set parameters; exit code 2 if a value is rejected. `rosparam set /background_r 150` works, too."""
    if len(pairs) == 1:
        with connect_to_simulation(sim) as client:
            parameters, name = GlobalParameters(client), absolute_name(node)
            if name not in parameters.nodes:
                return _report_global([(name, plain_yaml(pairs[0]))], parameters, json_)
    if len(pairs) % 2:
        text = f"found {counted(len(pairs), 'word')}; expected pairs: name value [name value ...]"
        raise InputError("SK-CLI-031", f"the parameters: {text}")
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
        noun = "parameters atomically" if atomic else "parameter"
        success, failure = f"{head}Set {noun} successful", f"{head}Setting {noun} failed"
        reason = f": {result.reason}" if result.reason else ""
        (print_line if result.successful else print_message)((success if result.successful else failure) + reason)
    return 0 if all(r.successful for r in results) else 2


def _report_global(values: list[tuple[str, JsonValue]], parameters: GlobalParameters, json_: bool) -> int:
    """Set values by their global names, and print which were rejected; return the exit code."""
    reasons = [(name, parameters.set(name, value)) for name, value in values]
    if json_:
        print_json([{"name": name, "successful": not reason, "reason": reason} for name, reason in reasons])
    for name, reason in () if json_ else reasons:
        head = f"{name}: " if len(values) > 1 else ""
        if reason:
            print_message(f"{head}Setting parameter failed: {reason}")
        else:
            print_line(f"{head}Set parameter successful")
    return 2 if any(reason for _, reason in reasons) else 0


@live_command(param)
def delete(node: NodeOrName, name: OptionalName = None, sim: options.Sim = None, json_: options.Json = False) -> int:
    """Delete a parameter of the server of ROS 1 by its global name; no node of simkit lets its own be deleted."""
    with connect_to_simulation(sim) as client:
        if name is None:
            return _delete_global(GlobalParameters(client), absolute_name(node), connection_name(client))
        full = _resolve_node(client, node)
        _existing_values(client, full, [name])
    text = f"Deleting parameter failed: {name} is declared by {full}, which needs it"
    if json_:
        print_json({"successful": False, "reason": text.partition(": ")[2]})
    else:
        print_message(text)
    return 2


def _delete_global(parameters: GlobalParameters, name: str, where: str) -> int:
    place = parameters.place_of(name)
    if place is not None:
        print_message(f"Deleting parameter failed: {place[1]} is declared by {place[0]}, which needs it")
        return 2
    if not parameters.delete(name):
        raise not_found_error("parameter", name, parameters.names(), "SK-CLI-034", where)
    print_line("Deleted parameter successfully")
    return 0


@live_command(param)
def describe(node: Node, names: Names, sim: options.Sim = None, json_: options.Json = False) -> None:
    """Print type, description and constraints of parameters."""
    from simkit.msgs.message_text import message_to_dict

    with connect_to_simulation(sim) as client:
        full = _resolve_node(client, node)
        _existing_values(client, full, names)
        descriptors = client.call(f"{full}/describe_parameters", {"names": names}).descriptors
    if json_:
        print_json([message_to_dict(d) | {"type": KINDS[int(d.type)]} for d in descriptors])
        return
    for parameter in descriptors:
        print_line(f"Parameter name: {parameter.name}\n  Type: {KINDS[int(parameter.type)]}")
        if parameter.description:
            print_line(f"  Description: {parameter.description}")
        print_line("  Constraints:")
        if parameter.read_only:
            print_line("    Read only: true")
        for bounds in [*parameter.floating_point_range, *parameter.integer_range][:1]:
            print_line(f"    Min value: {bounds.from_value}\n    Max value: {bounds.to_value}")
            if bounds.step:
                print_line(f"    Step: {bounds.step}")
        if parameter.additional_constraints:
            print_line(f"    Additional constraints: {parameter.additional_constraints}")


@live_command(param)
def dump(node: Node, sim: options.Sim = None, json_: options.Json = False) -> None:
    """Print all parameters of a node as a parameter file."""
    from simkit.msgs.message_text import to_yaml as as_yaml

    with connect_to_simulation(sim) as client:
        full = _resolve_node(client, node)
        names = sorted(client.call(full + LIST_PARAMETERS, {}).result.names)
        values = client.call(f"{full}/get_parameters", {"names": names}).values
    tree: JsonObject = {}
    for name, value in zip(names, values, strict=True):
        *above, last = name.split(".")
        branch = tree
        for part in above:
            branch = branch.setdefault(part, {})
        branch[last] = plain_value(value)
    document = {full: {"ros__parameters": tree}}
    if json_:
        print_json(document)
    else:
        print_line(as_yaml(document))


@live_command(param)
def load(
    node: Annotated[
        str, argument("Name of the node; or the file, as in `rosparam load FILE`.", "NODE", completion.nodes)
    ],
    file: Annotated[Path | None, argument("Parameter file; or a namespace after a file.", "[FILE.yaml]")] = None,
    no_wildcard: Annotated[bool, Option("--no-use-wildcard", help="Ignore the values for all nodes (/**).")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> int:
    """Set the parameters of a node from a parameter file; exit code 2 if a value is rejected."""
    if file is None or (Path(node).is_file() and not file.is_file()):
        return _load_tree(Path(node), "" if file is None else file.as_posix(), sim, json_)
    with connect_to_simulation(sim) as client:
        full = _resolve_node(client, node)
        values = read_parameter_file(file, full, wildcard=not no_wildcard)
        request = {"parameters": [{"name": n, "value": v} for n, v in values]}
        results = client.call(f"{full}/set_parameters", request).results
    rows = [(n, bool(r.successful), str(r.reason)) for (n, _), r in zip(values, results, strict=True)]
    if json_:
        print_json([{"name": n, "successful": successful, "reason": reason} for n, successful, reason in rows])
    for name, successful, reason in () if json_ else rows:
        text = f"Set parameter {name} {'successful' if successful else 'failed'}{': ' + reason if reason else ''}"
        (print_line if successful else print_message)(text)
    return 0 if all(successful for _, successful, _ in rows) else 2


def _load_tree(file: Path, namespace: str, sim: str | None, json_: bool) -> int:
    """Set the parameters of a file of `rosparam dump` below a namespace."""
    prefix = absolute_name(namespace.strip("/")).rstrip("/") if namespace.strip("/") else ""
    values = [(f"{prefix}{name}", value) for name, value in read_parameter_tree(file)]
    with connect_to_simulation(sim) as client:
        return _report_global(values, GlobalParameters(client), json_)


def _resolve_node(client: Client, name: str) -> str:
    nodes = parameter_nodes(client)
    node = absolute_name(name)
    if node not in nodes:
        raise not_found_error("node with parameters", node, nodes, "SK-CLI-034", connection_name(client))
    return node


def _existing_values(client: Client, node: str, names: list[str]) -> list[ParameterValue]:
    """Return the values of parameters; raise an error for a parameter that does not exist."""
    values = list(client.call(f"{node}/get_parameters", {"names": names}).values)
    for name, value in zip(names, values, strict=True):
        if not int(value.type):
            existing = client.call(node + LIST_PARAMETERS, {}).result.names
            raise not_found_error("parameter", name, sorted(existing), "SK-CLI-034", f"node {node}")
    return values

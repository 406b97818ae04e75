"""Commands of `ros2 param`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from command_services import call
from rcl_interfaces.msg import Parameter, ParameterValue
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.node import Node
from rosidl_runtime_py import set_message_fields

from simkit_terminal.cli.terminal.parameter_values import parse_parameter_value, plain_value, read_parameter_file


def param_command(node: Node, words: list[str]) -> int:
    """Run a command of `ros2 param`; return its exit code.

    Args:
        node: node of the command.
        words: words after `ros2`.
    """
    parser = argparse.ArgumentParser(prog="param")
    verbs = parser.add_subparsers(dest="verb", required=True)
    setter = verbs.add_parser("set")
    setter.add_argument("node")
    setter.add_argument("name")
    setter.add_argument("value")
    getter = verbs.add_parser("get")
    getter.add_argument("node")
    getter.add_argument("name")
    getter.add_argument("--hide-type", action="store_true")
    loader = verbs.add_parser("load")
    loader.add_argument("node")
    loader.add_argument("file", type=Path)
    loader.add_argument("--no-use-wildcard", action="store_true")
    for verb in ("list", "dump"):
        verbs.add_parser(verb).add_argument("node")
    options, _ = parser.parse_known_args(words[1:])
    name = options.node if options.node.startswith("/") else f"/{options.node}"
    if options.verb == "set":
        return _set(node, name, [(options.name, parse_parameter_value(options.value))])
    if options.verb == "load":
        return _set(node, name, read_parameter_file(options.file, name, wildcard=not options.no_use_wildcard))
    if options.verb == "get":
        request = GetParameters.Request(names=[options.name])
        (value,) = call(node, GetParameters, f"{name}/get_parameters", request).values
        if not value.type:
            print("Parameter not set")
            return 1
        print(plain_value(value))
        return 0
    listed = call(node, ListParameters, f"{name}/list_parameters", ListParameters.Request()).result.names
    print("\n".join(sorted(listed)))
    return 0


def _set(node: Node, name: str, values: list[tuple[str, Any]]) -> int:
    """Set parameters of a node."""
    parameters = []
    for parameter, fields in values:
        message = ParameterValue()
        set_message_fields(message, fields)
        parameters.append(Parameter(name=parameter, value=message))
    request = SetParameters.Request(parameters=parameters)
    response = call(node, SetParameters, f"{name}/set_parameters", request)
    failed = 0
    for (parameter, _), result in zip(values, response.results, strict=True):
        if result.successful:
            print("Set parameter successful" if len(values) == 1 else f"Set parameter {parameter} successful")
        else:
            failed = 1
            print(f"Setting parameter {parameter} failed: {result.reason}")
    return failed

"""Commands of `ros2 service`, `ros2 lifecycle` and `rosservice`."""

from __future__ import annotations

import argparse
from typing import Any

import rclpy
from command_topics import fields_of, fill, wait_a_moment
from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from rclpy.node import Node
from rosidl_runtime_py.utilities import get_service

from simkit.errors import InputError

LOOK = 1.0
"""Time after which a command says again that it waits for a service [s]."""


def call(node: Node, kind: Any, name: str, request: Any) -> Any:
    """Call a service as soon as it exists, and return its response."""
    client = node.create_client(kind, name)
    if not client.wait_for_service(0.1):
        print("waiting for service to become available...")
        while not client.wait_for_service(LOOK):
            pass
    future = client.call_async(request)
    rclpy.spin_until_future_complete(node, future)
    return future.result()


def service_command(node: Node, words: list[str]) -> int:
    """Run a command of `ros2 service`; return its exit code.

    Args:
        node: node of the command.
        words: words after `ros2`.
    """
    parser = argparse.ArgumentParser(prog="service")
    verbs = parser.add_subparsers(dest="verb", required=True)
    caller = verbs.add_parser("call")
    caller.add_argument("service")
    caller.add_argument("type", nargs="?", default="")
    caller.add_argument("values", nargs="*", default=[])
    caller.add_argument("-r", "--rate", type=float, default=0.0)
    for flag in ("--wait", "-v"):  # of `rosservice`; a call always waits for its service
        caller.add_argument(flag, action="store_true")
    lists = verbs.add_parser("list")
    lists.add_argument("-t", "--show-types", action="store_true")
    verbs.add_parser("type").add_argument("service")
    options = parser.parse_args(words[1:])
    if options.verb != "call":
        wait_a_moment(node)
        for name, types in node.get_service_names_and_types():
            if options.verb == "list":
                print(f"{name} [{', '.join(types)}]" if options.show_types else name)
            elif name == node.resolve_service_name(options.service):
                print("\n".join(types))
        return 0
    type_name = options.type
    if type_name.count("/") not in (1, 2) or "{" in type_name:  # `rosservice call` has no type
        options.values = [type_name, *options.values] if type_name else options.values
        type_name = _type_of(node, options.service)
    try:
        kind = get_service(type_name)
    except (ValueError, AttributeError, ModuleNotFoundError):
        raise InputError("SK-CLI-032", f"no service type {type_name!r}") from None
    request = kind.Request()
    fill(request, fields_of(options.values, kind.Request))
    while True:
        print(f"requester: making request: {request!r}\n")
        print(f"response:\n{call(node, kind, options.service, request)!r}\n")
        if not options.rate:
            return 0
        rclpy.spin_once(node, timeout_sec=1.0 / options.rate)


def _type_of(node: Node, service: str) -> str:
    """Wait until a service exists and return its type."""
    name = node.resolve_service_name(service)
    while True:
        types = dict(node.get_service_names_and_types()).get(name)
        if types:
            return str(types[0])
        wait_a_moment(node)


def lifecycle_command(node: Node, words: list[str]) -> int:
    """Run a command of `ros2 lifecycle`; return its exit code.

    Args:
        node: node of the command.
        words: words after `ros2`.
    """
    parser = argparse.ArgumentParser(prog="lifecycle")
    verbs = parser.add_subparsers(dest="verb", required=True)
    setter = verbs.add_parser("set")
    setter.add_argument("node")
    setter.add_argument("transition")
    for name in ("get", "list"):
        verbs.add_parser(name).add_argument("node")
    options = parser.parse_args(words[1:])
    name = options.node if options.node.startswith("/") else f"/{options.node}"
    if options.verb == "get":
        state = call(node, GetState, f"{name}/get_state", GetState.Request()).current_state
        print(f"{state.label} [{state.id}]")
        return 0
    response = call(
        node, GetAvailableTransitions, f"{name}/get_available_transitions", GetAvailableTransitions.Request()
    )
    possible = [each.transition for each in response.available_transitions]
    if options.verb == "list":
        for each in possible:
            print(f"- {each.label} [{each.id}]")
        return 0
    wanted = [each for each in possible if options.transition in (each.label, str(each.id))]
    if not wanted:
        known = ", ".join(f"{each.label} [{each.id}]" for each in possible) or "none"
        print(f"Unknown transition requested, available ones are: {known}")
        return 1
    is_done = call(node, ChangeState, f"{name}/change_state", ChangeState.Request(transition=wanted[0])).success
    print(f"Transitioning {'successful' if is_done else 'failed'}")
    return 0 if is_done else 1

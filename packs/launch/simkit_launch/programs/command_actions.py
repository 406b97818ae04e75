"""Commands of `ros2 action`."""

from __future__ import annotations

import argparse
from typing import Any

import rclpy
from command_topics import fields_of, fill, wait_a_moment
from rclpy.action import ActionClient, get_action_names_and_types
from rclpy.node import Node
from rosidl_runtime_py import message_to_yaml
from rosidl_runtime_py.utilities import get_action

from simkit.errors import InputError

ENDS = {4: "SUCCEEDED", 5: "CANCELED", 6: "ABORTED"}
"""Names of the states in which a goal ends."""


def action_command(node: Node, words: list[str]) -> int:
    """Run a command of `ros2 action`; return its exit code.

    Args:
        node: node of the command.
        words: words after `ros2`.
    """
    parser = argparse.ArgumentParser(prog="action")
    verbs = parser.add_subparsers(dest="verb", required=True)
    sender = verbs.add_parser("send_goal")
    sender.add_argument("action")
    sender.add_argument("type")
    sender.add_argument("goal", nargs="?", default="{}")
    sender.add_argument("-f", "--feedback", action="store_true")
    sender.add_argument("-t", "--timeout", type=float, default=None)
    verbs.add_parser("list").add_argument("-t", "--show-types", action="store_true")
    options = parser.parse_args(words[1:])
    if options.verb == "list":
        wait_a_moment(node)
        for name, types in get_action_names_and_types(node):
            print(f"{name} [{', '.join(types)}]" if options.show_types else name)
        return 0
    try:
        kind = get_action(options.type)
    except (ValueError, AttributeError, ModuleNotFoundError):
        raise InputError("SK-CLI-032", f"no action type {options.type!r}") from None
    return _send(node, options, kind)


def _send(node: Node, options: argparse.Namespace, kind: Any) -> int:
    goal = kind.Goal()
    fill(goal, fields_of([options.goal], kind.Goal))
    client = ActionClient(node, kind, options.action)
    print("Waiting for an action server to become available...")
    client.wait_for_server()

    def show(feedback: Any) -> None:
        print(f"Feedback:\n    {message_to_yaml(feedback.feedback)}")

    print(f"Sending goal:\n     {message_to_yaml(goal)}")
    sent = client.send_goal_async(goal, feedback_callback=show if options.feedback else None)
    rclpy.spin_until_future_complete(node, sent)
    handle = sent.result()
    if not handle.accepted:
        print("Goal was rejected.")
        return 1
    print("Goal accepted")
    ended = handle.get_result_async()
    rclpy.spin_until_future_complete(node, ended, timeout_sec=options.timeout)
    if not ended.done():
        rclpy.spin_until_future_complete(node, handle.cancel_goal_async())
        print("Goal canceled: timeout")
        return 1
    result = ended.result()
    print(f"Result:\n    {message_to_yaml(result.result)}")
    print(f"Goal finished with status: {ENDS.get(result.status, result.status)}")
    return 0

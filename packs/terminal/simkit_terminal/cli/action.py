"""List the actions of a running simulation and send goals."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import absolute_name, print_json, print_line, without_interrupt_message
from simkit.cli.terminal.topic_sources import connect_to_simulation
from simkit.extend import argument, option, report_errors
from simkit_terminal.cli.terminal import completion
from simkit_terminal.cli.terminal.live_command import Ros2Command, live_command
from simkit_terminal.cli.terminal.message_arguments import check_type, make_message, parse_fields, split_type_and_values
from simkit_terminal.cli.terminal.name_lists import print_names, print_names_and_types
from simkit_terminal.cli.terminal.named_endpoints import interface_type

if TYPE_CHECKING:
    from simkit.live import Client, LiveGoal
    from simkit.msgs import Message

LISTED_AFTER = "param"

_CANCEL_TIMEOUT = 5.0  # [s] of wall time for the end of a cancelled goal
action = typer.Typer(help="List the actions of a running simulation and send goals.", no_args_is_help=True)
Name = Annotated[str, argument("Name of the action.", "ACTION", completion.actions)]


@live_command(action, "list")
def list_(
    show_types: options.ShowTypes = False,
    count: Annotated[bool, Option("--count-actions", "-c", help="Print only the number of actions.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """List the actions."""
    with connect_to_simulation(sim) as client:
        type_by_action = dict(sorted(client.actions().items()))
    print_names_and_types(type_by_action, show_types=show_types, count=count, json_=json_)


@live_command(action, "type")
def type_(action: Name, sim: options.Sim = None, json_: options.Json = False) -> None:
    """Print the type of an action."""
    with connect_to_simulation(sim) as client:
        known_type = interface_type(client, "action", client.actions(), action)
    print_names([known_type], json_=json_)


@live_command(action)
def info(
    action: Name,
    show_types: options.ShowTypes = False,
    count: Annotated[bool, Option("--count", "-c", help="Print only the numbers of clients and servers.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Print the nodes with clients of an action, and the node that serves it."""
    with connect_to_simulation(sim) as client:
        known_type = interface_type(client, "action", client.actions(), action)
        nodes = client.ask("nodes")
    name = absolute_name(action)
    node = next((n for n, has in nodes.items() if name in has["actions"]), name.rpartition("/")[0] or name)
    clients = [client for client, has in nodes.items() if name in has["action_clients"]]
    if json_:
        print_json({"name": name, "types": [known_type], "clients": clients, "servers": [node]})
        return
    print_line(f"Action: {name}")
    for title, members in (("Action clients", clients), ("Action servers", [node])):
        print_line(f"{title}: {len(members)}")
        for member in () if count else members:
            print_line(f"    {member} [{known_type}]" if show_types else f"    {member}")


def send_goal(
    action: Name,
    action_type: Annotated[
        str | None, argument("Type of the action (optional).", "[TYPE]", completion.action_types)
    ] = None,
    goal: Annotated[str | None, argument("Goal as YAML: '{order: 5}'.", "[GOAL]", completion.goal_values)] = None,
    stdin: Annotated[bool, Option("--stdin", help="Read the goal from standard input.")] = False,
    feedback: Annotated[bool, Option("--feedback", "-f", help="Print the feedback.")] = False,
    timeout: Annotated[float | None, option("Cancel the goal after this wall time.", "S", "--timeout", min=0)] = None,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Send a goal and wait for its end. Ctrl-C cancels the goal."""
    action_type, goal = split_type_and_values(action_type, goal)
    fields = parse_fields(sys.stdin.read() if stdin else goal or "{}", "the goal")
    with connect_to_simulation(sim) as client:
        known_type = interface_type(client, "action", client.actions(), action)
        check_type(action_type, [known_type], absolute_name(action))
        _GoalRun(client, json_, feedback).send(
            absolute_name(action), make_message(f"{known_type}_Goal", fields), timeout
        )


live_command(action, "send_goal")(send_goal)
action.command("send", cls=Ros2Command, help="Alias of send_goal.")(report_errors(without_interrupt_message(send_goal)))


class _GoalRun:
    """Goal that was sent, with the printing of its progress."""

    def __init__(self, client: Client, json_: bool, feedback: bool) -> None:
        self._client, self._json, self._feedback = client, json_, feedback
        self._early: list[object] | None = []  # feedback that arrived before the line "Goal accepted"

    def send(self, name: str, goal: Message, timeout: float | None) -> None:
        self._print_line("Waiting for an action server to become available...")
        self._print_line(f"Sending goal:\n     {_yaml_text(goal)}")
        handle = self._client.send_goal(name, goal, self._on_feedback if self._feedback else None)
        try:
            handle.wait_accepted()
            if handle.status.name == "REJECTED":
                self._print_line(f"Goal was rejected{': ' + handle.reason if handle.reason else '.'}")
                self._print_end(handle)
                return
            self._print_line(f"Goal accepted with ID: {handle.id:032x}\n")
            early, self._early = self._early or [], None
            for message in early:
                self._on_feedback(message)
            if not handle.wait(timeout):
                self._cancel(handle)
        except KeyboardInterrupt:
            self._cancel(handle)
            self._print_end(handle)
            raise
        self._print_end(handle)

    def _cancel(self, handle: LiveGoal) -> None:
        self._print_line("Canceling goal...")
        handle.cancel()
        self._print_line(
            "Goal canceled." if handle.wait(_CANCEL_TIMEOUT) else "The goal continues: its action did not cancel it."
        )

    def _print_end(self, handle: LiveGoal) -> None:
        from simkit.msgs.message_text import message_to_dict

        result = handle.result
        if self._json:
            fields = None if result is None else message_to_dict(result)
            print_json({"status": handle.status.name, "reason": handle.reason, "result": fields})
        elif handle.is_done and handle.status.name != "REJECTED":
            print_line(f"Result:\n    {_yaml_text(result)}")
            print_line(f"Goal finished with status: {handle.status.name}")
            if handle.reason and handle.status.name != "SUCCEEDED":
                print_line(f"Reason: {handle.reason}")

    def _on_feedback(self, message: object) -> None:
        from simkit.msgs.message_text import message_to_dict

        if self._early is not None:
            self._early.append(message)
        elif self._json:
            print_json({"feedback": message_to_dict(message)})
        else:
            print_line(f"Feedback:\n    {_yaml_text(message)}")

    def _print_line(self, text: str) -> None:
        if not self._json:
            print_line(text)


def _yaml_text(message: object) -> str:
    from simkit.msgs.message_text import message_to_yaml

    return message_to_yaml(message)

"""Show and change the states of lifecycle nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import absolute_name, not_found_error, print_json, print_line, print_message
from simkit.cli.terminal.topic_sources import connect_to_simulation, connection_name
from simkit.errors import InputError
from simkit.extend import argument
from simkit.msgs.topic_names import is_hidden
from simkit_terminal.cli.terminal import completion
from simkit_terminal.cli.terminal.live_command import live_command
from simkit_terminal.cli.terminal.name_lists import print_names
from simkit_terminal.cli.terminal.named_endpoints import GET_STATE, lifecycle_node_names

if TYPE_CHECKING:
    from simkit.live import Client

LISTED_AFTER = "node"

lifecycle = typer.Typer(help="Show and change the states of lifecycle nodes.", no_args_is_help=True)
Node = Annotated[str, argument("Name of the node.", "NODE", completion.lifecycle_nodes)]


@live_command(lifecycle)
def nodes(
    hidden: Annotated[bool, Option("--all", "-a", "--include-hidden-nodes", help="Include hidden names.")] = False,
    count: Annotated[bool, Option("--count-nodes", "-c", help="Print only the number of nodes.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """List the lifecycle nodes."""
    with connect_to_simulation(sim) as client:
        names = [name for name in lifecycle_node_names(client) if hidden or not is_hidden(name)]
    print_names(names, count=count, json_=json_)


@live_command(lifecycle)
def get(
    node: Annotated[
        str | None, argument("Name of a node; default: all nodes.", "[NODE]", completion.lifecycle_nodes)
    ] = None,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Print the state of a lifecycle node, or of all of them."""
    with connect_to_simulation(sim) as client:
        names = lifecycle_node_names(client) if node is None else [_resolve_node(client, node)]
        states = {name: client.call(name + GET_STATE).current_state for name in names}
    if json_:
        print_json({name: {"id": int(state.id), "label": state.label} for name, state in states.items()})
        return
    for name, state in states.items():
        print_line(f"{f'{name}: ' if node is None else ''}{state.label} [{state.id}]")


@live_command(lifecycle, "list")
def list_(
    node: Node,
    every: Annotated[bool, Option("--all", "-a", help="List the transitions of all states.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """List the transitions that are possible in the present state."""
    with connect_to_simulation(sim) as client:
        transitions = _transitions(client, _resolve_node(client, node), every=every)
    if json_:
        print_json(
            [{**_labelled(t.transition), "start": t.start_state.label, "goal": t.goal_state.label} for t in transitions]
        )
        return
    for t in transitions:
        print_line(f"- {t.transition.label} [{t.transition.id}]")
        print_line(f"\tStart: {t.start_state.label}\n\tGoal: {t.goal_state.label}")


@live_command(lifecycle, "set")
def set_(
    node: Node,
    transition: Annotated[
        str, argument("Label or number of the transition.", "TRANSITION", completion.lifecycle_transitions)
    ],
    sim: options.Sim = None,
    json_: options.Json = False,
) -> int:
    """Make a transition; exit code 2 if it is not possible or fails."""
    with connect_to_simulation(sim) as client:
        name = _resolve_node(client, node)
        possible = [t.transition for t in _transitions(client, name)]
        wanted = [t for t in possible if transition in (t.label, str(t.id))]
        if not wanted:
            state = client.call(name + GET_STATE).current_state.label
            known = ", ".join(f"{t.label} [{t.id}]" for t in possible) or "none"
            text = f"no transition {transition!r} of {name} in the state {state!r}; possible: {known}"
            raise InputError("SK-CLI-034", text)
        succeeded = bool(client.call(f"{name}/change_state", {"transition": _labelled(wanted[0])}).success)
    if json_:
        print_json({"successful": succeeded})
    else:
        (print_line if succeeded else print_message)(f"Transitioning {'successful' if succeeded else 'failed'}")
    return 0 if succeeded else 2


def _labelled(transition: Any) -> dict[str, object]:
    return {"id": int(transition.id), "label": str(transition.label)}


def _transitions(client: Client, node: str, *, every: bool = False) -> list[Any]:
    service = "get_transition_graph" if every else "get_available_transitions"
    return list(client.call(f"{node}/{service}").available_transitions)


def _resolve_node(client: Client, name: str) -> str:
    node, names = absolute_name(name), lifecycle_node_names(client)
    if node not in names:
        raise not_found_error("lifecycle node", node, names, "SK-CLI-034", connection_name(client))
    return node

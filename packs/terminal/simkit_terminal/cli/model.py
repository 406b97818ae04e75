"""Show models, poses and joints of a running simulation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import JsonObject, not_found_error, print_json, print_line, without_interrupt_message
from simkit.cli.terminal.topic_sources import connect_to_simulation, connection_name
from simkit.extend import argument, counted, report_errors
from simkit_terminal.cli.terminal import completion

if TYPE_CHECKING:
    from simkit.live import Client

LISTED_AFTER = "interface"

model = typer.Typer(help="Show models, poses and joints of a running simulation.", no_args_is_help=True)
Model = Annotated[str, argument("Name of the model; for a nested model OUTER::INNER.", "MODEL", completion.models)]


@model.command("list")
@report_errors
@without_interrupt_message
def list_(
    verbose: Annotated[bool, Option("--verbose", "-v", help="Show poses, links and joints, too.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """List the models."""
    with connect_to_simulation(sim) as client:
        names: list[str] = client.models()
        states = {name: client.model(name) for name in names} if verbose else {}
    if json_:
        print_json(list(states.values()) if verbose else names)
        return
    for name in names:
        if not verbose:
            print_line(name)
            continue
        state = states[name]
        counts = f"{_count_text(state['links'], 'link')}, {_count_text(state['joints'], 'joint')}"
        print_line(f"{name}: {_pose_text(state['pose'])} ({'static, ' if state.get('static') else ''}{counts})")


def _count_text(items: Sequence[object], noun: str) -> str:
    return counted(len(items), noun)


@model.command()
@report_errors
@without_interrupt_message
def pose(
    model: Model,
    link: Annotated[str | None, argument("Link of the model.", "[LINK]", completion.links)] = None,
    links: Annotated[bool, Option("--links", "-l", help="Print the poses of all links, too.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Print a pose in the world frame: x y z [m], roll pitch yaw [rad]."""
    with connect_to_simulation(sim) as client:
        model_state = _model_state(client, model)
    if link is not None:
        if link not in model_state["links"]:
            raise not_found_error("link", link, model_state["links"], "SK-CLI-038", f"model {model!r}")
        rows = {f"{model}::{link}": model_state["links"][link]["pose"]}
    else:
        rows = {model: model_state["pose"]}
        if links:
            rows |= {f"{model}::{n}": state["pose"] for n, state in model_state["links"].items()}
    if json_:
        print_json(rows if links else next(iter(rows.values())))
        return
    width = max(map(len, rows))
    for name, at in rows.items():
        print_line(f"{name:<{width}}  {_pose_text(at)}" if links else _pose_text(at))


def _pose_text(pose: JsonObject) -> str:
    numbers = [*pose["position"], *pose["rpy"]]
    x, y, z, roll, pitch, yaw = (f"{n + 0.0:.6f}" for n in numbers)
    return f"xyz {x} {y} {z} rpy {roll} {pitch} {yaw}"


@model.command()
@report_errors
@without_interrupt_message
def joint(
    model: Model,
    joint: Annotated[
        str | None, argument("Joint of the model; default: all joints.", "[JOINT]", completion.joints)
    ] = None,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Print the state of joints: position, velocity, effort [rad, rad/s, N·m or m, m/s, N]."""
    with connect_to_simulation(sim) as client:
        joints = _model_state(client, model)["joints"]
    if joint is not None and joint not in joints:
        raise not_found_error("joint", joint, joints, "SK-CLI-038", f"model {model!r}")
    rows = joints if joint is None else {joint: joints[joint]}
    if json_:
        print_json(rows if joint is None else rows[joint])
        return
    if not rows:
        print_line(f"{model} has no joints")
        return
    width, kinds = max(map(len, rows)), max(len(str(r["type"])) for r in rows.values())
    for name, row in rows.items():
        state = "  ".join(f"{key} {_numbers(row[key])}" for key in ("position", "velocity", "effort"))
        print_line(f"{name:<{width}}  {row['type']:<{kinds}}  {state}")


def _numbers(value: float | list[float]) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(_numbers(v) for v in value) + "]"
    return f"{value + 0.0:.6f}"


def _model_state(client: Client, name: str) -> JsonObject:
    """Return the state of a model.

    Raises:
        InputError: SK-CLI-038 no model has the name.
    """
    from simkit.live import LiveClosed, LiveError

    try:
        state: JsonObject = client.model(name)
    except LiveClosed:
        raise
    except LiveError:
        names = client.models()
        raise not_found_error("model", name, names, "SK-CLI-038", connection_name(client)) from None
    return state

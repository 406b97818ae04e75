"""Command `simkit inspect`: show the resolved content of a file."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterator
from dataclasses import asdict
from typing import Annotated

from typer import Option

from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import report_errors
from simkit.cli.terminal.output import JsonObject, print_diagnostics, print_json, printable, stdout_console
from simkit.diagnostics import Diagnostic, did_you_mean
from simkit.errors import InputError
from simkit.number_text import counted
from simkit.run_spec import SourceOptions


@report_errors
@with_run_options("file", "plugin_paths")
def inspect(
    file: options.File,
    json_: options.Json = False,
    given: GivenOptions = NONE_GIVEN,
    paths: Annotated[bool, Option("--paths", help="List all values that --set can change, with their units.")] = False,
    pattern: Annotated[str, options.argument("Part of a path, or a shell pattern; only with --paths.")] = "",
) -> int:
    """Show the resolved content of a file."""
    from simkit.build import describe

    source = given.source_options()
    if paths:
        return _print_paths(file, source, pattern, json_)
    if pattern:
        raise InputError("SK-CLI-018", f"found the argument {pattern!r}; it needs the option --paths")
    description = describe(file, plugin_paths=given.values.get("plugin_paths", ()), **source)
    if json_:
        print_json(description, indent=2)
    else:
        for line in _tree(description):
            stdout_console().print(line)
        shown = (Diagnostic(**d) for d in description["diagnostics"] if d["severity"] != "note")
        print_diagnostics(shown, verbose=True)
    return 2 if any(d["severity"] == "error" for d in description["diagnostics"]) else 0


def _print_paths(file: str, source: SourceOptions, pattern: str, json_: bool) -> int:
    """Print the paths that overrides can set; return 2 if the pattern matches none."""
    from simkit.build import read_scene
    from simkit.scene.override_list import settable_paths
    from simkit.sensors.default_parameters import read_parameters

    scene, _ = read_scene(file, missing_meshes=True, **source)
    everything = settable_paths(scene.world, scene.arguments, read_parameters)
    is_part = not set("*?[") & set(pattern)
    matching = [p for p in everything if (pattern in p.path if is_part else fnmatch.fnmatchcase(p.path, pattern))]
    if pattern and not matching:
        names = {name for p in everything for name in (p.path, *p.path.split("."), *p.path.split("::"))}
        hint = did_you_mean(pattern, sorted(names)) or "without a pattern all paths are listed"
        raise InputError("SK-CLI-014", f"no path matches {pattern!r}; {hint}")
    if json_:
        print_json([asdict(p) for p in matching], indent=2)
        return 0
    width = min(100, max((len(p.path) for p in matching), default=0))
    for path in matching:
        unit = f"  [{path.unit}]" if path.unit else ""
        stdout_console().print(printable(f"{path.path:{width}}  {path.value}{unit}"), markup=False, soft_wrap=True)
    return 0


def _tree(description: JsonObject) -> Iterator[str]:
    for world in description["worlds"]:
        physics = world["physics"]
        yield f"world {world['name']}  step {physics['max_step_size']:g} s, gravity {_numbers(world['gravity'])} m/s²"
        for light in world["lights"]:
            yield f"  light {light['name']}  {light['type']}"
        yield from _plugins(world, "  ")
        for model in world["models"]:
            yield from _model(model, "  ")
    if description["model"]:
        yield from _model(description["model"], "")
    totals = description["totals"].items()
    yield "total  " + ", ".join(f"{v:g} kg" if k == "mass" else counted(v, k.removesuffix("s")) for k, v in totals)
    severities = [d["severity"] for d in description["diagnostics"]]
    if severities:
        counts = ", ".join(f"{severities.count(s)} {s}s" for s in ("error", "warning", "note") if s in severities)
        yield f"{counts}; show them with `simkit check`"


def _model(model: JsonObject, indent: str) -> Iterator[str]:
    static = "  static" if model["static"] else ""
    yield f"{indent}model {model['name']}{static}  at {_numbers(model['pose_world'][:3])}"
    inner = indent + "  "
    for link in model["links"]:
        shapes = f"{counted(len(link['collisions']), 'collision')}, {counted(len(link['visuals']), 'visual')}"
        yield f"{inner}link {link['name']}  {link['mass']:g} kg, {shapes}"
        yield from _sensors(link, inner + "  ")
    for joint in model["joints"]:
        yield f"{inner}joint {joint['name']}  {joint['type']}, {joint['parent_link']} → {joint['child_link']}"
        yield from _sensors(joint, inner + "  ")
    yield from _plugins(model, inner)
    for nested in model["models"]:
        yield from _model(nested, inner)


def _sensors(owner: JsonObject, indent: str) -> Iterator[str]:
    for sensor in owner["sensors"]:
        topic = sensor["topic"] or "default topic"
        yield f"{indent}sensor {sensor['name']}  {sensor['type']}, {sensor['update_rate']:g} Hz, {topic}"


def _plugins(owner: JsonObject, indent: str) -> Iterator[str]:
    for plugin in owner["plugins"]:
        yield f"{indent}plugin {plugin['name']}  {plugin['filename']}"


def _numbers(values: list[float]) -> str:
    return "(" + ", ".join(f"{v:g}" for v in values) + ")"

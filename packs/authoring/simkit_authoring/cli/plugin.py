"""List, describe and create plugins."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.run_options import NONE_GIVEN
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.output import JsonObject, print_diagnostics, print_json, print_status, stdout_console
from simkit.errors import InputError
from simkit.extend import Diagnostics, GivenOptions, add_to_report, argument, option, report_errors, with_run_options

if TYPE_CHECKING:
    from simkit_authoring.catalogue import Entry
    from simkit_authoring.plugin_facts import Facts, Service

plugin = typer.Typer(help="List, describe and create plugins.", no_args_is_help=True)


@completion.silent
def plugin_names(_: typer.Context) -> Iterable[str]:
    """Complete names of plugins, as files have them."""
    from simkit.plugins.discovery.find_plugin_class import plugin_kinds

    return plugin_kinds().written.values()


@plugin.command("list")
@report_errors
@with_run_options("plugin_paths")
def list_plugins(
    words: Annotated[list[str] | None, argument("List only names that contain one of these words.")] = None,
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,
) -> None:
    """List all names that a world can use for a plugin, with the elements that can have the plugin."""
    from simkit_authoring.catalogue import known_plugins

    search_words = [word.casefold() for word in words or ()]
    problems = Diagnostics()
    entries = known_plugins(given.values.get("plugin_paths", ()), problems)
    print_diagnostics(problems, verbose=True)
    if json_:
        shown = [_as_dict(e) for e in entries if _matching(e, search_words) or not search_words]
        print_json(shown, indent=2)
        return
    rows = [
        (name, " or ".join(e.parents), e)
        for e in entries
        for name in (_matching(e, search_words) if search_words else e.names)
    ]
    if not rows:
        print_status(f"no plugin name contains {' or '.join(words or ())}; list all with `simkit plugin list`")
        return
    width = max(len(name) for name, _, _ in rows)
    places = max(len(parents) for _, parents, _ in rows)
    for name, parents, entry in rows:
        stdout_console().print(
            f"{name:<{width}}  {parents:<{places}}  {entry.cls.__name__}: {_first_sentence(entry.summary)}"
        )


def _matching(entry: Entry, search_words: list[str]) -> list[str]:
    if any(word in entry.cls.__name__.casefold() for word in search_words):
        return list(entry.names)
    return [name for name in entry.names if any(word in name.casefold() for word in search_words)]


@plugin.command("info")
@report_errors
@with_run_options("plugin_paths")
def show_info(
    name: Annotated[str, argument("Name in any spelling, class, MODULE:CLASS or FILE.py.", complete=plugin_names)],
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,
) -> None:
    """Print the parameters, topics, services and actions of a plugin."""
    from simkit_authoring.catalogue import common_facts, facts_of, find_entry
    from simkit_authoring.plugin_tables import tables_of

    entry = find_entry(name, given.values.get("plugin_paths", ()))
    facts = facts_of(entry.cls)
    if json_:
        description = {
            **_as_dict(entry),
            **_facts_as_dict(facts),
            "common": _facts_as_dict(common_facts())["parameters"],
        }
        print_json(description, indent=2)
        return
    first, *others = entry.names or (entry.cls.__name__,)
    stdout_console().print(
        f"{first}: {entry.cls.__name__}, on a {' or a '.join(entry.parents)}".replace("on a any", "anywhere")
    )
    if entry.summary:
        stdout_console().print(f"  {entry.summary}")
    stdout_console().print(f"  from {entry.source or entry.origin}")
    if others:
        stdout_console().print(f"  other names: {', '.join(others)}")
    for title, rows in tables_of(facts).items():
        _print_table(title, rows)


@plugin.command("new")
@report_errors
@with_run_options("file", "plugin_paths", without={"base": "plugins do not depend on the base"})
def new_plugin(
    name: Annotated[str | None, argument("Name of the plugin: wheel_brake, WheelBrake or libwheel_brake.so.")] = None,
    from_: Annotated[
        str | None,
        option(
            "Create a plugin for each unknown plugin library of this world.",
            "WORLD",
            "--from",
            complete=completion.worlds,
        ),
    ] = None,
    on: Annotated[str, Option(help="Parent element of the plugin: world, model, visual or sensor.")] = "model",
    folder: Annotated[Path, option("Folder for the new files.", "DIR")] = Path(),
    force: options.Force = False,
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> None:
    """Create a plugin with typed parameters, and a test that passes."""
    from simkit_authoring.new_plugins import plugin_named, plugins_missing_in
    from simkit_authoring.plugin_skeleton import write_plugins

    if (name is None) == (from_ is None):
        raise InputError("SK-PLUGIN-072", "give either NAME or --from WORLD")
    if from_ is None:
        assert name is not None
        new_plugins = [plugin_named(name, on)]
    else:
        from simkit.build import read_scene

        scene, _ = read_scene(from_, missing_meshes=True, **given.source_options())
        new_plugins = plugins_missing_in(scene, given.values.get("plugin_paths", ()))
        if not new_plugins:
            add_to_report(files=[])
            print_status("every plugin of this file is known; nothing to write")
            return
    paths = write_plugins(new_plugins, folder, overwrite=force)
    add_to_report(files=[str(path) for path in paths])
    for path in paths:
        stdout_console().print(str(path))
    print_status(f"run the tests with `python -m pytest {folder}`; use the plugins with --plugin-path {folder}")


# ---------------------------------------------------------------------- as text


def _first_sentence(text: str) -> str:
    head, dot, _ = text.partition(". ")
    return head + "." if dot else text


def _print_table(title: str, rows: Sequence[tuple[str, ...]]) -> None:
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    stdout_console().print(f"\n{title}")
    for row in rows:
        stdout_console().print(
            "  " + "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        )


# ---------------------------------------------------------------------- as JSON


def _as_dict(entry: Entry) -> JsonObject:
    return {
        "class": entry.cls.__name__,
        "names": list(entry.names),
        "parents": list(entry.parents),
        "origin": entry.origin,
        "source": entry.source,
        "summary": entry.summary,
    }


def _facts_as_dict(facts: Facts) -> JsonObject:
    return {
        "parameters": [
            {
                "name": p.name,
                "type": p.kind,
                "default": _plain(p.default),
                "instead": list(p.instead),
                "required": p.required,
                "unit": p.unit,
                "minimum": _plain(p.minimum),
                "maximum": _plain(p.maximum),
                "choices": list(p.choices),
                "size": p.size,
                "repeated": p.repeated,
                "live": p.live,
                "description": p.says,
            }
            for p in facts.parameters
        ],
        "topics": [
            {
                "name": t.name,
                "types": list(t.types),
                "direction": "out" if t.published else "in",
                "latched": t.latched,
                "named_by": list(t.elements),
            }
            for t in facts.topics
        ],
        "services": [_service_as_dict(s) for s in facts.services if not s.is_action],
        "actions": [_service_as_dict(s) for s in facts.services if s.is_action],
    }


def _service_as_dict(service: Service) -> JsonObject:
    return {"name": service.name, "type": service.type, "named_by": list(service.elements)}


def _plain(value: object) -> object:
    """Convert a value to JSON; infinity becomes text."""
    if isinstance(value, tuple):
        return [_plain(v) for v in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value

"""Lists of names, as the commands of `ros2` print them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from simkit.cli.terminal.output import print_json, print_name


def print_names(names: Sequence[str], *, count: bool = False, json_: bool) -> None:
    """Print names, one per line, or their number."""
    if json_:
        print_json(len(names) if count else list(names))
    else:
        for text in [str(len(names))] if count else names:
            print_name(text)


def print_names_and_types(types: Mapping[str, str], *, show_types: bool, count: bool, json_: bool) -> None:
    """Print names, one per line, optionally with their types, or their number."""
    if json_ and not count:
        print_json([{"name": name, "types": [type_name]} for name, type_name in types.items()])
    else:
        names = [f"{n} [{t}]" for n, t in types.items()] if show_types else list(types)
        print_names(names, count=count, json_=json_)

"""What the commands for topics, services and the like print, as lines or JSON."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ParamSpec

import typer

from simkit.cli.console import INTERRUPTED, guarded
from simkit.errors import InputError

P = ParamSpec("P")


def line(text: str = "") -> None:
    """One line on standard output, at once."""
    typer.echo(text)


def aside(text: str) -> None:
    """One line on standard error."""
    typer.echo(text, err=True)


def as_json(value: Any) -> None:
    """One JSON value on one line; what JSON has no number for is a text: `"inf"`, `"-inf"`, `"nan"`."""
    typer.echo(json.dumps(_finite(value), allow_nan=False, ensure_ascii=False))


def _finite(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, Mapping):
        return {str(k): _finite(v) for k, v in value.items()}
    return [_finite(v) for v in value] if isinstance(value, (list, tuple)) else value


def quiet(command: Callable[P, Any]) -> Callable[P, None]:
    """`guarded`, and an interrupt is the way to end it: no word about that, exit code 130."""

    @functools.wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> int:
        try:
            return int(command(*args, **kwargs) or 0)
        except KeyboardInterrupt:
            return INTERRUPTED

    return guarded(run)


def list_names(names: Sequence[str], *, count: bool, json_: bool) -> None:
    """Names, one a line, or how many there are."""
    if json_:
        as_json(len(names) if count else list(names))
    else:
        for text in [str(len(names))] if count else names:
            line(text)


def list_typed(types: Mapping[str, str], *, show_types: bool, count: bool, json_: bool) -> None:
    """Names, with their types where asked for, one a line, or how many there are."""
    if json_ and not count:
        as_json([{"name": name, "types": [type_name]} for name, type_name in types.items()])
    else:
        names = [f"{n} [{t}]" for n, t in types.items()] if show_types else list(types)
        list_names(names, count=count, json_=json_)


def none_of(what: str, name: str, there: Sequence[str] | Mapping[str, Any], code: str, where: str) -> InputError:
    """That something is not there, with the closest name or all there are."""
    from simkit.diagnostics import did_you_mean

    names = list(there)
    listed = ", ".join(names[:20]) + (f" and {len(names) - 20} more" if len(names) > 20 else "")
    hint = did_you_mean(name, names) or ("there is " + listed if names else "there is none")
    return InputError(f"{code} no {what} {name!r} in {where}; {hint}", code)


def absolute(name: str) -> str:
    """The name with its leading slash."""
    return name if name.startswith("/") else f"/{name}"


def is_hidden(name: str) -> bool:
    """Whether a part of a topic's or service's name begins with `_`, which ROS 2 leaves out of lists."""
    return any(part.startswith("_") for part in name.split("/"))

"""What the commands for topics, services and the like print, as lines or JSON, and what they are given."""

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
_SHOWN = 200  # letters of a text that are shown where it is wrong


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


def given(text: str, what: str) -> dict[str, Any]:
    """The mapping that a YAML text on the command line stands for; an empty text for none of its fields.

    Raises:
        InputError: SK-CLI-031 it is no YAML, or no mapping.
    """
    from simkit.sinks.yaml_text import NotYaml, read_yaml

    try:
        found = read_yaml(text)
    except NotYaml as error:
        shown = repr(text) if len(text) <= _SHOWN else f"{text[:_SHOWN]!r}…"
        raise InputError(f"SK-CLI-031 {what}: {shown} is not YAML: {error}", "SK-CLI-031") from None
    if found is None:
        return {}
    if not isinstance(found, dict) or any(not isinstance(key, str) for key in found):
        shown = repr(text) if len(text) <= _SHOWN else f"{text[:_SHOWN]!r}…"
        text = f"{what}: found {shown}, allowed is a mapping of fields such as '{{linear: {{x: 0.2}}}}'"
        raise InputError(f"SK-CLI-031 {text}", "SK-CLI-031")
    return found


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

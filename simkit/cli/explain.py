"""Command `simkit explain`: explain a diagnostic code."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated

from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import report_errors
from simkit.cli.terminal.options import argument
from simkit.cli.terminal.output import print_json, stdout_console
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.number_text import counted


@report_errors
def explain(
    code: Annotated[str, argument("Code such as SK-SDF-004, or the beginning of several codes.")],
    json_: options.Json = False,
) -> None:
    """Explain a diagnostic code, with its remedy and an example."""
    from simkit.cli.diagnostic_catalogue import catalogue, code_text

    prefix = code.strip().upper()
    prefix = prefix if prefix.startswith("SK-") else f"SK-{prefix}"
    codes = list(catalogue(prefix).values())
    if not codes:
        hint = did_you_mean(prefix, catalogue()) or "list all codes with `simkit explain SK-`"
        raise InputError("SK-CLI-017", f"there is no code {code!r}; {hint}")
    if json_:
        print_json([asdict(c) for c in codes], indent=2, default=_text)
    elif len(codes) == 1:
        stdout_console().print(code_text(codes[0]))
    else:
        for entry in codes:
            stdout_console().print(f"{entry.code}  {entry.severity:<14}  {entry.meaning}")


def _text(value: object) -> str:
    """Format a value that JSON does not support; bytes are replaced by a text with their number."""
    return f"({counted(len(value), 'byte')})" if isinstance(value, bytes) else str(value)

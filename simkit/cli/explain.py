"""The command `simkit explain`: explain a diagnostic code."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Annotated

from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument
from simkit.cli.terminal.output import report_errors, stdout_console
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError


@report_errors
def explain(
    code: Annotated[str, argument("A code such as SK-SDF-004, or the beginning of several.")],
    json_: options.Json = False,
) -> None:
    """Says what a code means, what helps, and shows an input that brings it about."""
    from simkit.cli.diagnostic_catalogue import catalogue, code_text

    wanted = code.strip().upper()
    wanted = wanted if wanted.startswith("SK-") else f"SK-{wanted}"
    found = list(catalogue(wanted).values())
    if not found:
        hint = did_you_mean(wanted, catalogue()) or "`simkit explain SK-` lists them all"
        raise InputError(f"SK-CLI-017 there is no code {code!r}; {hint}", "SK-CLI-017")
    if json_:
        stdout_console().file.write(json.dumps([asdict(c) for c in found], indent=2, default=_text) + "\n")
    elif len(found) == 1:
        stdout_console().print(code_text(found[0]))
    else:
        for entry in found:
            stdout_console().print(f"{entry.code}  {entry.severity:<14}  {entry.meaning}")


def _text(value: object) -> str:
    """Bytes of an example's file, which JSON cannot hold."""
    return f"({len(value)} bytes)" if isinstance(value, bytes) else str(value)

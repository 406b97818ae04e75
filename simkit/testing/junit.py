"""Write results as JUnit XML, which GitHub's actions, GitLab and Jenkins read."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from simkit.diagnostics import shorten
from simkit.writers.atomic_output import write_atomically

LONGEST: Final = 100_000
"""Letters of one text that are kept: the beginning and the end, with a word on what is left out."""

# what XML 1.0 cannot hold, also not as a character reference; and halves of a pair, which UTF-8 cannot
_ILLEGAL: Final = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
_COLOURS: Final = re.compile("\x1b\\[[0-9;?]*[ -/]*[@-~]|\x1b\\][^\x07\x1b]*(?:\x07|\x1b\\\\)")
_LONGEST_NAME: Final = 2_000  # letters of a name or of a message


@dataclass(frozen=True)
class JunitCase:
    """Result of one test.

    At most one of `failure`, `error` and `skipped` is given; without any it passed.

    Attributes:
        name: of the case within its class.
        classname: what it belongs to; dots group it in most viewers.
        seconds: wall time that it took [s].
        failure: it did not hold: one line, and the whole text.
        error: it could not be tried: one line, and the whole text.
        skipped: why it was not tried.
        output: what else there is to say.
        file: where it is written, for viewers that link to it.
    """

    name: str
    classname: str = ""
    seconds: float = 0.0
    failure: tuple[str, str] | None = None
    error: tuple[str, str] | None = None
    skipped: str | None = None
    output: str = ""
    file: str = ""


def write_junit(path: str | os.PathLike[str], suite: str, cases: Sequence[JunitCase]) -> None:
    """Writes a file of results; it is there as a whole or not at all.

    Args:
        path: of the file; folders on the way are made.
        suite: what the cases are, in a word or two.
        cases: in the order in which they are shown.

    Raises:
        InputError: SK-CLI-016 the file cannot be written.
    """
    write_atomically(path, junit_text(suite, cases).encode())


def junit_text(suite: str, cases: Sequence[JunitCase]) -> str:
    """The whole file as text; equal for equal cases, no time of day is in it."""
    counts = {
        "tests": len(cases),
        "failures": sum(case.failure is not None for case in cases),
        "errors": sum(case.error is not None for case in cases),
        "skipped": sum(case.skipped is not None for case in cases),
    }
    total = {**counts, "time": _seconds(math.fsum(map(_finite_seconds, cases)))}
    head = "".join(f' {name}="{value}"' for name, value in total.items())
    lines = [
        '<?xml version="1.0" encoding="utf-8"?>',
        f'<testsuites name="{_attribute_text(suite)}"{head}>',
        f'  <testsuite name="{_attribute_text(suite)}"{head}>',
    ]
    for case in cases:
        lines += _case(case)
    return "\n".join([*lines, "  </testsuite>", "</testsuites>", ""])


def _case(case: JunitCase) -> list[str]:
    attributes = {"name": case.name or "unnamed", "classname": case.classname or "simkit", "file": case.file}
    head = "".join(f' {name}="{_attribute_text(value)}"' for name, value in attributes.items() if value)
    head += f' time="{_seconds(_finite_seconds(case))}"'
    inside = []
    for tag, told in (("error", case.error), ("failure", case.failure)):
        if told is not None:
            inside.append(f'<{tag} message="{_attribute_text(told[0])}" type="simkit">{_element_text(told[1])}</{tag}>')
    if case.skipped is not None:
        inside.append(f'<skipped message="{_attribute_text(case.skipped)}"/>')
    if case.output:
        inside.append(f"<system-out>{_element_text(case.output)}</system-out>")
    if not inside:
        return [f"    <testcase{head}/>"]
    return [f"    <testcase{head}>", *(f"      {line}" for line in inside), "    </testcase>"]


def _finite_seconds(case: JunitCase) -> float:
    return case.seconds if math.isfinite(case.seconds) and case.seconds > 0.0 else 0.0


def _seconds(value: float) -> str:
    return f"{value:.3f}"


def _element_text(text: str) -> str:
    """Text between tags: what XML cannot hold is shown as a mark, colours are left out."""
    text = _COLOURS.sub("", text.replace("\r\n", "\n").replace("\r", "\n"))
    if len(text) > LONGEST:
        text = f"{text[: LONGEST // 2]}\n… {len(text) - LONGEST} letters left out …\n{text[-LONGEST // 2 :]}"
    return _ILLEGAL.sub("\ufffd", text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _attribute_text(text: str) -> str:
    """Text of an attribute: one line."""
    line = " ".join(_COLOURS.sub("", text).split())
    return _element_text(shorten(line, _LONGEST_NAME)).replace('"', "&quot;")

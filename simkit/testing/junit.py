"""Writer of JUnit XML, which GitHub Actions, GitLab and Jenkins read."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from simkit.diagnostics import shorten
from simkit.number_text import counted
from simkit.writers.atomic_output import write_atomically

LONGEST: Final = 100_000
"""Maximum length of a text in characters; a longer text loses its middle part."""

# characters that XML 1.0 does not allow (even as a character reference), and surrogates, which UTF-8 cannot encode
_ILLEGAL: Final = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
_COLOURS: Final = re.compile("\x1b\\[[0-9;?]*[ -/]*[@-~]|\x1b\\][^\x07\x1b]*(?:\x07|\x1b\\\\)")
_LONGEST_NAME: Final = 2_000  # maximum length of a name or a message in characters


@dataclass(frozen=True)
class JunitCase:
    """Result of one test.

    At most one of `failure`, `error` and `skipped` is set. A case without any of them passed.

    Attributes:
        name: Name of the case within its class.
        classname: Class of the case; most viewers group it at dots.
        seconds: Wall time [s].
        failure: Summary line and full text of a failure.
        error: Summary line and full text of an error that prevented the test.
        skipped: Reason why the test was skipped.
        output: Further output.
        file: Source file, for viewers with links.
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
    """Write a file of results atomically.

    Args:
        path: File to write; missing folders are created.
        suite: Short name of the test suite.
        cases: Cases in display order.

    Raises:
        InputError: SK-CLI-016 the file cannot be written.
    """
    write_atomically(path, junit_text(suite, cases).encode())


def junit_text(suite: str, cases: Sequence[JunitCase]) -> str:
    """Return the content of the file; the content has no date or time, so that equal cases give equal texts."""
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
    for tag, result in (("error", case.error), ("failure", case.failure)):
        if result is not None:
            inside.append(
                f'<{tag} message="{_attribute_text(result[0])}" type="simkit">{_element_text(result[1])}</{tag}>'
            )
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
    """Escape a text between tags, replace characters that XML does not allow, and remove terminal colours."""
    text = _COLOURS.sub("", text.replace("\r\n", "\n").replace("\r", "\n"))
    if len(text) > LONGEST:
        text = (
            f"{text[: LONGEST // 2]}\n… {counted(len(text) - LONGEST, 'character')} left out …\n{text[-LONGEST // 2 :]}"
        )
    return _ILLEGAL.sub("\ufffd", text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _attribute_text(text: str) -> str:
    """Escape the text of an attribute and join its lines."""
    line = " ".join(_COLOURS.sub("", text).split())
    return _element_text(shorten(line, _LONGEST_NAME)).replace('"', "&quot;")

"""Command `xacro` that a launch file can start while it is read: `python -m simkit_launch.xacro_command FILE …`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

from simkit.diagnostics import NOWHERE, Diagnostics
from simkit_launch.command_output import xacro_output


def expand_file(words: Sequence[str], output: TextIO, errors: TextIO) -> int:
    """Write the expanded text of a file into an output, or into the file after `-o`; return the exit code.

    Args:
        words: words after `xacro`.
        output: output for the text.
        errors: output for the problems.
    """
    problems = Diagnostics()
    text = xacro_output(words, NOWHERE, problems)
    for problem in problems:
        errors.write(f"{problem}\n")
    if text is None:
        return 2
    if "-o" not in words[:-1]:
        output.write(text)
        return 0
    target = Path(words[words.index("-o") + 1])
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(expand_file(sys.argv[1:], sys.stdout, sys.stderr))

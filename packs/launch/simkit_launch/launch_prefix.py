"""Words before the command line of a process, such as `xterm -e` or `bash -c 'sleep 5; $0 $@'`."""

from __future__ import annotations

import re
from typing import Final

from simkit.extend import Diagnostics, Where

WITHOUT_EFFECT: Final = "SK-LAUNCH-029"

_SLEEP: Final = re.compile(r"\bsleep\s+(\d+(?:\.\d+)?|\.\d+)")


def prefix_delay(prefix: str, where: Where, diagnostics: Diagnostics) -> float:
    """Return the time that a prefix sleeps before it starts the program [s]; any other prefix is noted.

    Args:
        prefix: prefix.
        where: place in the launch file.
        diagnostics: collection that receives the note.
    """
    if not prefix.strip():
        return 0.0
    sleep = _SLEEP.search(prefix)
    if sleep is None:
        message = f"launch-prefix={prefix!r} has no effect: the program runs inside simkit"
        diagnostics.note(WITHOUT_EFFECT, message, where)
    return float(sleep[1]) if sleep else 0.0

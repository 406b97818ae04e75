"""Reports of plugins that block a run. A second thread reads the stack of the run, so that the run does not change."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from types import FrameType
from typing import Final

PATIENCE: Final = 5.0  # [s] of wall time
_PATIENCE_AFTER_STOP: Final = 0.5  # [s] of wall time, after Ctrl-C
_CHECK_PERIOD: Final = 0.25  # [s] of wall time


class BlockedPlugins:
    """Context manager that reports a plugin whose hook or callback does not return.

    Args:
        say: callback for the report, a line of text.
        patience: wall time of a call before its first report [s]; doubled for each further report.
    """

    def __init__(self, say: Callable[[str], None], patience: float = PATIENCE) -> None:
        self._say, self._patience = say, patience
        self._watched = threading.get_ident()
        self._over = threading.Event()
        self._is_stopping = False
        self._thread = threading.Thread(target=self._watch, name="simkit blocked plugins", daemon=True)

    def __enter__(self) -> BlockedPlugins:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    def hasten(self) -> None:
        """Report a blocking plugin sooner, after the user has requested a stop."""
        self._is_stopping = True

    def _watch(self) -> None:
        seen: FrameType | None = None
        begun, report_after, was_stopping = 0.0, 0.0, False
        while not self._over.wait(_CHECK_PERIOD):
            outer, text = describe_blocking_plugin(sys._current_frames().get(self._watched)) or (None, "")
            now = time.monotonic()
            if outer is None or outer is not seen:
                seen, begun, report_after = outer, now, self._patience
                continue
            if self._is_stopping and not was_stopping:
                was_stopping = True
                report_after = min(report_after, now - begun + _PATIENCE_AFTER_STOP)
            if now - begun >= report_after:
                report_after = max(2 * report_after, self._patience)
                ending = "; Ctrl-C again stops at once" if self._is_stopping else ""
                self._say(f"waiting for {text}, for {now - begun:.0f} s now{ending}")


def describe_blocking_plugin(frame: FrameType | None) -> tuple[FrameType, str] | None:
    """Find the active plugin in a stack.

    Returns:
        Frame of the plugin's outermost call, and a description of its innermost call; None if no plugin is active.
    """
    if "simkit.runtime.engine.plugin_faults" not in sys.modules:  # the engine is not imported yet
        return None
    from simkit.runtime.engine.plugin_faults import active_plugin_calls

    calls = active_plugin_calls(frame)
    if not calls:
        return None
    plugin, hook = calls[0].plugin, calls[0].hook
    return calls[-1].frame, f"plugin {plugin.name!r} ({plugin.where}) in {hook}, at {calls[0].line}"

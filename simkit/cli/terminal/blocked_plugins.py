"""Report which plugin keeps a run waiting; a second thread reads the stack, so that the run is not changed."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from types import FrameType
from typing import Final

PATIENCE: Final = 5.0  # [s] of wall time
_PATIENCE_AFTER_STOP: Final = 0.5  # after a wish to stop
_CHECK_PERIOD: Final = 0.25


class BlockedPlugins:
    """While entered, tells of a plugin whose hook or callback does not come to its end.

    Args:
        say: gets the line.
        patience: how long a call may take before it is told of [s of wall time]; then twice as long, and so on.
    """

    def __init__(self, say: Callable[[str], None], patience: float = PATIENCE) -> None:
        self._say, self._patience = say, patience
        self._watched = threading.get_ident()
        self._over = threading.Event()
        self._is_asked = False
        self._thread = threading.Thread(target=self._watch, name="simkit blocked plugins", daemon=True)

    def __enter__(self) -> BlockedPlugins:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    def ask(self) -> None:
        """After a wish to stop: what keeps the run from it is told of sooner."""
        self._is_asked = True

    def _watch(self) -> None:
        seen: FrameType | None = None
        begun, told, was_asked = 0.0, 0.0, False
        while not self._over.wait(_CHECK_PERIOD):
            outer, text = describe_blocking_plugin(sys._current_frames().get(self._watched)) or (None, "")
            now = time.monotonic()
            if outer is None or outer is not seen:
                seen, begun, told = outer, now, self._patience
                continue
            if self._is_asked and not was_asked:
                was_asked = True
                told = min(told, now - begun + _PATIENCE_AFTER_STOP)
            if now - begun >= told:
                told = max(2 * told, self._patience)
                ending = "; Ctrl-C again stops at once" if self._is_asked else ""
                self._say(f"waiting for {text}, for {now - begun:.0f} s now{ending}")


def describe_blocking_plugin(frame: FrameType | None) -> tuple[FrameType, str] | None:
    """Find the plugin at work in a stack: the frame of its outermost call, and the innermost call in words."""
    if "simkit.runtime.engine.plugin_faults" not in sys.modules:  # still on the way to the engine
        return None
    from simkit.runtime.engine.plugin_faults import active_plugin_calls

    calls = active_plugin_calls(frame)
    if not calls:
        return None
    plugin, hook = calls[0].plugin, calls[0].hook
    return calls[-1].frame, f"plugin {plugin.name!r} ({plugin.where}) in {hook}, at {calls[0].line}"

"""Viewer window for a running simulation: MuJoCo's own viewer, updated from the run loop."""

from __future__ import annotations

import os
import sys
import time
from typing import TYPE_CHECKING, Any

from simkit.errors import InputError
from simkit.install_command import install_command

if TYPE_CHECKING:
    from simkit import Simulation

_REFRESH = 1 / 60  # [s]
_HELP = "run without --view, use --picture out.png, or record and open the bag in Foxglove"


def check_possible() -> None:
    """Check before a run whether a viewer window can open.

    Raises:
        InputError: SK-CLI-015 there is no display, or no window library.
    """
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise InputError("SK-CLI-015", "--view: there is no display (DISPLAY is not set)", help=_HELP)
    try:
        import glfw

        _ = glfw.init  # the first use loads the library
    except ImportError as error:
        text = f"--view: the window library is missing ({error})"
        raise InputError("SK-CLI-015", text, help=install_command("view")) from None


class Viewer:
    """Window that shows a simulation; a context manager."""

    def __init__(self, sim: Simulation) -> None:
        import mujoco.viewer

        try:
            self._handle: Any = mujoco.viewer.launch_passive(
                sim.mj_model, sim.mj_data, show_left_ui=False, show_right_ui=False
            )
        except RuntimeError as error:
            raise InputError("SK-CLI-015", f"--view: {error}", help=_HELP) from None
        self._last = 0.0

    def is_open(self) -> bool:
        """Check whether the window is still open."""
        return bool(self._handle.is_running())

    def update(self) -> None:
        """Show the present state, at most 60 times a second."""
        now = time.perf_counter()
        if now - self._last >= _REFRESH:
            self._last = now
            self._handle.sync()

    def __enter__(self) -> Viewer:
        return self

    def __exit__(self, *_: object) -> None:
        self._handle.close()

"""Warnings that a running plugin reports only once, however often their cause occurs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.plugins.not_deep_copied import SharedByCopies

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin


class OneTimeWarnings(SharedByCopies):
    """Warnings of a plugin, each reported once, even after resets; a handle without state that a reset clears."""

    def __init__(self, plugin: Plugin) -> None:
        self._plugin = plugin
        self._reported: set[str] = set()

    def warn(self, code: str, cause: str, message: str, hint: str = "") -> None:
        """Report a warning at the plugin's line, once for each `cause`."""
        if cause not in self._reported:
            self._reported.add(cause)
            plugin = self._plugin
            plugin.sim.engine.reports.warning(code, f"plugin {plugin.name!r}: {message}", plugin.where, hint)

    def left_out(self, cause: str, message: str, hint: str = "") -> None:
        """Warn that a command is ignored."""
        self.warn("SK-PLUGIN-041", cause, message, hint)

    def not_finite(self, command: str = "a command") -> None:
        """Warn that a command with a NaN or infinite number is ignored."""
        self.left_out("finite", f"{command} with a NaN or infinite number is ignored")

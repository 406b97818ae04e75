"""Report each warning of a running plugin once, however often its cause occurs."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin


class OneTimeWarnings:
    """Reports of a plugin that are made once each, in spite of resets; a handle, without state that a reset forgets."""

    def __init__(self, plugin: Plugin) -> None:
        self._plugin = plugin
        self._said: set[str] = set()

    def warn(self, code: str, what: str, message: str, hint: str = "") -> None:
        """A warning at the plugin's line, once for each `what`."""
        if what not in self._said:
            self._said.add(what)
            plugin = self._plugin
            plugin.sim.engine.reports.warning(code, f"plugin {plugin.name!r}: {message}", plugin.where, hint)

    def left_out(self, what: str, message: str, hint: str = "") -> None:
        """Says that a command cannot be used."""
        self.warn("SK-PLUGIN-041", what, message, hint)

    def not_finite(self, command: str = "a command") -> None:
        """Says that a command with a number that is none cannot be used."""
        self.left_out("finite", f"{command} with a number that is not finite is left out")

    def __deepcopy__(self, memo: dict[int, object]) -> OneTimeWarnings:
        return self

"""Warnings of a running plugin: each is reported only once, even if its cause occurs many times."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Protocol

from simkit.plugins.not_deep_copied import SharedByCopies

if TYPE_CHECKING:
    from simkit.diagnostics import Where
    from simkit.msgs import Message
    from simkit.runtime import Simulation

_LEFT_OUT: Final = "SK-PLUGIN-041"
LARGEST_COMMAND: Final = 1e10
"""Largest absolute value of a command. MuJoCo counts larger velocities and accelerations as a divergence."""


def are_usable(*values: float) -> bool:
    """Check whether the numbers of a command are neither NaN nor beyond `LARGEST_COMMAND`."""
    return all(abs(value) <= LARGEST_COMMAND for value in values)


class Reporter(Protocol):
    """Plugin whose warnings are reported."""

    name: str
    where: Where
    sim: Simulation


class OneTimeWarnings(SharedByCopies):
    """Reporter of a plugin's warnings. A reset of the simulation does not make it report a warning again.

    Args:
        plugin: plugin that reports the warnings.
        label: beginning of the messages, such as `controller 'arm'`; empty for the plugin's own name.
        where: location of the warnings; None for the plugin's own location.
    """

    def __init__(self, plugin: Reporter, label: str = "", where: Where | None = None) -> None:
        self._plugin, self._label, self._where = plugin, label, where
        self._reported: set[str] = set()

    def warn(self, code: str, cause: str, message: str, hint: str = "") -> None:
        """Report a warning, once for each `cause`."""
        if cause not in self._reported:
            self._reported.add(cause)
            plugin = self._plugin
            label = self._label or f"plugin {plugin.name!r}"
            where = plugin.where if self._where is None else self._where
            plugin.sim.engine.reports.warning(code, f"{label}: {message}", where, hint)

    def left_out(self, cause: str, message: str, hint: str = "") -> None:
        """Warn that a command is ignored."""
        self.warn(_LEFT_OUT, cause, message, hint)

    def not_finite(self, command: str = "a command") -> None:
        """Warn that a command with a NaN or infinite number is ignored."""
        text = f"{command} with a NaN or infinite number is ignored"
        self.left_out("finite", text, f"numbers above {LARGEST_COMMAND:g} count as infinite")

    def has_type(self, message: Message, expected: str, parameter: str, code: str = _LEFT_OUT) -> bool:
        """Check the type of a message, and warn that a message of another type is ignored.

        Args:
            message: message.
            expected: type that the plugin needs.
            parameter: parameter with the name of the topic.
            code: code of the warning.
        """
        type_name: str = message.__msgtype__
        if type_name != expected:
            text = f"messages of the type {type_name} on <{parameter}> are ignored; expected {expected}"
            self.warn(code, f"type of {parameter}", text, f"check <{parameter}>")
        return type_name == expected

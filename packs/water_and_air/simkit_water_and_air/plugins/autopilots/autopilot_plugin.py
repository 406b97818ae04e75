"""Base class of plugins that connect a vehicle to an autopilot."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from simkit import ModelPlugin
from simkit.plugins.joints.joint_commands import ControlledJoints

if TYPE_CHECKING:
    from simkit_water_and_air.plugins.autopilots.autopilot_link import AutopilotLink


class AutopilotPlugin(ControlledJoints, ModelPlugin):
    """Plugin with a connection to an autopilot, which snapshots do not contain.

    `prepare` sets `_place` to address and port, and `load` sets `_connection`.
    """

    drives = True
    _connection: AutopilotLink
    _place: tuple[str, int]
    _was_opened: bool = False

    @property
    def port(self) -> int:
        """Number of the open port; 0 while it is closed."""
        return self._connection.port

    @property
    def is_connected(self) -> bool:
        """True while there is a connection to an autopilot."""
        return self._connection.is_connected

    def open_once(self, protocol: str) -> bool:
        """Open the port at the first step, so that loading or checking a world opens none.

        Args:
            protocol: UDP or TCP.

        Returns:
            True if this call has opened the port.
        """
        if self._was_opened:
            return False
        self._was_opened = True
        address, port = self._place
        try:
            self._connection.open()
        except (OSError, OverflowError, UnicodeError) as error:
            where = f"{address}:{port} ({protocol})"
            message = f"cannot listen at {where}: {error}; the run continues without an autopilot"
            hint = "end the other simulation that uses the port, or change the port in the file"
            self._once.warn("SK-PILOT-002", "port", message, hint)
            return False
        return True

    def report_absence(self, seconds: float) -> None:
        """Warn that no autopilot has come within a time [s], if there is none."""
        if not self.is_connected:
            autopilot, (address, port) = self._connection.autopilot, self._place
            message = f"no connection of {autopilot} at {address}:{port} within {seconds:g} s; the run continues"
            self._once.warn("SK-PILOT-003", "absent", message, f"start {autopilot} first")

    # ------------------------------------------------------------------ snapshots

    def get_state(self) -> dict[str, object]:
        """Return the state of the plugin; the connection is not part of it."""
        return {name: value for name, value in super().get_state().items() if name not in _KEPT}

    def set_state(self, state: Mapping[str, object]) -> None:
        """Restore a state; the autopilot then receives the state of the vehicle at the new time."""
        self._connection.break_time()
        super().set_state({**state, **{name: value for name, value in vars(self).items() if name in _KEPT}})

    def close(self) -> None:
        """Close the port."""
        if "_connection" in vars(self):
            self._connection.close()


_KEPT = frozenset(("_connection", "_was_opened"))

"""Signal handlers. The simulation ends programs with KeyboardInterrupt, so there are none."""

from __future__ import annotations

from enum import IntEnum

__all__ = [
    "SignalHandlerOptions",
    "get_current_signal_handlers_options",
    "install_signal_handlers",
    "uninstall_signal_handlers",
]


class SignalHandlerOptions(IntEnum):
    """Signals that rclpy handles."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Do nothing."""


def uninstall_signal_handlers() -> None:
    """Do nothing."""


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Return that no signal is handled."""
    return SignalHandlerOptions.NO

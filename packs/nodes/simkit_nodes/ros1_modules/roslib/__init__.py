"""Package `roslib` of ROS 1."""

from __future__ import annotations

__all__ = ["is_interactive", "load_manifest", "set_interactive"]


def load_manifest(package_name: str, bootstrap_version: str = "0.7") -> None:
    """Do nothing: a program imports the packages of its workspace without it."""


def is_interactive() -> bool:
    """Check whether the program runs in an interactive shell."""
    return False


def set_interactive(interactive: bool) -> None:
    """Do nothing: programs do not run in an interactive shell."""

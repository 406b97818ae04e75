"""Exceptions of actions."""

from __future__ import annotations

__all__ = ["ActionException"]


class ActionException(Exception):
    """A class is not that of an action."""

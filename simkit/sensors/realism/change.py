"""Base class of the changes that a realism makes to the sensors and plugins of one world or spawned model."""

from __future__ import annotations

import abc
from collections.abc import Iterable

from simkit.diagnostics import Diagnostics
from simkit.scene import SceneSensor
from simkit.scene.model import ScenePlugin

_MOST_LISTED = 12


class Change(abc.ABC):
    """Changes to the sensors and plugins of one world or model; an object is used once.

    Args:
        diagnostics: collection for the notes, and for errors of a file.
    """

    def __init__(self, diagnostics: Diagnostics) -> None:
        self.diagnostics = diagnostics

    @abc.abstractmethod
    def sensor(self, sensor: SceneSensor) -> SceneSensor:
        """Return a sensor with its changes."""

    @abc.abstractmethod
    def plugin(self, plugin: ScenePlugin) -> ScenePlugin:
        """Return a plugin with its changes."""

    @abc.abstractmethod
    def report(self, *, is_world: bool) -> None:
        """Report what was changed, after all sensors and plugins; a spawned model needs no complete list."""


def listed(names: Iterable[str]) -> str:
    """Return names in a row, at most twelve of them."""
    found = list(names)
    more = f" and {len(found) - _MOST_LISTED} more" if len(found) > _MOST_LISTED else ""
    return ", ".join(found[:_MOST_LISTED]) + more

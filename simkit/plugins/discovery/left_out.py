"""Sensors and plugins of files that have errors, and are therefore left out of a world that runs without them.

Gazebo reports a plugin with an unknown joint and continues without the plugin. The errors that are reported while a
sensor or plugin is made and loaded belong to it (`Diagnostics.blame`). They become warnings, the world is built again
without the sensor or plugin, and a warning tells what is missing. An error at a place that the user has named in the
command, and every error of a strict load, stays an error.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.number_text import counted
from simkit.scene import ScenePlugin, SceneSensor
from simkit.scene.overrides import SOURCE_PREFIX

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin

CODE: Final = "SK-LOAD-013"
DRIVE_CODE: Final = "SK-LOAD-014"
"""Code for a plugin that drives joints: without it, the robot does not follow its commands."""
_HINT: Final = "correct the errors above; with --strict they stop the run"
_VERBS: Final = {
    "publishes": "nothing is published on",
    "listens": "no command is received on",
    "offers": "there is no service",
    "acts": "there is no action",
}


class LeftOutParts:
    """Sensors and plugins that are left out of the worlds of one load.

    Args:
        strict: True to leave nothing out, so that every error stops the load.

    Attributes:
        is_strict: True if nothing is left out.
    """

    def __init__(self, *, strict: bool = False) -> None:
        self.is_strict, self._user_files = strict, set[str]()
        self._parts: dict[int, ScenePlugin | SceneSensor] = {}
        self._classes: dict[int, type[Plugin]] = {}

    def __contains__(self, part: ScenePlugin | SceneSensor) -> bool:
        return id(part) in self._parts

    def describe(self, plugin: ScenePlugin, cls: type[Plugin]) -> None:
        """Store the class of a plugin, which tells what does not work without the plugin."""
        self._classes[id(plugin)] = cls

    def add_user_files(self, files: Iterable[str]) -> None:
        """Add files that the user has named for plugins; an error in these files stops the load."""
        self._user_files.update(files)

    def take(self, diagnostics: Diagnostics) -> bool:
        """Leave out the sensors and plugins that have errors: their errors become warnings.

        Returns:
            True if all errors belonged to such sensors and plugins, so that the world can be built without them.
        """
        if self.is_strict:
            return False
        found, present = False, {item for item in diagnostics if item.severity == "error"}
        for part, reported in diagnostics.blamed():
            errors = [error for error in dict.fromkeys(reported) if error in present]
            if not errors or not isinstance(part, (ScenePlugin, SceneSensor)) or not all(map(self.allows, errors)):
                continue
            diagnostics.soften(errors)
            if part not in self:
                self._parts[id(part)] = part
                found = True
                self._report(part, len(errors), diagnostics)
        return found and not diagnostics.has_errors

    def allows(self, error: Diagnostic) -> bool:
        """Check whether what has an error may be left out: not in a strict load, nor for a value of the user."""
        file = error.file or ""
        return not (self.is_strict or file.startswith(SOURCE_PREFIX) or file in self._user_files)

    def _report(self, part: ScenePlugin | SceneSensor, count: int, diagnostics: Diagnostics) -> None:
        errors = "an error" if count == 1 else counted(count, "error")
        if isinstance(part, SceneSensor):
            text = f"sensor {part.scoped!r} ({part.kind}) is left out, because it has {errors}; it has no readings"
            text += " and its plugins do not run" if part.plugins else ""
            diagnostics.warning(CODE, text, part.where, _HINT)
            return
        cls = self._classes.get(id(part))
        owner = f" of {part.scoped!r}" if part.scoped else ""
        text = f"plugin {part.name!r} ({part.filename}){owner} is left out, because it has {errors}"
        drives = cls is not None and cls.drives
        if drives:
            text += f"; {part.scoped!r} does not follow the commands that the plugin would receive"
        text = "; ".join((text, *(() if cls is None else _missing(cls, part.scoped))))
        diagnostics.warning(DRIVE_CODE if drives else CODE, text, part.where, _HINT)


def _missing(cls: type[Plugin], scoped: str) -> Iterable[str]:
    """Yield what a world lacks without a plugin of this class."""
    for role, text in _VERBS.items():
        names = [e.name.replace("{model}", scoped) for e in cls.endpoints if e.role == role]
        if names:
            yield f"{text} {', '.join(dict.fromkeys(names))}"
    summary = (cls.__doc__ or "").strip().partition("\n")[0].rstrip(".")
    if summary:
        yield f"what the plugin does: {summary[:1].lower()}{summary[1:]}"

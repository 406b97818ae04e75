"""Search for the class of a plugin by its name in a file, among the plugins of simkit and of users."""

from __future__ import annotations

import functools
import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from shlex import quote
from types import MappingProxyType
from typing import Final

from simkit.diagnostics import Diagnostics, closest
from simkit.packs import left_out_names, missing_pack_text
from simkit.plugins.base import ParentKind, Plugin, SensorPlugin
from simkit.plugins.discovery.user_plugins import find_user_plugin
from simkit.plugins.plugin_names import ENTRY_POINT_GROUP, aliases, normalise
from simkit.registry import Kinds
from simkit.scene import ScenePlugin, SceneSensor

_TABLE: Final = tomllib.loads(Path(__file__).with_name("unsupported_plugins.toml").read_text(encoding="utf-8"))

GAZEBO_PLUGINS: frozenset[str] = frozenset(
    [f"gz-sim-{name}-system" for name in _TABLE["gz_systems"].split()]
    + [f"gazebo_ros_{name}" for name in _TABLE["classic_ros"].split()]
    + _TABLE["control"].split()
    + _TABLE["classic"].split()
)
"""Library names of Gazebo's plugins, normalised by `normalise`."""


@dataclass(frozen=True)
class UnsupportedPlugin:
    """Reason why simkit does not support a plugin.

    Attributes:
        reason: clause that describes the plugin or what to use instead.
        is_decoration: true if only pictures differ without the plugin.
        family: name of the family of plugins that a file reports once; empty for a plugin of its own.
    """

    reason: str
    is_decoration: bool = False
    family: str = ""


def _unsupported_by_name() -> dict[str, UnsupportedPlugin]:
    found: dict[str, UnsupportedPlugin] = {}
    for row in (*_TABLE["gz"], *_TABLE["libraries"]):
        plugin = UnsupportedPlugin(row["reason"], row.get("is_decoration", False), row.get("family", ""))
        for name in row["names"].split():
            part, is_system, cls = name.partition(":") if row in _TABLE["gz"] else (name, "", "")
            names = (f"gz-sim-{part}-system", f"gz::sim::systems::{cls}") if is_system else (name,)
            found.update(dict.fromkeys(names, plugin))
    return found


UNSUPPORTED: Final = MappingProxyType(_unsupported_by_name())
"""Unsupported plugins with a reason, by library name or gz class name; the names are normalised by `normalise`."""

UNSUPPORTED_REASONS: Final = MappingProxyType({name: plugin.reason for name, plugin in UNSUPPORTED.items()})
"""Reason by library name or gz class name."""


@functools.cache
def plugin_kinds() -> Kinds[Plugin]:
    """Return all known plugin classes by their normalised names; read-only."""

    def names(cls: type[Plugin]) -> list[str]:
        return [normalise(name) for name in (*cls.filenames, *cls.names)]

    attributes = ("filenames", "names")
    return Kinds("simkit.plugins", ENTRY_POINT_GROUP, Plugin, names, attributes, normalise)  # type: ignore[type-abstract]


def find_plugin(
    plugin: ScenePlugin,
    plugin_paths: Sequence[Path] = (),
    diagnostics: Diagnostics | None = None,
    parent: ParentKind = "any",
) -> type[Plugin] | None:
    """Return the class of a plugin in a file, or None after a diagnostic with the reason.

    A file can only use installed or allowed classes: those of simkit, of entry points in the group `simkit.plugins` (by
    alias or as `module:Class`), and of modules in a folder of `plugin_paths`.

    Args:
        plugin: plugin as read from the file.
        plugin_paths: folders whose modules the user allows (`--plugin-path`).
        diagnostics: collector of problems; the file's own collector by default.
        parent: kind of entity that the plugin is attached to; a class for another kind is ignored. With "any", a plugin
            with an empty scope is attached to the world, and the entity of any other plugin is unknown.
    """
    if plugin.filename == "__default__":  # SDF's text for an attribute without a value; Gazebo loads nothing either
        return None
    collector = diagnostics if diagnostics is not None else plugin.params.diagnostics
    kinds = plugin_kinds()
    cls = next((kinds[alias] for alias in aliases(plugin) if alias in kinds), None)
    if cls is None:
        reported = len(collector)
        cls = find_user_plugin(plugin, plugin_paths, collector)
        if cls is None and len(collector) == reported:
            _report_unknown(plugin, collector, parent)
    if parent == "any" and not plugin.scoped:
        parent = "world"
    if cls is not None and not _fits(cls, plugin, parent, collector):
        return None
    return cls


def complete_sensor(sensor: SceneSensor) -> SceneSensor:
    """Return a sensor with the elements that its plugins have in place of it."""
    kinds = plugin_kinds()
    for plugin in sensor.plugins:
        cls = next((kinds[alias] for alias in aliases(plugin) if alias in kinds), None)
        if cls is not None and issubclass(cls, SensorPlugin):
            sensor = cls.complete(sensor, plugin.params)
    return sensor


def _fits(cls: type[Plugin], plugin: ScenePlugin, parent: ParentKind, diagnostics: Diagnostics) -> bool:
    """Check whether the class can be attached to this kind of parent; if not, report a warning with the right kind."""
    kinds = (cls.parent_kind,) if isinstance(cls.parent_kind, str) else cls.parent_kind
    if parent == "any" or "any" in kinds or parent in kinds:
        return True
    places = " or a ".join(kinds)
    message = f"plugin {plugin.filename!r} is ignored: it is for a {places}, but is attached to a {parent}"
    hint = f"move the <plugin> into the {' or '.join(f'<{kind}>' for kind in kinds)}"
    diagnostics.warning("SK-PLUGIN-007", message, plugin.where, hint)
    return False


def _report_unknown(plugin: ScenePlugin, diagnostics: Diagnostics, parent: ParentKind) -> None:
    names = aliases(plugin)
    if fault := next(filter(None, map(plugin_kinds().fault, names)), None):
        message = f"plugin {plugin.filename!r} (name {plugin.name!r}) cannot be imported: {fault}"
        diagnostics.error("SK-PLUGIN-008", message, plugin.where)
        return
    packs = {normalise(name): pack for name, pack in left_out_names("filenames", "names").items()}
    if missing := next((packs[name] for name in names if name in packs), None):
        need, advice = missing_pack_text(missing)
        message = f"plugin {plugin.filename!r} (name {plugin.name!r}) {need}; it is ignored"
        diagnostics.warning("SK-PLUGIN-001", message, plugin.where, advice)
        return
    unsupported = next((UNSUPPORTED[name] for name in names if name in UNSUPPORTED), None)
    if unsupported is not None or GAZEBO_PLUGINS.intersection(names):
        _report_unsupported(plugin, unsupported, diagnostics)
        return
    spelled = plugin_kinds().written
    cores = {_core(name): spelled[name] for name in sorted(spelled, reverse=True)}
    near = next(filter(None, (closest(_core(name), cores, 0.7) for name in names)), None)
    on = "" if parent in ("any", "model") else f" --on {parent}"
    new = f"simkit plugin new {quote(plugin.filename.rpartition('/')[2])}{on}"
    others = (
        f"`{new}` creates a Python class for this name, which `--plugin-path .` loads instead of the C++ library "
        "(docs/writing_a_plugin.md); or install the pack that has it"
    )
    known = f"did you mean {cores[near]!r}? Else, " if near else "`simkit plugin list` shows all names; "
    message = f"unknown plugin {plugin.filename!r} (name {plugin.name!r}); it is ignored"
    diagnostics.warning("SK-PLUGIN-001", message, plugin.where, known + others)


def _report_unsupported(plugin: ScenePlugin, known: UnsupportedPlugin | None, diagnostics: Diagnostics) -> None:
    hint = "supported plugins: docs/catalogue.md; to write it in Python: docs/writing_a_plugin.md"
    named = f"plugin {plugin.filename!r} (name {plugin.name!r})"
    if known is not None and known.is_decoration:
        diagnostics.note("SK-PLUGIN-002", f"{named} is left out: {known.reason}", plugin.where)
        return
    message = f"{named} is a Gazebo plugin that simkit does not support; it is ignored"
    if known is not None and known.family:
        message = f"the plugins of {known.family} are ignored: {known.reason}"
        if any(item.message == message for item in diagnostics):
            return
    elif known is not None:
        message += f": {known.reason}"
    diagnostics.warning("SK-PLUGIN-002", message, plugin.where, hint)


def _core(name: str) -> str:
    """Return a normalised name without prefix and suffix that many names share, to compare two names."""
    return re.sub(r"^(gazebo_ros_|gazebo_|gz-sim-|gz::sim::systems::)|-system$|(_gazebo)?_plugin$", "", name) or name

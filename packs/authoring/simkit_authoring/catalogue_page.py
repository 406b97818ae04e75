"""Generator of the page `docs/catalogue.md`: every plugin of Gazebo, and whether simkit supports it.

`python -m simkit_authoring.catalogue_page > docs/catalogue.md` writes the page from the plugin classes. A test
fails if the page differs from the classes.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator

from simkit import Plugin
from simkit.plugins.discovery.find_plugin_class import GAZEBO_PLUGINS, UNSUPPORTED_REASONS
from simkit.plugins.plugin_names import normalise
from simkit_authoring.catalogue import Entry, known_plugins

_INTRODUCTION = """# Plugins of Gazebo: supported and unsupported

This page is generated from the plugin classes; do not edit it. A file may use any spelling of a plugin's name:
`lib….so`, `ignition-gazebo…`, a version number, a folder before the name. `simkit plugin info NAME` lists the
parameters of a plugin.

If a file uses an unsupported plugin, simkit reports it (`SK-PLUGIN-002`) with the reason below, and the world
runs without the plugin. For an unknown name, the warning (`SK-PLUGIN-001`) suggests the closest known name. You can
write a missing plugin [in Python](writing_a_plugin.md).
"""
_OTHERS = "not useful in simkit, or not requested yet"


def page() -> str:
    """Return the whole page as Markdown."""
    return "\n".join([_INTRODUCTION, *_supported_rows(), *_unsupported_rows()])


def _supported_rows() -> Iterator[str]:
    yield from ("## Supported plugins", "", "| plugin | on | |", "|---|---|---|")
    for entry in sorted(_own_entries(), key=lambda entry: _labels(entry.cls)):
        names = ", ".join(f"`{label}`" for label in _labels(entry.cls))
        yield f"| {names} | {', '.join(entry.parents)} | {entry.summary.replace('|', chr(92) + '|')} |"
    yield ""


def _own_entries() -> Iterable[Entry]:
    return [entry for entry in known_plugins() if entry.origin == "simkit"]


def _labels(cls: type[Plugin]) -> list[str]:
    """Return a name for each library of a class, or its gz class names if it has no library."""
    return list(dict.fromkeys(normalise(name) for name in (cls.filenames or cls.names)))


def _unsupported_rows() -> Iterator[str]:
    yield from ("## Unsupported plugins", "", "| plugin | reason |", "|---|---|")
    supported = {normalise(name) for entry in _own_entries() for name in (*entry.cls.filenames, *entry.cls.names)}
    reasons: dict[str, list[str]] = {}
    for name in sorted(GAZEBO_PLUGINS | {n for n in UNSUPPORTED_REASONS if "::" not in n}):
        if name not in supported:
            reasons.setdefault(UNSUPPORTED_REASONS.get(name, _OTHERS), []).append(name)
    for reason, names in sorted(reasons.items(), key=lambda item: item[1]):
        yield f"| {', '.join(f'`{name}`' for name in names)} | {reason} |"
    yield ""


if __name__ == "__main__":
    sys.stdout.write(page())

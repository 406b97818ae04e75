"""Page `docs/catalogue.md`: every plugin name of Gazebo and its support in simkit, generated from the classes.

`python -m simkit.plugins.authoring.catalogue_page > docs/catalogue.md` writes the page; a test compares it with the
classes.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator

from simkit.plugins import Plugin
from simkit.plugins.authoring.catalogue import Entry, known_plugins
from simkit.plugins.discovery.unsupported_plugins import GAZEBO_PLUGINS, UNSUPPORTED_REASONS
from simkit.plugins.plugin_names import normalise

_INTRODUCTION = """# Plugins of Gazebo: supported and unsupported

Generated from the classes of the plugins; do not edit. A file may use any spelling of a plugin's name: `lib….so`,
`ignition-gazebo…`, with a version number, with a folder in front. `simkit plugin info NAME` lists its parameters.

An unsupported plugin in a file is a warning (`SK-PLUGIN-002`) with the reason below, and the world runs without it. An
unknown name is a warning too (`SK-PLUGIN-001`), with the closest known name. A missing plugin can be
[written in Python](writing_a_plugin.md).
"""
_OTHERS = "it has no use in simkit, or has not been requested yet"


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

"""`docs/catalogue.md`: every plugin name of Gazebo, and what becomes of it, written from the classes themselves.

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

_INTRODUCTION = """# Plugins of Gazebo: which there are, which are left out

Written from the plugins' own classes; do not edit. A file's name for a plugin is taken in every spelling: `lib….so`,
`ignition-gazebo…`, with a version number, with a folder before it. `simkit plugin info NAME` tells what one reads.

A plugin that is left out is a warning (`SK-PLUGIN-002`) with the reason below when a file names it, and the world runs
without it; so is a name that nobody knows (`SK-PLUGIN-001`), with the closest one. What is missing can be
[written in Python](writing_a_plugin.md).
"""
_OTHERS = "it has no use here, or nobody has asked for it yet"


def page() -> str:
    """The whole page as Markdown."""
    return "\n".join([_INTRODUCTION, *_available_rows(), *_left_out_rows()])


def _available_rows() -> Iterator[str]:
    yield from ("## What there is", "", "| plugin | on | |", "|---|---|---|")
    for entry in sorted(_own_entries(), key=lambda entry: _labels(entry.cls)):
        names = ", ".join(f"`{label}`" for label in _labels(entry.cls))
        yield f"| {names} | {', '.join(entry.parents)} | {entry.summary.replace('|', chr(92) + '|')} |"
    yield ""


def _own_entries() -> Iterable[Entry]:
    return [entry for entry in known_plugins() if entry.origin == "simkit"]


def _labels(cls: type[Plugin]) -> list[str]:
    """A name for each of the libraries that a class stands for, and its gz classes' where it has no library."""
    return list(dict.fromkeys(normalise(name) for name in (cls.filenames or cls.names)))


def _left_out_rows() -> Iterator[str]:
    yield from ("## What is left out", "", "| plugin | reason |", "|---|---|")
    there = {normalise(name) for entry in _own_entries() for name in (*entry.cls.filenames, *entry.cls.names)}
    reasons: dict[str, list[str]] = {}
    for name in sorted(GAZEBO_PLUGINS | {n for n in UNSUPPORTED_REASONS if "::" not in n}):
        if name not in there:
            reasons.setdefault(UNSUPPORTED_REASONS.get(name, _OTHERS), []).append(name)
    for reason, names in sorted(reasons.items(), key=lambda item: item[1]):
        yield f"| {', '.join(f'`{name}`' for name in names)} | {reason} |"
    yield ""


if __name__ == "__main__":
    sys.stdout.write(page())

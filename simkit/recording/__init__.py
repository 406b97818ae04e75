"""Recording and playback of runs: bags, charts, pictures, exported tables and scripted commands.

Files are written completely or not at all. Recording never changes the measurements. This package does not depend on
sensor types, plugins or simkit's commands. The modules are imported on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.lazy_names import lazy_attributes

if TYPE_CHECKING:
    from simkit.recording.bags.bag_contents import matches_topic
    from simkit.recording.bags.reader import BagReader, open_bag_to_read
    from simkit.recording.bags.recorder import Recorder
    from simkit.recording.export import ExportOptions, export_bag

__all__ = ["BagReader", "ExportOptions", "Recorder", "export_bag", "matches_topic", "open_bag_to_read"]

_MODULES = {
    "simkit.recording.bags.bag_contents": ("matches_topic",),
    "simkit.recording.bags.reader": ("BagReader", "open_bag_to_read"),
    "simkit.recording.bags.recorder": ("Recorder",),
    "simkit.recording.export": ("ExportOptions", "export_bag"),
}

if not TYPE_CHECKING:  # hidden from type checkers, so that they report unknown names
    __getattr__, __dir__ = lazy_attributes(__name__, _MODULES)

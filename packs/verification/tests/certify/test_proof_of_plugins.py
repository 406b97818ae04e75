"""Every plugin of simkit gives the same bits after a restore and after a reset."""

from __future__ import annotations

import functools
from pathlib import Path

import proof
import proof_worlds
import pytest

from simkit.packs import is_shipped
from simkit.plugins import Plugin
from simkit.plugins.discovery.find_plugin_class import plugin_kinds
from simkit_verification.testing.certify.run_hashes import PluginCallRecorder, plugin_title

pytestmark = pytest.mark.slow  # slow: processes and complete runs

CLASSES = sorted({cls for cls in plugin_kinds().values() if is_shipped(cls)}, key=lambda c: c.__name__)


@functools.cache
def _names() -> list[str]:
    return [cls.__name__ for cls in CLASSES]


def test_every_plugin_has_a_test_world() -> None:
    named = [*proof_worlds.WORLDS, *proof_worlds.OPENED]
    assert sorted(named) == _names(), "give proof_worlds.py a world for each plugin class"


@pytest.mark.parametrize("cls", CLASSES, ids=_names())
def test_a_run_with_the_plugin_repeats_after_restore_and_reset(cls: type[Plugin], tmp_path: Path) -> None:
    with proof_worlds.open_world(cls.__name__, tmp_path) as sim:
        plugins = [p for p in sim.engine.structure.all_plugins() if type(p) is cls]
        assert plugins, f"no {cls.__name__} in its world: {[str(d) for d in sim.diagnostics if d.severity != 'note']}"
        at_first = proof.memory_of(sim)
        found, seen = proof.proven(sim)
        assert not found
        is_busy = has_done_something(sim, plugins[0], at_first, *seen)
    assert (cls.__name__ in proof_worlds.IDLE) != (is_busy or pushes_something(cls, tmp_path))


def has_done_something(sim, plugin: Plugin, at_first, before: proof.Seen, after: proof.Seen) -> bool:
    """Check whether a plugin changed attributes, published, used its parameters, or drives joints."""
    name = f"{plugin.scoped}::{plugin.name}"
    published = {topic for _, topic, _ in (*before.messages, *after.messages)}
    ends = {
        topic
        for topic, end, _, does in sim.communication.bus.endpoints()
        if does == "publishes" and end.owner is plugin
    }
    changed = at_first[name] != before.memory[name] or before.memory[name] != after.memory[name]
    adjustable = any(p.owner is plugin for found in sim.communication.parameters.values() for p in found.values())
    return changed or bool(ends & published) or adjustable or bool(sim.engine.structure.entry_of(plugin).actuators)


def pushes_something(cls: type[Plugin], folder: Path) -> bool:
    """Check whether a hook of a plugin changes forces, controls or the state."""
    with proof_worlds.open_world(cls.__name__, folder) as sim:
        recorder = PluginCallRecorder(sim)
        sim.step(20)
        names = {plugin_title(p) for p in sim.engine.structure.all_plugins() if type(p) is cls}
    return any(event.before != event.after for event in recorder.events if event.owner in names)

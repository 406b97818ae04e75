"""What every plugin is called for, what it changes, and what it remembers then; for finding who began to differ."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any
from zlib import crc32

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.run_spec import JsonObject
from simkit.runtime import Simulation
from simkit.runtime.engine import grouped_hooks
from simkit.runtime.engine.engine_state import EngineState
from simkit.runtime.engine.held_state import applied_forces
from simkit.runtime.engine.plugin_faults import PluginFaults
from simkit.testing.certify.outcome import PluginCall
from simkit.testing.certify.topic_hashes import plugin_title
from simkit.testing.certify.value_hash import short_value_text, value_hash


class PluginCallRecorder:
    """Notes every call of a plugin.

    Attributes:
        is_away: whether it looks the other way.
    """

    def __init__(self) -> None:
        self.events: list[PluginCall] = []
        self.is_away = False
        self._known: dict[int, dict[str, int]] = {}

    def call(
        self, engine: EngineState, plugin: object, hook: str, method: Callable[..., object], values: tuple[object, ...]
    ) -> Any:
        """Calls something of a plugin, and notes what it did."""
        if self.is_away or not hasattr(plugin, "has_hook"):
            return method(*values)
        before, tick = writable_state_hash(engine.physics.data), engine.tick
        try:
            return method(*values)
        finally:
            self._note(engine.physics.data, plugin, hook, tick, before)

    def loaded(self, sim: Simulation) -> None:
        """Notes what plugins remember once the world is open."""
        for plugin in sim.engine.structure.all_plugins():
            self._note(sim.mj_data, plugin, "load", 0, writable_state_hash(sim.mj_data))

    def again(self) -> None:
        """After a reset: nothing of before counts."""
        self.events.clear()
        self._known.clear()

    def _note(self, data: mujoco.MjData, plugin: object, hook: str, tick: int, before: int) -> None:
        state = plugin_attributes(plugin)
        now = {name: value_hash(value) for name, value in state.items()}
        known = self._known.get(id(plugin), {})
        self._known[id(plugin)] = now
        changed = {name: value for name, value in now.items() if known.get(name) != value}
        changed.update({name: 0 for name in known if name not in now})
        said = {name: short_value_text(state[name]) for name in changed if name in state}
        self.events.append(
            PluginCall(tick, plugin_title(plugin), hook, before, writable_state_hash(data), changed, said)
        )


@contextmanager
def record_plugin_calls(witness: PluginCallRecorder) -> Iterator[None]:
    """Has every call of a plugin go by a witness; for simulations that are opened within."""

    task, guard, least = PluginFaults.task, PluginFaults.guard, grouped_hooks.MIN_GROUP_SIZE

    def watched_task(self: Any, plugin: Any, hook: str) -> Callable[[int], None]:
        inner = task(self, plugin, hook)

        def call(tick: int = 0) -> None:
            witness.call(self._engine, plugin, hook, inner, (tick,))

        return call

    def watched_guard(self: Any, plugin: Any, hook: str, method: Callable[..., Any]) -> Callable[..., Any]:
        return guard(self, plugin, hook, lambda *values: witness.call(self._engine, plugin, hook, method, values))

    PluginFaults.task, PluginFaults.guard, grouped_hooks.MIN_GROUP_SIZE = watched_task, watched_guard, 1 << 30  # type: ignore
    try:
        yield
    finally:
        PluginFaults.task, PluginFaults.guard, grouped_hooks.MIN_GROUP_SIZE = task, guard, least  # type: ignore


def plugin_attributes(plugin: Any) -> JsonObject:
    """A plugin's attributes, as a snapshot keeps them."""
    try:
        state = plugin.get_state()
    except Exception:  # noqa: BLE001 - a plugin may raise anything
        return {}
    if not isinstance(state, Mapping):
        return {"state": state}
    inner = state.get("variables")  # of a system of gz
    return dict(inner if isinstance(inner, Mapping) else state)


def writable_state_hash(data: mujoco.MjData) -> int:
    """Return a hash of what plugins can write to: the state, controls and forces."""
    found = 0
    for field in (data.qpos, data.qvel, data.act, data.ctrl, data.qfrc_applied, data.xfrc_applied, data.mocap_pos):
        found = crc32(field.tobytes(), found)
    return crc32(data.mocap_quat.tobytes(), found)


class TickHashes:
    """A short hash of the physics, and of what was put in, for every tick.

    Attributes:
        is_away: whether it looks the other way.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim, self.is_away = sim, False
        self.state: dict[int, int] = {}
        self.inputs: dict[int, int] = {}
        self._told = object()
        sim.communication.on_demand.add(lambda: True, None, self._mark, "after")

    def rows(self, ticks: int) -> tuple[npt.NDArray[np.uint64], npt.NDArray[np.uint64]]:
        """Both as arrays of so many ticks."""
        wanted = range(1, ticks + 1)
        state, inputs = ([of.get(tick, 0) for tick in wanted] for of in (self.state, self.inputs))
        return np.array(state, np.uint64), np.array(inputs, np.uint64)

    def _mark(self, _: int) -> None:
        if self.is_away:
            return
        physics = self._sim.engine.physics
        data, tick = physics.data, physics.tick
        self.state[tick] = _two_hashes(data.qpos, data.qvel, data.act)
        applied, pushed = applied_forces(physics)
        self.inputs[tick] = _two_hashes(data.ctrl, applied, pushed, data.mocap_pos)


def _two_hashes(*fields: npt.NDArray[np.float64]) -> int:
    first = second = 0
    for field in fields:
        content = field.tobytes()
        first, second = crc32(content, first), crc32(content, second ^ 0x5BD1E995)
    return first | second << 32

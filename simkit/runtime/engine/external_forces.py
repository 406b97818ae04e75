"""Wrenches that persist on links from step to step, and the velocity of the air."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from simkit.in_process import InProcess
from simkit.scene import SceneWorld

if TYPE_CHECKING:
    from simkit.runtime.engine.engine_state import EngineState
    from simkit.runtime.engine.plugin_faults import PluginFaults


class PersistentWrenches:
    """Wrenches on links that persist until they are replaced.

    A wrench is a force [N] and a torque [N·m] in the world frame at the centre of mass.

    Args:
        engine: engine of the links.
        faults: source of the enabled plugins; disabled plugins apply no wrench.
    """

    def __init__(self, engine: EngineState, faults: PluginFaults) -> None:
        self._engine, self._faults = engine, faults
        self._by_owner: dict[int, tuple[object, dict[str, npt.ArrayLike]]] = {}

    def set(self, owner: object, wrenches: Mapping[str, npt.ArrayLike], *, are_applied: bool = False) -> None:
        """Replace all wrenches of a plugin; wrenches of other enabled plugins persist.

        Args:
            owner: plugin that sets the wrenches.
            wrenches: wrenches by scoped link name. A wrench on a missing link is applied once the link exists.
            are_applied: True if the engine state already contains the wrenches (a restored state).
        """
        self._by_owner[id(owner)] = owner, dict(wrenches)
        if not are_applied:  # during a restore, the wrenches of other plugins are not yet restored
            self.push(are_applied=False)

    def push(self, *, are_applied: bool = False) -> None:
        """Pass the sums of the wrenches to the physics, for the present links and enabled plugins.

        The wrenches of a removed plugin are dropped. If a restore brings the plugin back, its state sets them again.
        """
        if not self._by_owner:
            self._engine.physics.set_persistent_wrenches({}, are_applied=are_applied)
            return
        living = set(map(id, self._faults.living(self._engine.structure)))
        self._by_owner = {key: owned for key, owned in self._by_owner.items() if key in living}
        links = self._engine.names.links
        total: dict[int, npt.NDArray[np.float64]] = {}
        for _, wrenches in self._by_owner.values():
            for name, wrench in wrenches.items():
                if name in links and links[name].body > 0:
                    total[links[name].body] = total.get(links[name].body, 0.0) + np.asarray(wrench, float)
        self._engine.physics.set_persistent_wrenches(total, are_applied=are_applied)


Velocity = tuple[float, float, float]


class Wind(InProcess):
    """Velocity of the air: the world's `<wind>`, or the wind of a plugin. A handle.

    Attributes:
        source: function that returns the velocity [m/s, world frame] during the step that follows a tick. None uses the
            world's wind.
    """

    def __init__(self, world: SceneWorld) -> None:
        x, y, z = world.wind
        self._steady: Velocity = float(x), float(y), float(z)
        self.source: Callable[[int], Velocity] | None = None

    def at(self, tick: int) -> Velocity:
        """Return the velocity of the air [m/s, world frame] during the step that follows a tick."""
        return self._steady if self.source is None else self.source(tick)

"""Wrenches that persist on links from step to step, and the velocity of the air."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from simkit.scene import SceneWorld

if TYPE_CHECKING:
    from simkit.runtime.engine.engine_state import EngineState
    from simkit.runtime.engine.plugin_faults import PluginFaults


class PersistentWrenches:
    """Wrenches on links that hold until they are set anew: force [N], torque [N·m], world frame, at the centre of mass.

    Args:
        engine: whose links are pushed.
        faults: tells which plugins are at work; those of others push nothing.
    """

    def __init__(self, engine: EngineState, faults: PluginFaults) -> None:
        self._engine, self._faults = engine, faults
        self._by_owner: dict[int, tuple[object, dict[str, npt.ArrayLike]]] = {}

    def set(self, owner: object, wrenches: Mapping[str, npt.ArrayLike], *, are_applied: bool = False) -> None:
        """Sets all wrenches of a plugin; what other plugins set holds too, and nothing of a plugin that is gone.

        Args:
            owner: the plugin that sets them.
            wrenches: by scoped link name; a link that is not there is waited for.
            are_applied: the state has them already (it was restored).
        """
        self._by_owner[id(owner)] = owner, dict(wrenches)
        if not are_applied:  # while a state is restored, what others push is still that of before
            self.push(are_applied=False)

    def push(self, *, are_applied: bool = False) -> None:
        """Hands the sums to the physics, for the links and plugins that are there now.

        A plugin that went is forgotten: should a restore bring it back, its state brings what it pushes.
        """
        living = set(map(id, self._faults.living(self._engine.structure)))
        self._by_owner = {key: found for key, found in self._by_owner.items() if key in living}
        links = self._engine.names.links
        total: dict[int, npt.NDArray[np.float64]] = {}
        for _, wrenches in self._by_owner.values():
            for name, wrench in wrenches.items():
                if name in links and links[name].body > 0:
                    total[links[name].body] = total.get(links[name].body, 0.0) + np.asarray(wrench, float)
        self._engine.physics.set_persistent_wrenches(total, are_applied=are_applied)


Velocity = tuple[float, float, float]


class Wind:
    """The velocity of the air: the world's `<wind>`, or what a plugin makes of it. A handle.

    Attributes:
        source: gives the velocity [m/s], world frame, that holds in the step from a tick on; None: the world's.
    """

    def __init__(self, world: SceneWorld) -> None:
        x, y, z = world.wind
        self._steady: Velocity = float(x), float(y), float(z)
        self.source: Callable[[int], Velocity] | None = None

    def at(self, tick: int) -> Velocity:
        """Velocity of the air [m/s], world frame, in the step that follows a tick."""
        return self._steady if self.source is None else self.source(tick)

    def __deepcopy__(self, memo: dict[int, object]) -> Wind:
        return self

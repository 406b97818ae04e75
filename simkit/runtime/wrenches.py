"""Wrenches that hold from step to step until whoever set them sets others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation


class StandingWrenches:
    """Who pushes which links how; force [N] and torque [N·m], world frame, at the centre of mass."""

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._by_owner: dict[int, tuple[Any, dict[str, Any]]] = {}

    def set(self, owner: Any, wrenches: Mapping[str, Any], *, are_applied: bool) -> None:
        """All that the plugin `owner` pushes from now on, by scoped link name."""
        self._by_owner[id(owner)] = owner, dict(wrenches)
        if not are_applied:  # while a state is restored, what others push is still that of before
            self.push(are_applied=False)

    def push(self, *, are_applied: bool) -> None:
        """Hands the sums to the physics, for the links and plugins that are there now.

        A plugin that went is forgotten: should a restore bring it back, its state brings what it pushes.
        """
        living = set(map(id, self._sim.faults.living(self._sim.structure)))
        self._by_owner = {key: found for key, found in self._by_owner.items() if key in living}
        links = self._sim.names.links
        total: dict[int, Any] = {}
        for _, wrenches in self._by_owner.values():
            for name, wrench in wrenches.items():
                if name in links and links[name].body > 0:
                    total[links[name].body] = total.get(links[name].body, 0.0) + np.asarray(wrench, float)
        self._sim.physics.stand(total, are_applied=are_applied)

"""Base class of the buoyancy plugins of Gazebo and Gazebo Classic."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from simkit import Plugin
from simkit.extend import NEVER
from simkit_water_and_air.plugins.fluids.buoyant_force import BuoyantForces, Fluid, Immersion
from simkit_water_and_air.plugins.fluids.collision_volumes import Hull, HullFactory
from simkit_water_and_air.plugins.fluids.link_forces import moving_data

if TYPE_CHECKING:
    import mujoco


class BuoyancyBase(Plugin):
    """Pushes links up by the weight of the fluid that they displace.

    A link is steady if its centre of volume is at its centre of mass and the whole link is within one layer. The force
    on a steady link is constant, so it is set once instead of being computed at each step.
    """

    reads_at_load = ("inertial", "geometry")  # the volumes are computed once

    _fluid: Fluid
    _found: BuoyantForces | None = None  # plugins that are loaded before this one already ask for the rate

    @abstractmethod
    def find_hulls(self) -> Mapping[str, Sequence[Hull]]:
        """Return the hulls of each floating link in the current world, by scoped name of the link."""

    def start(self) -> None:
        """Set up the forces; a subclass calls this method at the end of `load`."""
        self._factory = HullFactory(self._report_open_mesh)
        self._found = None
        self._steady_state: tuple[object, ...] | None = None
        self._steady_wrenches: dict[str, tuple[float, ...]] = {}
        self._bind()
        if not self._fluid.heights:
            self._set_steady_wrenches(moving_data(self.sim))

    @property
    def before_step_rate(self) -> float | None:
        """`NEVER` while all forces are constant, otherwise None (every step).

        The value is computed again after a spawn, a removal or a change of gravity.
        """
        floating = self._found
        is_idle = (
            floating is not None
            and floating.links.is_current
            and (not len(floating.links) or floating.is_all_steady)
            and self._steady_state is not None
            and self._steady_state[-1] == self._gravity
        )
        return NEVER if is_idle else None

    @before_step_rate.setter
    def before_step_rate(self, rate: float | None) -> None:
        raise AttributeError("before_step_rate of a buoyancy plugin is read-only: it follows the floating links")

    @property
    def _gravity(self) -> tuple[float, ...]:
        return tuple(self.sim.mj_model.opt.gravity.tolist())

    def before_step(self) -> None:
        """Apply the buoyant forces for the next step."""
        if self._found is None or not self._found.links.is_current:
            self._bind()
        floating = self._found
        if floating is None:
            return
        data = moving_data(self.sim)
        immersion = self._set_steady_wrenches(data)
        if not all(immersion.steady):
            floating.push(data, immersion, self.sim.mj_model.opt.gravity)
        if self.before_step_rate is not None:
            self.sim.engine.reschedule()

    def _bind(self) -> None:
        self._found, self._steady_state = BuoyantForces(self.sim, self.find_hulls(), self._fluid), None

    def _set_steady_wrenches(self, data: mujoco.MjData) -> Immersion:
        """Set the forces on the steady links if they have changed, and return the current immersion."""
        floating = self._found
        assert floating is not None
        immersion, gravity = floating.find_immersion(data), self._gravity
        now = (immersion.steady, immersion.masses, gravity)
        if now != self._steady_state:
            self._steady_state = now
            self._steady_wrenches = {
                name: (*(-mass * g for g in gravity), 0.0, 0.0, 0.0)
                for name, is_steady, mass in zip(floating.links.names, immersion.steady, immersion.masses, strict=True)
                if is_steady and mass
            }
            self.sim.engine.wrenches.set(self, self._steady_wrenches)
        return immersion

    def set_state(self, state: Mapping[str, object]) -> None:
        """Restore a state from `get_state`."""
        super().set_state(state)
        self.sim.engine.wrenches.set(self, self._steady_wrenches, are_applied=True)

    def _report_open_mesh(self, collision: str) -> None:
        message = f"the mesh of {collision!r} is open and has no volume; its convex hull is used instead"
        self._once.warn("SK-PLUGIN-112", collision, message, "close the mesh, or use a primitive shape, such as <box>")

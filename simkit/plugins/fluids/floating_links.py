"""Base class of the buoyancy plugins of Gazebo and Gazebo Classic."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from simkit.plugins.base import NEVER, Plugin
from simkit.plugins.fluids.buoyant_force import BuoyantForces, Fluid, Immersion
from simkit.plugins.fluids.collision_volumes import Hull, HullFactory
from simkit.plugins.fluids.link_forces import moving_data
from simkit.plugins.one_time_warnings import OneTimeWarnings

if TYPE_CHECKING:
    import mujoco


class BuoyancyBase(Plugin):
    """Pushes links by the weight of the fluid that they displace.

    A link is steady if its centre of volume is its centre of mass and it is within one layer. Its force is constant, so
    it is set once and no step has to compute it.
    """

    _fluid: Fluid

    @abstractmethod
    def find_hulls(self) -> Mapping[str, Sequence[Hull]]:
        """Return the hulls of the floating links in the current world, by scoped link name."""

    def start(self) -> None:
        """Set up the forces; call it at the end of `load`."""
        self.once = OneTimeWarnings(self)
        self._factory = HullFactory(self._report_open_mesh)
        self._found: BuoyantForces | None = None
        self._steady_state: tuple[object, ...] | None = None
        self._steady_wrenches: dict[str, tuple[float, ...]] = {}
        self._bind()
        if not self._fluid.heights:
            self._set_steady_wrenches(moving_data(self.sim))

    @property
    def before_step_rate(self) -> float | None:
        """Never while all forces are constant; evaluated again after a spawn, a removal or a change of gravity."""
        found = self._found
        is_idle = (
            found is not None
            and found.links.is_current
            and (not len(found.links) or found.is_all_steady)
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
        """Push the floating links for the next step."""
        if self._found is None or not self._found.links.is_current:
            self._bind()
        found = self._found
        if found is None:
            return
        data = moving_data(self.sim)
        lie = self._set_steady_wrenches(data)
        if not all(lie.steady):
            found.push(data, lie, self.sim.mj_model.opt.gravity)
        if self.before_step_rate is not None:
            self.sim.engine.reschedule()

    def _bind(self) -> None:
        self._found, self._steady_state = BuoyantForces(self.sim, self.find_hulls(), self._fluid), None

    def _set_steady_wrenches(self, data: mujoco.MjData) -> Immersion:
        """Set the constant forces if they have changed, and return the current immersion."""
        found = self._found
        assert found is not None
        lie, gravity = found.lie(data), self._gravity
        now = (lie.steady, lie.masses, gravity)
        if now != self._steady_state:
            self._steady_state = now
            self._steady_wrenches = {
                name: (*(-mass * g for g in gravity), 0.0, 0.0, 0.0)
                for name, is_steady, mass in zip(found.links.names, lie.steady, lie.masses, strict=True)
                if is_steady and mass
            }
            self.sim.engine.wrenches.set(self, self._steady_wrenches)
        return lie

    def set_state(self, state: Mapping[str, object]) -> None:
        """Restore a state from `get_state`."""
        super().set_state(state)
        self.sim.engine.wrenches.set(self, self._steady_wrenches, are_applied=True)

    def _report_open_mesh(self, collision: str) -> None:
        message = f"the mesh of {collision!r} is open and has no volume; its convex hull is used instead"
        self.once.warn("SK-PLUGIN-112", collision, message, "close the mesh, or use a primitive shape, such as <box>")

"""Base of the buoyancy plugins of gz and of Gazebo Classic."""

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

    A link whose centre of volume is its centre of mass, wholly in one layer, is pushed by a force that stands: nothing
    is done at a step.
    """

    _fluid: Fluid

    @abstractmethod
    def find_hulls(self) -> Mapping[str, Sequence[Hull]]:
        """What floats of the present world, by scoped link name."""

    def start(self) -> None:
        """To be called at the end of `load`."""
        self.once = OneTimeWarnings(self)
        self._yard = HullFactory(self._tell_open)
        self._found: BuoyantForces | None = None
        self._stood: tuple[object, ...] | None = None
        self._standing: dict[str, tuple[float, ...]] = {}
        self._bind()
        if not self._fluid.heights:
            self._stand(moving_data(self.sim))

    @property
    def before_step_rate(self) -> float | None:
        """Never while every force stands; after a spawn, a removal or another gravity that is looked at anew."""
        found = self._found
        is_idle = (
            found is not None
            and found.links.is_current
            and (not len(found.links) or found.is_all_steady)
            and self._stood is not None
            and self._stood[-1] == self._gravity
        )
        return NEVER if is_idle else None

    @before_step_rate.setter
    def before_step_rate(self, rate: float | None) -> None:
        raise AttributeError("a fluid is called as long as what floats moves in it")

    @property
    def _gravity(self) -> tuple[float, ...]:
        return tuple(self.sim.mj_model.opt.gravity.tolist())

    def before_step(self) -> None:
        """Pushes for the step to come."""
        if self._found is None or not self._found.links.is_current:
            self._bind()
        found = self._found
        if found is None:
            return
        data = moving_data(self.sim)
        lie = self._stand(data)
        if not all(lie.steady):
            found.push(data, lie, self.sim.mj_model.opt.gravity)
        if self.before_step_rate is not None:
            self.sim.engine.reschedule()

    def _bind(self) -> None:
        self._found, self._stood = BuoyantForces(self.sim, self.find_hulls(), self._fluid), None

    def _stand(self, data: mujoco.MjData) -> Immersion:
        """Sets the forces that stand where they are others than before."""
        found = self._found
        assert found is not None
        lie, gravity = found.lie(data), self._gravity
        now = (lie.steady, lie.masses, gravity)
        if now != self._stood:
            self._stood = now
            self._standing = {
                name: (*(-mass * g for g in gravity), 0.0, 0.0, 0.0)
                for name, is_steady, mass in zip(found.links.names, lie.steady, lie.masses, strict=True)
                if is_steady and mass
            }
            self.sim.engine.wrenches.set(self, self._standing)
        return lie

    def set_state(self, state: Mapping[str, object]) -> None:
        """Back to a state from `get_state`."""
        super().set_state(state)
        self.sim.engine.wrenches.set(self, self._standing, are_applied=True)

    def _tell_open(self, collision: str) -> None:
        message = f"the mesh of {collision!r} is open and encloses nothing; its convex hull floats instead"
        self.once.warn("SK-PLUGIN-112", collision, message, "close the mesh, or give the collision a plain shape")

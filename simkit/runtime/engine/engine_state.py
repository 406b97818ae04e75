"""MuJoCo's model and data of a simulation, the structure that they were compiled from, and changes of the model."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from simkit.errors import InputError
from simkit.runtime.contact.speculative_contacts import FastBodyWarnings
from simkit.runtime.engine.entity_structure import bodies_kept_awake
from simkit.runtime.engine.physics_step import Physics

if TYPE_CHECKING:
    import logging

    import mujoco
    import numpy as np
    import numpy.typing as npt

    from simkit.compiler import Compiled
    from simkit.compiler.name_map import NameMap
    from simkit.diagnostics import Diagnostics
    from simkit.runtime.engine.entity_structure import WorldStructure
    from simkit.runtime.engine.scheduler import Scheduler
    from simkit.runtime.engine.simulated_time import Clock
    from simkit.scene import SceneWorld


@dataclass(frozen=True, slots=True, kw_only=True)
class EngineCallbacks:
    """Functions of the parts of a simulation that are created after its engine.

    Attributes:
        fill: function that adds every task to the scheduler, in document order.
        schedule_inputs: function that returns what `fill` reads and a restored state may change; None if the tasks
            have states of their own.
        velocity_limit: function that returns the limit of a joint's axis [rad/s or m/s] by scoped name and axis number.
        set_active: function that enables the interfaces of these plugins and sensors, and disables all others.
        abandon: function that aborts the requests and goals that a plugin is processing, for a reason.
        large_commands: function that describes the last large commands.
    """

    fill: Callable[[Scheduler], None]
    schedule_inputs: Callable[[], object]
    velocity_limit: Callable[[str, int], float]
    set_active: Callable[[Sequence[object]], None]
    abandon: Callable[[object, str], None]
    large_commands: Callable[[], list[str]]


class EngineState:
    """Engine state that the other parts of a simulation read and write.

    Args:
        world: scene of the world.
        structure: compiled structure of the world.
        clock: simulated time.
        reports: collection of the diagnostics of the run.
        log: logger of the simulation.
        callbacks: functions of the other parts.

    Attributes:
        world: scene, with the changes made during the run.
        structure: present structure of the world; it is replaced, never changed.
        clock: conversion of ticks to time.
        physics: MuJoCo's model and data, and the functions that advance them.
        originals: compiled values of the model fields that were written to.
        reports: collection of the diagnostics of the run.
        log: logger of the simulation.
        callbacks: functions of the other parts.
        fast_body_warnings: warnings about bodies that are too fast for the time step.
        is_closed: True after the simulation has been closed.
    """

    def __init__(
        self,
        world: SceneWorld,
        structure: WorldStructure,
        clock: Clock,
        reports: Diagnostics,
        log: logging.Logger,
        callbacks: EngineCallbacks,
    ) -> None:
        self.world, self.structure, self.clock, self.reports = world, structure, clock, reports
        self.log, self.callbacks = log, callbacks
        self.fast_body_warnings = FastBodyWarnings(reports, clock.timestep, lambda: self.names)
        compiled = structure.compiled
        self.physics = Physics(
            compiled.model, compiled.data, clock, world.physics.sleep, on_approach=self.fast_body_warnings
        )
        self.originals: dict[str, npt.NDArray[np.float64]] = {}
        self.is_closed = False

    def close(self) -> None:
        """Refuse further calls."""
        self.is_closed = True

    def check_open(self) -> None:
        """Raise InputError after the simulation has been closed."""
        if self.is_closed:
            raise InputError("SK-CORE-002", "the simulation is closed", shows_code=False)

    # ------------------------------------------------------------------ time

    @property
    def tick(self) -> int:
        """Number of steps from t = 0 to the present state."""
        return self.physics.tick

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.clock.time(self.physics.tick)

    @property
    def time_ns(self) -> int:
        """Simulated time [ns]."""
        return self.clock.time_ns(self.physics.tick)

    # ------------------------------------------------------------------ MuJoCo's objects

    @property
    def mj_model(self) -> mujoco.MjModel:
        """MuJoCo's model; a new object after a spawn or a removal."""
        return self.physics.model

    @property
    def mj_data(self) -> mujoco.MjData:
        """MuJoCo's data; a new object after a spawn or a removal."""
        return self.physics.data

    @property
    def compiled(self) -> Compiled:
        """The compiled model of the present structure."""
        return self.structure.compiled

    @property
    def names(self) -> NameMap:
        """The compiler's name map of the present model."""
        return self.structure.compiled.names

    # ------------------------------------------------------------------ changes of the world

    def change_world(self, world: SceneWorld) -> None:
        """Replace the scene."""
        self.world = world

    def adopt_structure(self, structure: WorldStructure) -> None:
        """Switch to a structure with another compiled model."""
        if self.structure is not structure:  # the first structure is bound already, which takes 8 ms for 64 bodies
            self.structure = structure
            self.physics.rebind(structure.compiled.model, structure.compiled.data)
        self.physics.sleep.restrict(bodies_kept_awake(structure))
        if any(nested.mjcf for model in structure.models.values() for nested in model.all_models()):
            self.physics.check_controls()

    def adopt_numbers(self, structure: WorldStructure) -> None:
        """Switch to a structure with the same compiled model, whose numbers have changed."""
        self.structure = structure
        self.physics.changed_model()

    # ------------------------------------------------------------------ changes of the model

    def touch(self, field: str) -> npt.NDArray[np.float64]:
        """Return a model field for writing; snapshots and restores include it from now on."""
        values: npt.NDArray[np.float64] = getattr(self.physics.model, field)
        if not field.startswith("light_"):
            for sensor in self.structure.all_sensors():
                sensor.take_held()
            self.physics.changed_model()
        if field not in self.originals:
            self.originals[field] = values.copy()
        return values

    def original(self, field: str) -> npt.NDArray[np.float64]:
        """Return the compiled values of a model field that was written to."""
        return self.originals[field]

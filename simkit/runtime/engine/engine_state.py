"""MuJoCo's objects of a simulation, the structure that they were compiled from, and changes of the model."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

from simkit.errors import InputError
from simkit.runtime.engine.physics_step import Physics

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    import numpy.typing as npt

    from simkit.compiler import Compiled
    from simkit.compiler.name_map import NameMap
    from simkit.diagnostics import Diagnostics
    from simkit.runtime.engine.entity_structure import WorldStructure
    from simkit.runtime.engine.simulated_time import Clock
    from simkit.scene import SceneWorld


class EngineState:
    """State of the engine that everything else in a simulation reads and writes.

    Args:
        world: the scene.
        structure: what is compiled of it.
        clock: simulated time.
        reports: collects what is found while the simulation runs.

    Attributes:
        world: the scene, with what was changed of it since.
        structure: what is in the world now; never changed, only replaced.
        clock: converts ticks to time.
        physics: MuJoCo's model and data, and how they advance.
        originals: model fields that were written to, as compiled.
        reports: collects what is found while the simulation runs.
        log: logger of the simulation.
        is_closed: whether the simulation has been closed.
    """

    def __init__(self, world: SceneWorld, structure: WorldStructure, clock: Clock, reports: Diagnostics) -> None:
        self.world, self.structure, self.clock, self.reports = world, structure, clock, reports
        self.log = logging.getLogger("simkit")
        compiled = structure.compiled
        self.physics = Physics(compiled.model, compiled.data, clock, world.physics.sleep)
        self.originals: dict[str, npt.NDArray[np.float64]] = {}
        self.is_closed = False

    def check_open(self) -> None:
        """Raises InputError after the simulation has been closed."""
        if self.is_closed:
            raise InputError("the simulation is closed", "SK-CORE-002")

    # ------------------------------------------------------------------ time

    @property
    def tick(self) -> int:
        """Steps done."""
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

    # ------------------------------------------------------------------ changes of the model

    def touch(self, field: str) -> npt.NDArray[np.float64]:
        """Returns a model field to be written to; snapshots and restores cover it from now on."""
        values: npt.NDArray[np.float64] = getattr(self.physics.model, field)
        if not field.startswith("light_"):
            for sensor in self.structure.all_sensors():
                sensor.take_held()
            self.physics.changed_model()
        if field not in self.originals:
            self.originals[field] = values.copy()
        return values

    def original(self, field: str) -> npt.NDArray[np.float64]:
        """Returns a touched field's values as compiled."""
        return self.originals[field]

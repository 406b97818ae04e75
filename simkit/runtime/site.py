"""Where on its planet the world lies, which may be changed while a run goes on."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation
    from simkit.scene import SphericalCoordinates


class Site:
    """The place of the world's origin; sensors that depend on it (`navsat`, `magnetometer`) are told."""

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim

    @property
    def place(self) -> SphericalCoordinates | None:
        """The world's `<spherical_coordinates>`; None where there are none."""
        return self._sim.world.spherical_coordinates

    def move(self, place: SphericalCoordinates | None) -> None:
        """Puts the world's origin somewhere else."""
        sim = self._sim
        sensors = [s for s in sim.structure.all_sensors() if hasattr(s, "relocate")]
        for sensor in sensors:
            sensor.take_held()
        sim.world = replace(sim.world, spherical_coordinates=place)
        for sensor in sensors:
            sensor.relocate()

    def get_state(self) -> SphericalCoordinates | None:
        return self.place

    def set_state(self, state: SphericalCoordinates | None) -> None:
        if state is not self.place:
            self.move(state)

"""Particles in the air of a world, such as smoke, which plugins emit and which images and sensors show."""

from __future__ import annotations

import abc
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit.pose import Vector
    from simkit.runtime.simulation import Simulation

_SPREAD_SHARE = 0.25  # of the extent of a cloud; see `ParticleCloud.spread`


@dataclass(frozen=True, slots=True, eq=False)
class ParticleCloud:
    """Particles at one instant.

    Attributes:
        positions: positions in the world [m], shape (n, 3).
        radii: radii [m], shape (n,).
        colours: red, green, blue and opacity, shape (n, 4).
        scatter_ratio: share of rays through a particle that have an echo.
    """

    positions: Vector
    radii: Vector
    colours: Vector
    scatter_ratio: float

    @property
    def spread(self) -> float:
        """Standard deviation of the way into the cloud to an echo [m], a quarter of its extent along the world's x.

        Source: gz-rendering, Ogre2ParticleNoiseListener.cc.
        """
        x = self.positions[:, 0]
        return float((x + self.radii).max() - (x - self.radii).min()) * _SPREAD_SHARE


class ParticleSource(abc.ABC):
    """Base class of plugins that have particles."""

    @abc.abstractmethod
    def cloud_at(self, time: float) -> ParticleCloud | None:
        """Return the particles at a time [s] up to now, at least of the last seconds; None without any."""


def find_clouds(sim: Simulation, time: float) -> list[ParticleCloud]:
    """Return the clouds of all sources at a time [s]; empty clouds are left out."""
    clouds = (source.cloud_at(time) for source in _sources(sim))
    return [cloud for cloud in clouds if cloud is not None]


def has_sources(sim: Simulation) -> bool:
    """Check whether the world may have particles."""
    return bool(_sources(sim))


def _sources(sim: Simulation) -> tuple[ParticleSource, ...]:
    structure = sim.engine.structure

    def find() -> tuple[ParticleSource, ...]:
        return tuple(plugin for plugin in structure.all_plugins() if isinstance(plugin, ParticleSource))

    sources: tuple[ParticleSource, ...] = sim.engine.names.shared("sources of particles", find)
    return sources

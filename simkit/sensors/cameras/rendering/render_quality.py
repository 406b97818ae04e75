"""Quality of the pictures of a world, and its surroundings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from simkit.scene import SceneWorld, Surroundings


@dataclass(frozen=True, slots=True)
class Quality:
    """What is spent on a picture.

    Attributes:
        samples: of each pixel, which smooth edges; 0 takes one. A driver has a highest number of its own.
        shadow_map: width of the picture that a light has of what it falls on [px]; 0 draws no shadows.
        slices: sides of what is round.
    """

    name: str
    samples: int
    shadow_map: int
    slices: int

    def missing_features(self) -> str:
        """In words: what Gazebo would draw."""
        parts = [word for word, there in (("shadows", self.shadow_map), ("smooth edges", self.samples)) if not there]
        return " and ".join(parts)


QUALITIES: Final[Mapping[str, Quality]] = {
    "fast": Quality("fast", 0, 0, 28),
    "gazebo": Quality("gazebo", 4, 2048, 32),
    "high": Quality("high", 8, 4096, 64),
}


@dataclass(frozen=True, slots=True)
class Appearance:
    """The look of one world."""

    surroundings: Surroundings
    quality: Quality

    @classmethod
    def of(cls, world: SceneWorld) -> Appearance:
        """What the file says."""
        return cls(world.surroundings, QUALITIES[world.quality])

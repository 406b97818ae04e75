"""Appearance of images: the surroundings of a world, and the quality."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from simkit.scene import SceneWorld, Surroundings


@dataclass(frozen=True, slots=True)
class Quality:
    """Quality settings of images.

    Attributes:
        samples: samples per pixel, for smooth edges; 0 means one sample. A driver may use fewer samples.
        shadow_map: width of a light's shadow map [px]; 0 draws no shadows.
        slices: number of sides of round shapes in OpenGL. With 64, the middle of a side is 0.12 % of the radius inside
            the circle. The software renderer has exact surfaces.
    """

    name: str
    samples: int
    shadow_map: int
    slices: int

    def missing_features(self) -> str:
        """Return the features that Gazebo draws and this quality does not, as a text."""
        parts = [word for word, there in (("shadows", self.shadow_map), ("smooth edges", self.samples)) if not there]
        return " and ".join(parts)

    def log_use(self, renderer: str) -> None:
        """Log the name of the renderer and the features that images of this quality lack."""
        missing = self.missing_features()
        text = f"without {missing}" if missing else "with shadows and smooth edges"
        logging.getLogger("simkit").info("renderer: %s; quality %s, %s", renderer, self.name, text)


QUALITIES: Final[Mapping[str, Quality]] = {
    "fast": Quality("fast", 0, 0, 64),
    "gazebo": Quality("gazebo", 4, 2048, 64),
    "high": Quality("high", 8, 4096, 128),
}


@dataclass(frozen=True, slots=True)
class Appearance:
    """Visual appearance of one world."""

    surroundings: Surroundings
    quality: Quality

    @classmethod
    def of(cls, world: SceneWorld) -> Appearance:
        """Return the appearance that the file of a world defines."""
        return cls(world.surroundings, QUALITIES[world.quality])

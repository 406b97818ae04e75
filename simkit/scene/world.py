"""Worlds: models, lights, physics settings and surroundings."""

from __future__ import annotations

from dataclasses import dataclass

from simkit.diagnostics import NOWHERE, Where
from simkit.scene.geometry import Vec3
from simkit.scene.model import Colour, SceneFrame, SceneJoint, SceneLight, SceneModel, ScenePlugin


@dataclass(frozen=True, slots=True)
class Physics:
    """Step [s] and the wanted real-time factor (0: as fast as it goes)."""

    max_step_size: float = 0.001
    real_time_factor: float = 1.0
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class SphericalCoordinates:
    """Where on Earth the world's origin lies; angles rad, elevation m."""

    latitude: float = 0.0
    longitude: float = 0.0
    elevation: float = 0.0
    heading: float = 0.0
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class Surroundings:
    """`<scene>`: colours RGBA from 0 to 1."""

    ambient: Colour = (0.4, 0.4, 0.4, 1.0)
    background: Colour = (0.7, 0.7, 0.7, 1.0)
    shadows: bool = True
    grid: bool = True
    sky: bool = False


@dataclass(frozen=True, slots=True)
class SceneWorld:
    """One world.

    Attributes:
        gravity: [m/s²] in the world frame.
        magnetic_field: [T] in the world frame.
        quality: renderer quality asked for: fast, gazebo or high.
    """

    name: str = "default"
    gravity: Vec3 = (0.0, 0.0, -9.8)
    magnetic_field: Vec3 = (5.5645e-6, 22.8758e-6, -42.3884e-6)
    physics: Physics = Physics()
    models: tuple[SceneModel, ...] = ()
    lights: tuple[SceneLight, ...] = ()
    frames: tuple[SceneFrame, ...] = ()
    joints: tuple[SceneJoint, ...] = ()
    plugins: tuple[ScenePlugin, ...] = ()
    surroundings: Surroundings = Surroundings()
    spherical_coordinates: SphericalCoordinates | None = None
    quality: str = "fast"
    where: Where = NOWHERE

    def model(self, name: str) -> SceneModel | None:
        return next((m for m in self.models if m.name == name), None)


@dataclass(frozen=True, slots=True)
class Scene:
    """A loaded file: its worlds, or one bare model, or one bare light."""

    worlds: tuple[SceneWorld, ...] = ()
    model: SceneModel | None = None
    file: str | None = None
    light: SceneLight | None = None

    @property
    def world(self) -> SceneWorld:
        """The world to run: the first of the file, or an empty one around the bare model or light."""
        if self.worlds:
            return self.worlds[0]
        return SceneWorld(models=(self.model,) if self.model else (), lights=(self.light,) if self.light else ())

"""Worlds: models, lights, physics settings and surroundings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

from simkit.diagnostics import NOWHERE, Where
from simkit.pose import IDENTITY, Pose
from simkit.scene.geometry import Vec3
from simkit.scene.model import Colour, SceneFrame, SceneJoint, SceneLight, SceneModel, ScenePlugin

CONTACT_LAWS = ("simkit", "mujoco")


@dataclass(frozen=True, slots=True)
class Physics:
    """Step [s] and the wanted real-time factor (0: as fast as it goes).

    Attributes:
        max_contacts: of one pair of collisions; 20 where the file says nothing.
        sleep: whether what rests may be left out of the physics until something reaches it.
        contact_law: "simkit", or "mujoco" for contacts and integration as the engine alone has them.
    """

    max_step_size: float = 0.001
    real_time_factor: float = 1.0
    where: Where = NOWHERE
    max_contacts: int = 20
    sleep: bool = True
    contact_law: str = "simkit"


@dataclass(frozen=True, slots=True)
class SphericalCoordinates:
    """Where on Earth (or the Moon, or an ellipsoid of its own) the world's origin lies; angles rad, elevation m.

    Attributes:
        heading: from east to the world's x axis, counter-clockwise.
        surface: EARTH_WGS84, MOON_SCS or CUSTOM_SURFACE.
        equatorial, polar: semi-axes of that surface [m].
    """

    latitude: float = 0.0
    longitude: float = 0.0
    elevation: float = 0.0
    heading: float = 0.0
    where: Where = NOWHERE
    surface: str = "EARTH_WGS84"
    equatorial: float = 6378137.0
    polar: float = 6356752.314245


@dataclass(frozen=True, slots=True)
class Atmosphere:
    """The air at sea level, with a constant lapse rate.

    Attributes:
        temperature: [K].
        temperature_gradient: [K/m].
        pressure: [Pa].
    """

    temperature: float = 288.15
    temperature_gradient: float = -0.0065
    pressure: float = 101325.0
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class Waypoint:
    """Where an actor is at a time [s] of its script."""

    time: float
    pose: Pose


@dataclass(frozen=True, slots=True)
class Trajectory:
    """A way of an actor; `type` names the animation that plays meanwhile, `tension` is that of the spline (0 to 1)."""

    id: int
    type: str
    waypoints: tuple[Waypoint, ...] = ()
    tension: float = 0.0


@dataclass(frozen=True, slots=True)
class Animation:
    """A skeleton animation of an actor."""

    name: str
    uri: str
    scale: float = 1.0
    interpolate_x: bool = False


@dataclass(frozen=True, slots=True)
class PersonLook:
    """How a person looks.

    Attributes:
        height: [m]; None leaves it to the name.
        colours: red, green, blue from 0 to 1 of shirt, trousers, skin and hair, as far as they are given.
    """

    height: float | None = None
    colours: Mapping[str, Vec3] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class SceneActor:
    """A person or animal that follows a script.

    Attributes:
        skin: URI of the mesh; empty where there is none.
        loop, delay_start, auto_start: how its script plays; the delay in seconds.
        person: how a person of our own making looks who stands in for the skin; None leaves it to the name.
    """

    name: str
    pose_world: Pose = IDENTITY
    skin: str = ""
    skin_scale: float = 1.0
    animations: tuple[Animation, ...] = ()
    trajectories: tuple[Trajectory, ...] = ()
    loop: bool = True
    delay_start: float = 0.0
    auto_start: bool = True
    plugins: tuple[ScenePlugin, ...] = ()
    where: Where = NOWHERE
    person: PersonLook | None = None


QUALITIES: Final = ("fast", "gazebo", "high")
"""How pictures can be drawn: as fast as it goes, with Gazebo's shadows and smooth edges, or finer than that."""


@dataclass(frozen=True, slots=True)
class Fog:
    """Mist that grows with the depth z [m] of a surface in a picture.

    Attributes:
        type: linear (none up to `start`, full from `end` [m] on), exp (1 - e^(-density z)) or exp2
            (1 - e^(-(density z)²)), density in 1/m.
    """

    type: str
    colour: Colour = (1.0, 1.0, 1.0, 1.0)
    start: float = 1.0
    end: float = 100.0
    density: float = 1.0


@dataclass(frozen=True, slots=True)
class Surroundings:
    """`<scene>`: colours RGBA from 0 to 1.

    Attributes:
        sky: whether a sky is drawn in place of the background.
        fog: None where the air is clear.
    """

    ambient: Colour = (0.4, 0.4, 0.4, 1.0)
    background: Colour = (0.7, 0.7, 0.7, 1.0)
    shadows: bool = True
    grid: bool = True
    sky: bool = False
    fog: Fog | None = None


@dataclass(frozen=True, slots=True)
class SceneWorld:
    """One world.

    Attributes:
        gravity: [m/s²] in the world frame.
        magnetic_field: [T] in the world frame.
        quality: renderer quality asked for: fast, gazebo or high.
        gazebo_quirks: whether sensors err where Gazebo's are known to err (`<simkit:gazebo_quirks>`).
        wind: velocity of the air [m/s] in the world frame.
        mjcf: for a world in MuJoCo's own format: makes a fresh specification, whose settings of the engine count.
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
    gazebo_quirks: bool = False
    where: Where = NOWHERE
    wind: Vec3 = (0.0, 0.0, 0.0)
    atmosphere: Atmosphere = Atmosphere()
    actors: tuple[SceneActor, ...] = ()
    mjcf: Callable[[], Any] | None = None

    def model(self, name: str) -> SceneModel | None:
        return next((m for m in self.models if m.name == name), None)


@dataclass(frozen=True, slots=True)
class Scene:
    """A loaded file: its worlds, or one bare model, or one bare light.

    Attributes:
        around: what a bare model's file says of the world that it is to stand in; None where it says nothing.
    """

    worlds: tuple[SceneWorld, ...] = ()
    model: SceneModel | None = None
    file: str | None = None
    light: SceneLight | None = None
    around: SceneWorld | None = None

    @property
    def world(self) -> SceneWorld:
        """The world to run: the first of the file, or an empty one around the bare model or light."""
        if self.worlds:
            return self.worlds[0]
        if self.around is not None and self.model is not None:
            return replace(self.around, models=(self.model,))
        return SceneWorld(models=(self.model,) if self.model else (), lights=(self.light,) if self.light else ())

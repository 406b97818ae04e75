"""Worlds: models, lights, physics settings and surroundings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

from simkit.diagnostics import NOWHERE, Where
from simkit.pose import IDENTITY, Pose
from simkit.scene.geometry import Vec3
from simkit.scene.model import Colour, SceneFrame, SceneJoint, SceneLight, SceneModel, ScenePlugin, SceneVisual

CONTACT_LAWS = ("simkit", "mujoco")


@dataclass(frozen=True, slots=True)
class Physics:
    """Physics settings: step size [s] and desired real-time factor (0: as fast as possible).

    Attributes:
        max_contacts: maximum number of contacts of one pair of collisions; 20 if the file gives no value.
        sleep: true if bodies at rest may be left out of the physics until another body reaches them.
        contact_law: "simkit", or "mujoco" for MuJoCo's own contacts and integration.
        engine: bullet if the file chooses this engine, the only one of Gazebo with rolling friction; else None.
    """

    max_step_size: float = 0.001
    real_time_factor: float = 1.0
    where: Where = NOWHERE
    max_contacts: int = 20
    sleep: bool = True
    contact_law: str = "simkit"
    engine: str | None = None


@dataclass(frozen=True, slots=True)
class SphericalCoordinates:
    """Position of the world's origin on Earth, on the Moon or on a custom ellipsoid; angles in rad, elevation in m.

    Attributes:
        heading: angle from east to the world's x axis, counter-clockwise.
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
    """Air at sea level, with a constant lapse rate.

    Attributes:
        temperature: temperature [K].
        temperature_gradient: lapse rate [K/m].
        pressure: pressure [Pa].
    """

    temperature: float = 288.15
    temperature_gradient: float = -0.0065
    pressure: float = 101325.0
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class Waypoint:
    """Pose of an actor at a time [s] of its script."""

    time: float
    pose: Pose


@dataclass(frozen=True, slots=True)
class Trajectory:
    """Path of an actor.

    Attributes:
        type: name of the animation that plays along the path.
        tension: tension of the spline, from 0 to 1.
    """

    id: int
    type: str
    waypoints: tuple[Waypoint, ...] = ()
    tension: float = 0.0


@dataclass(frozen=True, slots=True)
class Animation:
    """Skeleton animation of an actor."""

    name: str
    uri: str
    scale: float = 1.0
    interpolate_x: bool = False


@dataclass(frozen=True, slots=True)
class PersonLook:
    """Appearance of a person.

    Attributes:
        height: height [m]; None derives the height from the name.
        colours: colours of shirt, trousers, skin and hair (red, green, blue from 0 to 1), if given.
    """

    height: float | None = None
    colours: Mapping[str, Vec3] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class SceneActor:
    """Person or animal that follows a script.

    Attributes:
        skin: URI of the mesh; empty if there is none.
        loop, delay_start, auto_start: playback of its script; the delay in seconds.
        person: appearance of simkit's own figure of a person, which replaces the skin; None derives it from the name.
        visuals: visuals of the actor's own links, in the actor's frame; such an actor is rigid and no person.
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
    visuals: tuple[SceneVisual, ...] = ()


ENTITY_SERVICES: Final = ("auto", "classic", "standard")
QUALITIES: Final = ("fast", "gazebo", "high")
"""Rendering qualities: as fast as possible, with Gazebo's shadows and smooth edges, or finer than Gazebo's."""


@dataclass(frozen=True, slots=True)
class Fog:
    """Fog that increases with the depth z [m] of a surface in an image.

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
    """Content of `<scene>`: colours RGBA from 0 to 1.

    Attributes:
        sky: true if a sky is drawn instead of the background.
        fog: fog, or None for clear air.
    """

    ambient: Colour = (0.4, 0.4, 0.4, 1.0)
    background: Colour = (0.7, 0.7, 0.7, 1.0)
    shadows: bool = True
    grid: bool = True
    sky: bool = False
    fog: Fog | None = None


@dataclass(frozen=True, slots=True)
class SceneWorld:
    """World with its models, lights, plugins and settings.

    Attributes:
        gravity: gravity [m/s²] in the world frame.
        magnetic_field: magnetic field [T] in the world frame.
        quality: requested rendering quality: fast, gazebo or high.
        renderer: requested renderer: auto, gl or software.
        gazebo_quirks: true if sensors reproduce Gazebo's known errors (`<simkit:gazebo_quirks>`).
        entity_services: owner of service names that Gazebo Classic and `simulation_interfaces` share (`/spawn_entity`):
            classic or standard; None for Classic in worlds with plugins of gazebo_ros, else the standard.
        wind: velocity of the air [m/s] in the world frame.
        mjcf: function that returns a new specification of a world in MuJoCo's own format; its engine settings are used.
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
    entity_services: str | None = None
    where: Where = NOWHERE
    wind: Vec3 = (0.0, 0.0, 0.0)
    atmosphere: Atmosphere = Atmosphere()
    actors: tuple[SceneActor, ...] = ()
    mjcf: Callable[[], Any] | None = None
    renderer: str = "auto"

    def model(self, name: str) -> SceneModel | None:
        """Return the model of that name, or None."""
        return next((m for m in self.models if m.name == name), None)


@dataclass(frozen=True, slots=True)
class Scene:
    """Loaded file: its worlds, or one bare model, or one bare light.

    Attributes:
        around: world that a bare model's file describes around the model; None if the file describes none.
        standing: names of the models whose height is computed, so that they stand on what is below them.
        arguments: arguments of a xacro file with their values.
    """

    worlds: tuple[SceneWorld, ...] = ()
    model: SceneModel | None = None
    file: str | None = None
    light: SceneLight | None = None
    around: SceneWorld | None = None
    standing: tuple[str, ...] = ()
    arguments: Mapping[str, str] = field(default_factory=dict)

    @property
    def world(self) -> SceneWorld:
        """World to run: the first of the file, or an empty world that holds the bare model or light."""
        if self.worlds:
            return self.worlds[0]
        if self.around is not None and self.model is not None:
            return replace(self.around, models=(self.model,))
        return SceneWorld(models=(self.model,) if self.model else (), lights=(self.light,) if self.light else ())

"""Models and their elements. `pose_world`: pose at load time in the world; `pose_link`: pose in the link frame."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from simkit.diagnostics import NOWHERE, Where
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene.actuation import Calibration, Safety, Transmission
from simkit.scene.geometry import Geometry, Heightmap, Plane, Vec3
from simkit.scene.mjcf_source import MjcfSource

Colour = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass [kg] and inertia [kg·m²] about the centre of mass.

    Attributes:
        com: centre of mass in the link frame [m].
        inertia: ixx, iyy, izz, ixy, ixz, iyz in **link axes**.
        given: false if the file has no inertial and the format's default is used.
    """

    mass: float = 1.0
    com: Vec3 = (0.0, 0.0, 0.0)
    inertia: tuple[float, float, float, float, float, float] = (1.0, 1.0, 1.0, 0.0, 0.0, 0.0)
    given: bool = True


@dataclass(frozen=True, slots=True)
class Surface:
    """Contact properties; None if the file gives no value (the engine's setting for the whole world is then used).

    Attributes:
        mu, mu2: sliding friction coefficients along and across `fdir1`.
        torsional: torsional friction coefficient; None if not given.
        kp, kd: contact stiffness [N/m] and damping [N·s/m].
        patch_radius, surface_radius: radii of the torsional model [m]; the patch is used if `use_patch_radius` is true.
        torsional_slip: slip of the torsional friction, for engines that support it.
        rolling: coefficient of rolling friction (Bullet's); None if not given.
        slip1, slip2: slip velocity of a contact per force, along and across `fdir1` [m/s/N].
        fdir1_frame: link in whose frame `fdir1` is given; empty for the collision's own frame.
    """

    mu: float = 1.0
    mu2: float = 1.0
    fdir1: Vec3 = (0.0, 0.0, 0.0)
    slip1: float = 0.0
    slip2: float = 0.0
    torsional: float | None = None
    kp: float | None = None
    kd: float | None = None
    soft_cfm: float | None = None
    soft_erp: float | None = None
    min_depth: float | None = None
    max_vel: float | None = None
    restitution: float = 0.0
    restitution_threshold: float = 1e5
    collide_bitmask: int = 0xFFFF
    category_bitmask: int = 0xFFFF
    collide_without_contact: bool = False
    where: Where = NOWHERE
    patch_radius: float = 0.0
    surface_radius: float = 0.0
    use_patch_radius: bool = True
    torsional_slip: float = 0.0
    rolling: float | None = None
    fdir1_frame: str = ""


@dataclass(frozen=True, slots=True)
class Material:
    """Appearance of a visual; colours are RGBA from 0 to 1.

    Attributes:
        texture: image on the surface; it is multiplied by `diffuse`.
        script: name of the material script, or empty.
        roughness: roughness of a physically based material, from 0 (mirror) to 1; None if not given.
        double_sided: true if faces are visible from behind as well.
        texture_scale: size of the image relative to the surface, across and up, about its middle. With 0.5 the image
            appears twice in each direction.
        shininess: exponent of the specular highlight; None if not given.
    """

    ambient: Colour = (1.0, 1.0, 1.0, 1.0)
    diffuse: Colour = (1.0, 1.0, 1.0, 1.0)
    specular: Colour = (0.0, 0.0, 0.0, 1.0)
    emissive: Colour = (0.0, 0.0, 0.0, 1.0)
    texture: Path | None = None
    script: str = ""
    roughness: float | None = None
    double_sided: bool = False
    texture_scale: tuple[float, float] = (1.0, 1.0)
    shininess: float | None = None


@dataclass(frozen=True, slots=True)
class Optics:
    """Optical properties of a surface, for the artefacts of lidars and depth cameras.

    Attributes:
        reflectivity: share of the light that the surface scatters in all directions (Lambert's law); above 1 for a
            retro-reflector. None if the file gives no value; `DEFAULT_REFLECTIVITY` then applies.
        transmittance: share of the light that passes through the surface, as through glass.
        specularity: share of the light that the surface reflects as a mirror.
    """

    reflectivity: float | None = None
    transmittance: float = 0.0
    specularity: float = 0.0


DEFAULT_REFLECTIVITY: Final = 0.5
"""Reflectivity of a surface without a value: between wood (0.3 to 0.6) and a white wall (0.8)."""
NO_OPTICS: Final = Optics()


@dataclass(frozen=True, slots=True)
class SceneCollision:
    """Collision shape of a link."""

    name: str
    scoped: str
    pose_link: Pose
    geometry: Geometry
    surface: Surface = Surface()
    laser_retro: float = 0.0
    where: Where = NOWHERE
    optics: Optics = NO_OPTICS


@dataclass(frozen=True, slots=True)
class SceneVisual:
    """Visible shape of a link; `material` is None if the file names none (a mesh then keeps its own materials)."""

    name: str
    scoped: str
    pose_link: Pose
    geometry: Geometry
    material: Material | None = None
    transparency: float = 0.0
    cast_shadows: bool = True
    visibility_flags: int = 0xFFFFFFFF
    laser_retro: float = 0.0
    where: Where = NOWHERE
    plugins: tuple[ScenePlugin, ...] = ()
    optics: Optics = NO_OPTICS


@dataclass(frozen=True, slots=True)
class ScenePlugin:
    """Plugin as named in the file; `scoped` is the name of the entity that it belongs to (empty for the world)."""

    name: str
    filename: str
    scoped: str
    params: Params
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class SceneSensor:
    """Sensor as named in the file; the module of its kind reads `params` (the whole `<sensor>` element).

    Attributes:
        kind: type of the sensor, as written (`imu`, `ray`, `camera`, ...); for `custom` its `gz:type`.
        parent: scoped name of the link or joint that carries the sensor.
        on_joint: true if `parent` is a joint.
        pose_link: pose in the link frame (for a joint: in its child link's frame).
        rate: update rate [Hz]; 0 updates at every step.
        topic: topic, as given, or empty.
    """

    name: str
    scoped: str
    kind: str
    parent: str
    on_joint: bool
    pose_link: Pose
    pose_world: Pose
    rate: float
    topic: str
    params: Params
    plugins: tuple[ScenePlugin, ...] = ()
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class SceneLink:
    """Link: a rigid body.

    Attributes:
        velocity_decay: fraction of the linear and of the angular velocity that is lost at every step.
        enable_wind: true if the wind of the world acts on the link.
        fluid_added_mass: upper triangle of the added mass matrix of a fluid, row by row, in the link's frame: xx, xy,
            …, rr [kg, kg·m, kg·m²]; empty if the file has none.
        plugin_elements: elements of the link in the file that only plugins read, such as `<buoyancy>`.
    """

    name: str
    scoped: str
    pose_world: Pose
    inertial: Inertial = Inertial()
    gravity: bool = True
    kinematic: bool = False
    self_collide: bool = False
    collisions: tuple[SceneCollision, ...] = ()
    visuals: tuple[SceneVisual, ...] = ()
    sensors: tuple[SceneSensor, ...] = ()
    lights: tuple[SceneLight, ...] = ()
    plugins: tuple[ScenePlugin, ...] = ()
    where: Where = NOWHERE
    velocity_decay: tuple[float, float] = (0.0, 0.0)
    enable_wind: bool = False
    fluid_added_mass: tuple[float, ...] = ()
    plugin_elements: tuple[Params, ...] = ()


MOST_LEADERS: Final = 100
"""Largest number of joints in a chain of joints that mimic each other."""


@dataclass(frozen=True, slots=True)
class Mimic:
    """Coupling of a joint to a leader joint: position = multiplier · (leader − reference) + offset."""

    joint: str
    axis: int = 0
    multiplier: float = 1.0
    offset: float = 0.0
    reference: float = 0.0


@dataclass(frozen=True, slots=True)
class Axis:
    """Degree of freedom of a joint; limits in rad or m (inf if none), effort in N·m or N, velocity in rad/s or m/s.

    Attributes:
        xyz_world: unit axis in the world frame at load time.
        xyz_joint: unit axis in the joint frame.
        limit_stiffness, limit_dissipation: stiffness and dissipation of the stop at a position limit [N·m/rad,
            N·m·s/rad, or per metre]; None if the file gives no value.
    """

    xyz_world: Vec3
    xyz_joint: Vec3
    lower: float = -math.inf
    upper: float = math.inf
    effort: float = math.inf
    velocity: float = math.inf
    damping: float = 0.0
    friction: float = 0.0
    stiffness: float = 0.0
    spring_ref: float = 0.0
    mimic: Mimic | None = None
    limit_stiffness: float | None = None
    limit_dissipation: float | None = None


@dataclass(frozen=True, slots=True)
class SceneJoint:
    """Joint between two resolved links.

    Attributes:
        type: revolute, continuous, prismatic, fixed, ball, universal, revolute2, screw, gearbox, floating, planar.
        parent_link, child_link: scoped link names; the parent can be `world`.
        axes: axes of the joint. A planar joint has the axes x and y of its plane, then the rotation about its normal.
        thread_pitch: screw only: metres per turn, already converted from Gazebo's convention in the file.
        gearbox_ratio, gearbox_reference: gearbox only; the reference is a scoped link name.
        safety, calibration: data of a URDF joint, for controllers.
    """

    name: str
    scoped: str
    type: str
    parent_link: str
    child_link: str
    pose_world: Pose
    axes: tuple[Axis, ...] = ()
    thread_pitch: float = 0.0
    gearbox_ratio: float = 1.0
    gearbox_reference: str = ""
    sensors: tuple[SceneSensor, ...] = ()
    plugins: tuple[ScenePlugin, ...] = ()
    where: Where = NOWHERE
    safety: Safety | None = None
    calibration: Calibration | None = None


@dataclass(frozen=True, slots=True)
class SceneFrame:
    """Named frame; `attached_to` is the scoped name of the link or frame that the frame moves with."""

    name: str
    scoped: str
    pose_world: Pose
    attached_to: str = ""


@dataclass(frozen=True, slots=True)
class SceneModel:
    """Model with its links, joints and nested models.

    Attributes:
        scoped: name from the world down, joined with `::`.
        canonical_link: scoped name of the link whose motion is the model's; empty if there is none.
        declared_static: value in the model's own element (or its include); `static` also follows the outer model.
        base: "auto" (floating unless joined to the world), "fixed" or "floating".
        allow_auto_disable: true if the model may sleep while it is at rest.
        transmissions: transmissions of a URDF robot.
        controls: `<ros2_control>` elements as written in the file, for a plugin that reads them.
        mjcf: MuJoCo's own description of the model; if present, this description is simulated.
        moved_by: object that moves the links of a static model during the run (an actor's script), or None.
        urdf: root element of a URDF robot's file, after xacro; None for a model of another format.
        arguments: values of the arguments of the robot's xacro file.
    """

    name: str
    scoped: str
    pose_world: Pose
    static: bool = False
    declared_static: bool = False
    self_collide: bool = False
    canonical_link: str = ""
    base: str = "auto"
    links: tuple[SceneLink, ...] = ()
    joints: tuple[SceneJoint, ...] = ()
    frames: tuple[SceneFrame, ...] = ()
    models: tuple[SceneModel, ...] = ()
    plugins: tuple[ScenePlugin, ...] = ()
    where: Where = NOWHERE
    allow_auto_disable: bool = True
    transmissions: tuple[Transmission, ...] = ()
    controls: tuple[Params, ...] = ()
    mjcf: MjcfSource | None = None
    moved_by: object | None = None
    urdf: Params | None = field(default=None, compare=False, repr=False)
    arguments: Mapping[str, str] = field(default_factory=dict, compare=False, repr=False)

    def all_models(self) -> list[SceneModel]:
        """Return this model and all nested models, outermost first, in document order."""
        return [self, *(m for nested in self.models for m in nested.all_models())]

    def all_links(self) -> list[SceneLink]:
        """Return the links of this model and of all nested models."""
        return [link for m in self.all_models() for link in m.links]

    def all_joints(self) -> list[SceneJoint]:
        """Return the joints of this model and of all nested models."""
        return [joint for m in self.all_models() for joint in m.joints]

    @property
    def has_ground(self) -> bool:
        """True for a model that is a ground itself: it has a plane or a height map that collides."""
        shapes = (collision.geometry for link in self.all_links() for collision in link.collisions)
        return any(isinstance(shape, (Plane, Heightmap)) for shape in shapes)

    def all_sensors(self) -> list[SceneSensor]:
        """Return every sensor on links and joints, in document order of the models."""
        sensors: list[SceneSensor] = []
        for model in self.all_models():
            for link in model.links:
                sensors += link.sensors
            for joint in model.joints:
                sensors += joint.sensors
        return sensors


@dataclass(frozen=True, slots=True)
class SceneLight:
    """Light source.

    Attributes:
        type: directional, point or spot.
        pose_world: pose in the world frame at load time.
        direction: unit vector in the light's own frame.
        direction_world: unit vector in the world frame at load time.
        link: scoped name of the link that carries the light, or empty.
        attenuation: range [m], constant, linear [1/m], quadratic [1/m²].
        spot: inner angle [rad], outer angle [rad], falloff.
        irradiance: irradiance [W/m²] on a surface that faces the light, for a lamp at a distance of 1 m; None if the
            file gives no value.
    """

    name: str
    scoped: str
    type: str
    pose_world: Pose = IDENTITY
    direction: Vec3 = (0.0, 0.0, -1.0)
    direction_world: Vec3 = (0.0, 0.0, -1.0)
    link: str = ""
    diffuse: Colour = (1.0, 1.0, 1.0, 1.0)
    specular: Colour = (0.1, 0.1, 0.1, 1.0)
    intensity: float = 1.0
    attenuation: tuple[float, float, float, float] = (10.0, 1.0, 1.0, 0.0)
    spot: tuple[float, float, float] = (0.0, 0.0, 0.0)
    cast_shadows: bool = False
    on: bool = True
    where: Where = field(default=NOWHERE)
    irradiance: float | None = None

"""Models and what is in them. Poses: `pose_world` at load time; `pose_link` in the link frame."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

from simkit.diagnostics import NOWHERE, Where
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene.actuation import Calibration, Safety, Transmission
from simkit.scene.geometry import Geometry, Vec3
from simkit.scene.mjcf_source import MjcfSource

Colour = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass [kg] and inertia [kg·m²] about the centre of mass.

    Attributes:
        com: centre of mass in the link frame [m].
        inertia: ixx, iyy, izz, ixy, ixz, iyz in **link axes**.
        given: False where the file has no inertial and the format's default stands.
    """

    mass: float = 1.0
    com: Vec3 = (0.0, 0.0, 0.0)
    inertia: tuple[float, float, float, float, float, float] = (1.0, 1.0, 1.0, 0.0, 0.0, 0.0)
    given: bool = True


@dataclass(frozen=True, slots=True)
class Surface:
    """Contact properties; None where the file says nothing (the engine's world-wide setting stands).

    Attributes:
        mu, mu2: sliding friction along and across `fdir1`.
        torsional: torsional friction coefficient; None where not given.
        kp, kd: contact stiffness [N/m] and damping [N·s/m].
        patch_radius, surface_radius: of the torsional model [m]; the patch counts where `use_patch_radius`.
        torsional_slip: slip of the torsional friction, for engines that have it.
        rolling: coefficient of rolling friction (Bullet's); None where not given.
        slip1, slip2: how fast a contact slips along and across `fdir1` [m/s/N].
        fdir1_frame: the link that `fdir1` is given in; empty for the collision's own frame.
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
    """How a visual looks; colours RGBA from 0 to 1.

    Attributes:
        texture: the picture it wears; it counts times `diffuse`.
        script: name of the material script, or empty.
        roughness: of a physically based material, from 0 (mirror) to 1; None where not given.
        double_sided: whether faces are seen from behind as well.
        texture_scale: size of the picture in parts of what wears it, across and up, about its middle; with 0.5 it is
            there twice each way.
        shininess: exponent of the gloss; None where not given.
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
class SceneCollision:
    name: str
    scoped: str
    pose_link: Pose
    geometry: Geometry
    surface: Surface = Surface()
    laser_retro: float = 0.0
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class SceneVisual:
    """`material` is None where the file names none (a mesh then keeps its own)."""

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


@dataclass(frozen=True, slots=True)
class ScenePlugin:
    """A plugin as named in the file; `scoped` is the entity it hangs on (empty for the world)."""

    name: str
    filename: str
    scoped: str
    params: Params
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class SceneSensor:
    """A sensor as named in the file; its kind's own module reads `params` (the whole `<sensor>` element).

    Attributes:
        kind: the file's type, as written (`imu`, `ray`, `camera`, ...); for `custom` its `gz:type`.
        parent: scoped name of the link or joint it hangs on.
        on_joint: whether `parent` is a joint.
        pose_link: in the link frame (for a joint: in its child link's frame).
        rate: update rate [Hz]; 0 is every step.
        topic: as given, or empty.
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
    """A rigid body.

    Attributes:
        velocity_decay: part of the linear and of the angular velocity that is lost at every step; 0 loses nothing.
        enable_wind: whether the wind of the world pushes it.
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


@dataclass(frozen=True, slots=True)
class Mimic:
    """position = multiplier · (leader − reference) + offset."""

    joint: str
    axis: int = 0
    multiplier: float = 1.0
    offset: float = 0.0
    reference: float = 0.0


@dataclass(frozen=True, slots=True)
class Axis:
    """One degree of freedom; limits in rad or m (inf where none), effort N·m or N, velocity rad/s or m/s.

    Attributes:
        xyz_world: unit axis in the world at load time.
        xyz_joint: unit axis in the joint frame.
        limit_stiffness, limit_dissipation: of the stop at a position limit [N·m/rad, N·m·s/rad, or per metre];
            None where the file says nothing.
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
    """A joint between two resolved links.

    Attributes:
        type: revolute, continuous, prismatic, fixed, ball, universal, revolute2, screw, gearbox, floating, planar.
        parent_link, child_link: scoped link names; the parent may be `world`.
        thread_pitch: screw: metres per turn (gz convention of the file already applied).
        gearbox_ratio, gearbox_reference: gearbox only; the reference is a scoped link name.
        axes: planar: along x and y of its plane, then the turn about its normal.
        safety, calibration: of a URDF joint, for controllers.
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
    name: str
    scoped: str
    pose_world: Pose
    attached_to: str = ""


@dataclass(frozen=True, slots=True)
class SceneModel:
    """A model with its links, joints and nested models.

    Attributes:
        scoped: name from the world down, joined with `::`.
        canonical_link: scoped name of the link whose motion is the model's; empty where there is none.
        declared_static: what the model's own element (or its include) says; `static` also follows the outer model.
        base: "auto" (floating unless joined to the world), "fixed" or "floating".
        allow_auto_disable: whether it may sleep while it rests.
        transmissions: of a URDF robot.
        controls: `<ros2_control>` elements as they stand in the file, for a plugin that reads them.
        mjcf: the engine's own description of the model, which is then what is simulated.
        moved_by: what puts the links of a static model elsewhere while it runs (an actor's script); None: nothing.
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

    def all_models(self) -> list[SceneModel]:
        """This model and all nested ones, outermost first, in document order."""
        return [self, *(m for nested in self.models for m in nested.all_models())]

    def all_links(self) -> list[SceneLink]:
        return [link for m in self.all_models() for link in m.links]

    def all_joints(self) -> list[SceneJoint]:
        return [joint for m in self.all_models() for joint in m.joints]

    def all_sensors(self) -> list[SceneSensor]:
        """Every sensor on links and joints, in document order of the models."""
        found: list[SceneSensor] = []
        for model in self.all_models():
            for link in model.links:
                found += link.sensors
            for joint in model.joints:
                found += joint.sensors
        return found


@dataclass(frozen=True, slots=True)
class SceneLight:
    """A light.

    Attributes:
        type: directional, point or spot.
        pose_world: at load time; `link` names the link that carries it, or is empty.
        direction: unit vector in the light's own frame.
        direction_world: the same in the world at load time.
        attenuation: range [m], constant, linear [1/m], quadratic [1/m²].
        spot: inner angle [rad], outer angle [rad], falloff.
        irradiance: of a surface that faces it [W/m²], of a lamp at 1 m; None where the file says nothing.
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

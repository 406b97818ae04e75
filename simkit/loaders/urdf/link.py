"""Reader of `<link>`: mass, collisions and visuals, and the link's `<gazebo>` extensions."""

from __future__ import annotations

import math
from dataclasses import replace

from simkit.loaders.sdf.inertial import MOMENT_NAMES, rotated_moments
from simkit.loaders.sdf.light import read_lights
from simkit.loaders.sdf.material import read_transparency
from simkit.loaders.sdf.optics import read_optics
from simkit.loaders.sdf.plugin import read_plugins
from simkit.loaders.sdf.sensor import read_sensors
from simkit.loaders.sdf.surface import read_surface
from simkit.loaders.sdf.version_upgrade import modernise
from simkit.loaders.urdf.element_attributes import number_attribute as attribute_number
from simkit.loaders.urdf.element_attributes import read_origin, report_bad_value, report_substitute, text_attribute
from simkit.loaders.urdf.gazebo_extensions import read_flag, read_number, read_vector
from simkit.loaders.urdf.geometry import read_geometry
from simkit.loaders.urdf.material import Materials, extended_material
from simkit.loaders.urdf.robot_draft import RobotDraft
from simkit.params import Params
from simkit.scene import NO_OPTICS, Inertial, SceneCollision, SceneLink, SceneSensor, SceneVisual, Surface
from simkit.scene.geometry import vec3

HEAVIEST = 1e15  # [kg] and [kg·m²]; products of larger numbers overflow
_CONTACT_ELEMENTS = {
    "kp": "kp", "kd": "kd", "min_depth": "minDepth", "max_vel": "maxVel", "soft_cfm": "softCfm", "soft_erp": "softErp",
}  # fmt: skip
# Gazebo read the sensors of URDF files as SDF 1.4 when robots wrote one <noise> for a whole IMU.
_SENSORS_VERSION = (1, 4)
PLUGIN_ELEMENTS = ("buoyancy", "fluid")
"""Elements of a link that `libfreefloating_gazebo_fluid.so` reads."""
NO_MASS = Inertial(0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), given=False)


def read_link(draft: RobotDraft, name: str, materials: Materials, windy: bool) -> SceneLink:
    """Return a link whose pose is known.

    Args:
        draft: the robot.
        name: name of the link.
        materials: named materials of the robot.
        windy: true if wind acts on links that have no `<enable_wind>` of their own.
    """
    element, extension = draft.links[name], draft.extensions.of(name)
    decay = read_number(extension, "dampingFactor", minimum=0.0)
    block = extension.block("velocity_decay")
    wind = read_flag(extension, "enable_wind")
    off, gravity = read_flag(extension, "turnGravityOff"), read_flag(extension, "gravity")
    return SceneLink(
        name=name,
        scoped=draft.own(name),
        pose_world=draft.links_world[name],
        inertial=_inertial(name, element),
        gravity=(gravity if gravity is not None else True) if off is None else not off,
        kinematic=bool(read_flag(extension, "kinematic")),
        self_collide=bool(read_flag(extension, "selfCollide", "self_collide")),
        collisions=_collisions(draft, name, element, extension),
        visuals=_visuals(draft, name, element, extension, materials),
        sensors=_sensors(draft, name, extension),
        lights=read_lights(draft.part(name, extension), draft.own(name), draft.links_world[name]),
        plugins=read_plugins(extension.all("plugin"), draft.own(name)),
        where=element.where,
        velocity_decay=(
            block.number("linear", decay or 0.0, minimum=0.0),
            block.number("angular", decay or 0.0, minimum=0.0),
        ),
        enable_wind=windy if wind is None else wind,
        plugin_elements=_plugin_elements(element),
    )


def _plugin_elements(link: Params) -> tuple[Params, ...]:
    """Return the elements of a link that only plugins of the world read."""
    elements = tuple(child for child in link.children if child.name in PLUGIN_ELEMENTS)
    for element in elements:
        element.mark_all_read()
    return elements


def _inertial(name: str, link: Params) -> Inertial:
    """Return mass properties in link axes; a link without `<inertial>` is a frame without mass."""
    block = link.child("inertial")
    if block is None:
        return NO_MASS
    pose = read_origin(block)
    mass, inertia = block.child("mass"), block.child("inertia")
    if mass is None:
        report_substitute(block, f"link {name!r}: <inertial> has no <mass value=...>", "the link has no mass")
        block.mark_all_read()
        return NO_MASS
    if inertia is None:
        problem = f"link {name!r}: <inertial> has no <inertia ixx= iyy= izz= ixy= ixz= iyz=...>"
        report_substitute(block, problem, "its mass is at one point", "add the moments of its shape")
    kilograms = attribute_number(mass, "value", owner=f"link {name!r}")
    if kilograms < 0:
        mass.error("SK-URDF-016", f"link {name!r} has mass {kilograms:g} kg; it cannot be negative")
        kilograms = 1.0
    if kilograms > HEAVIEST:
        report_bad_value(mass, "value", f"at most {HEAVIEST:g} kg")
        kilograms = 1.0
    values = [0.0 if inertia is None else _moment(inertia, key, name) for key in MOMENT_NAMES]
    return Inertial(kilograms, vec3(pose.position), rotated_moments(values, pose), True)


def _moment(inertia: Params, key: str, link: str) -> float:
    """Return a moment; the products of inertia are optional."""
    default = 0.0 if key[1] != key[2] else None
    value = attribute_number(inertia, key, default, owner=f"link {link!r}")
    if abs(value) > HEAVIEST:
        report_bad_value(inertia, key, f"at most {HEAVIEST:g} kg m2")
        return 0.0
    return value


# ---------------------------------------------------------------------- shapes


def unique_names(elements: list[Params], link: str, kind: str) -> list[str]:
    """Return the names of a link's collisions or visuals, as Gazebo generates them.

    Elements without a name are called `<link>_<kind>`, `<link>_<kind>_1`, ...
    """
    written = [text_attribute(element, "name") for element in elements]
    reserved = {name for name in written if name}
    names: list[str] = []
    used: set[str] = set()
    for index, name in enumerate(written):
        stem = name or (f"{link}_{kind}" if index == 0 else f"{link}_{kind}_{index}")
        count, free = 0, stem
        while free in used or (not name and free in reserved):
            count += 1
            free = f"{stem}_{count}"
        used.add(free)
        names.append(free)
    return names


def _collisions(draft: RobotDraft, link: str, element: Params, extension: Params) -> tuple[SceneCollision, ...]:
    elements = element.all("collision")
    surface, retro = _surface(extension), read_number(extension, "laserRetro") or 0.0
    optics = NO_OPTICS
    for block in extension.all("collision"):
        optics = read_optics(block, optics)
    collisions = []
    for name, collision in zip(unique_names(elements, link, "collision"), elements, strict=True):
        shape = read_geometry(collision, draft, f"collision {name!r} of link {link!r}")
        pose = read_origin(collision)
        collision.attribute("group")
        if shape is not None:
            collision_name = draft.own(link, name)
            shared = surface, retro, collision.where, optics
            collisions.append(SceneCollision(name, collision_name, pose, shape, *shared))
    return tuple(collisions)


def _surface(extension: Params) -> Surface:
    """Return contact properties from SDF's elements in `<collision>`; Gazebo's short elements override them."""
    surface = Surface()
    for block in extension.all("collision"):
        surface = read_surface(block)
        block.child("max_contacts")
    settings = {
        "mu": read_number(extension, "mu1", minimum=0.0),
        "mu2": read_number(extension, "mu2", minimum=0.0),
        "fdir1": read_vector(extension, "fdir1"),
        **{field: read_number(extension, element) for field, element in _CONTACT_ELEMENTS.items()},
    }
    known = {key: value for key, value in settings.items() if value is not None}
    return replace(surface, **known, where=extension.where) if known else surface  # type: ignore[arg-type]


def _visuals(
    draft: RobotDraft, link: str, element: Params, extension: Params, materials: Materials
) -> tuple[SceneVisual, ...]:
    elements, blocks = element.all("visual"), extension.all("visual")
    retro = read_number(extension, "laserRetro")
    visuals = []
    for name, visual in zip(unique_names(elements, link, "visual"), elements, strict=True):
        shape = read_geometry(visual, draft, f"visual {name!r} of link {link!r}")
        pose = read_origin(visual)
        material = materials.of(visual)
        if shape is None:
            continue
        scene_visual = SceneVisual(
            name=name,
            scoped=draft.own(link, name),
            pose_link=pose,
            geometry=shape,
            material=extended_material(extension, material, draft),
            laser_retro=retro or 0.0,
            where=visual.where,
        )
        for block in blocks:
            scene_visual = replace(
                scene_visual,
                transparency=read_transparency(block, scene_visual.transparency),
                cast_shadows=block.boolean("cast_shadows", scene_visual.cast_shadows),
                visibility_flags=block.integer("visibility_flags", scene_visual.visibility_flags) & 0xFFFFFFFF,
                laser_retro=block.number("laser_retro", scene_visual.laser_retro),
                plugins=(*scene_visual.plugins, *read_plugins(block.all("plugin"), scene_visual.scoped)),
                optics=read_optics(block, scene_visual.optics),
            )
        visuals.append(scene_visual)
    return tuple(visuals)


# ---------------------------------------------------------------------- sensors


def _sensors(draft: RobotDraft, link: str, extension: Params) -> tuple[SceneSensor, ...]:
    sensors = [modernise(e, _SENSORS_VERSION) for e in _without_duplicates(extension.all("sensor"), link)]
    block = Params("link", children=sensors, where=extension.where, diagnostics=extension.diagnostics)
    return read_sensors(draft.part(link, block), draft.own(link), draft.links_world[link])


def _without_duplicates(sensors: list[Params], link: str) -> list[Params]:
    """Return the sensors without repeated names, which occur in robots that include a xacro file twice."""
    first: dict[str, Params] = {}
    distinct = []
    for element in sensors:
        name = element.attribute("name").strip()
        known = first.setdefault(name, element)
        if name and known is not element:
            message = f"link {link!r} has two sensors named {name!r}; the one at line {known.where.line} is used"
            element.warning("SK-URDF-030", message, "rename one of them")
            element.mark_all_read()
        else:
            distinct.append(element)
    return distinct


def is_massless(link: SceneLink) -> bool:
    """Check whether a link is a frame without mass."""
    return not link.inertial.given or math.isclose(link.inertial.mass, 0.0, abs_tol=0.0)

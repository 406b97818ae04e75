"""`<link>`: mass, collisions and visuals, and what `<gazebo>` adds to them."""

from __future__ import annotations

import math
from dataclasses import replace

from simkit.loaders.sdf.inertial import MOMENT_NAMES, turned_moments
from simkit.loaders.sdf.light import read_lights
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
from simkit.scene import Inertial, SceneCollision, SceneLink, SceneSensor, SceneVisual, Surface
from simkit.scene.geometry import vec3

HEAVIEST = 1e15  # kg and kg m2: the products of larger ones leave the numbers
_CONTACT_WORDS = {
    "kp": "kp", "kd": "kd", "min_depth": "minDepth", "max_vel": "maxVel", "soft_cfm": "softCfm", "soft_erp": "softErp",
}  # fmt: skip
_SENSORS_VERSION = (1, 4)  # of SDF, as which Gazebo read URDF when robots wrote one <noise> for a whole IMU
NO_MASS = Inertial(0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), given=False)


def read_link(draft: RobotDraft, name: str, materials: Materials, windy: bool) -> SceneLink:
    """A link whose place is known; `windy`: whether the wind pushes the links that do not say it themselves."""
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
    )


def _inertial(name: str, link: Params) -> Inertial:
    """Mass properties in link axes; a link without them is a frame without mass."""
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
        said = f"link {name!r}: <inertial> has no <inertia ixx= iyy= izz= ixy= ixz= iyz=...>"
        report_substitute(block, said, "its mass is at one point", "give it the moments of its shape")
    kilograms = attribute_number(mass, "value", owner=f"link {name!r}")
    if kilograms < 0:
        mass.error("SK-URDF-016", f"link {name!r} has mass {kilograms:g} kg, it cannot be negative")
    if kilograms > HEAVIEST:
        report_bad_value(mass, "value", f"at most {HEAVIEST:g} kg")
        kilograms = 1.0
    values = [0.0 if inertia is None else _moment(inertia, key, name) for key in MOMENT_NAMES]
    return Inertial(kilograms, vec3(pose.position), turned_moments(values, pose), True)


def _moment(inertia: Params, key: str, link: str) -> float:
    """A moment; the products of inertia may be left out."""
    default = 0.0 if key[1] != key[2] else None
    value = attribute_number(inertia, key, default, owner=f"link {link!r}")
    if abs(value) > HEAVIEST:
        report_bad_value(inertia, key, f"at most {HEAVIEST:g} kg m2")
        return 0.0
    return value


# ---------------------------------------------------------------------- shapes


def unique_names(elements: list[Params], link: str, kind: str) -> list[str]:
    """Names of a link's collisions or visuals: as written, else `<link>_<kind>`, `<link>_<kind>_1`, ... as Gazebo's."""
    written = [text_attribute(element, "name") for element in elements]
    taken = {name for name in written if name}
    names: list[str] = []
    used: set[str] = set()
    for index, name in enumerate(written):
        stem = name or (f"{link}_{kind}" if index == 0 else f"{link}_{kind}_{index}")
        count, free = 0, stem
        while free in used or (not name and free in taken):
            count += 1
            free = f"{stem}_{count}"
        used.add(free)
        names.append(free)
    return names


def _collisions(draft: RobotDraft, link: str, element: Params, extension: Params) -> tuple[SceneCollision, ...]:
    elements = element.all("collision")
    surface, retro = _surface(extension), read_number(extension, "laserRetro") or 0.0
    found = []
    for name, collision in zip(unique_names(elements, link, "collision"), elements, strict=True):
        shape = read_geometry(collision, draft, f"collision {name!r} of link {link!r}")
        pose = read_origin(collision)
        collision.attribute("group")
        if shape is not None:
            own = draft.own(link, name)
            found.append(SceneCollision(name, own, pose, shape, surface, retro, collision.where))
    return tuple(found)


def _surface(extension: Params) -> Surface:
    """Contact properties: SDF's words in `<collision>`, then Gazebo's short ones."""
    surface = Surface()
    for blob in extension.all("collision"):
        surface = read_surface(blob)
        blob.child("max_contacts")
    given = {
        "mu": read_number(extension, "mu1", minimum=0.0),
        "mu2": read_number(extension, "mu2", minimum=0.0),
        "fdir1": read_vector(extension, "fdir1"),
        **{field: read_number(extension, word) for field, word in _CONTACT_WORDS.items()},
    }
    known = {key: value for key, value in given.items() if value is not None}
    return replace(surface, **known, where=extension.where) if known else surface  # type: ignore[arg-type]


def _visuals(
    draft: RobotDraft, link: str, element: Params, extension: Params, materials: Materials
) -> tuple[SceneVisual, ...]:
    elements, blobs = element.all("visual"), extension.all("visual")
    retro = read_number(extension, "laserRetro")
    found = []
    for name, visual in zip(unique_names(elements, link, "visual"), elements, strict=True):
        shape = read_geometry(visual, draft, f"visual {name!r} of link {link!r}")
        pose = read_origin(visual)
        material = materials.of(visual)
        if shape is None:
            continue
        seen = SceneVisual(
            name=name,
            scoped=draft.own(link, name),
            pose_link=pose,
            geometry=shape,
            material=extended_material(extension, material, draft),
            laser_retro=retro or 0.0,
            where=visual.where,
        )
        for blob in blobs:
            seen = replace(
                seen,
                transparency=blob.number("transparency", seen.transparency, minimum=0.0, maximum=1.0),
                cast_shadows=blob.boolean("cast_shadows", seen.cast_shadows),
                visibility_flags=blob.integer("visibility_flags", seen.visibility_flags) & 0xFFFFFFFF,
                laser_retro=blob.number("laser_retro", seen.laser_retro),
                plugins=(*seen.plugins, *read_plugins(blob.all("plugin"), seen.scoped)),
            )
        found.append(seen)
    return tuple(found)


# ---------------------------------------------------------------------- what hangs on the link


def _sensors(draft: RobotDraft, link: str, extension: Params) -> tuple[SceneSensor, ...]:
    sensors = [modernise(e, _SENSORS_VERSION) for e in _without_duplicates(extension.all("sensor"), link)]
    block = Params("link", children=sensors, where=extension.where, diagnostics=extension.diagnostics)
    return read_sensors(draft.part(link, block), draft.own(link), draft.links_world[link])


def _without_duplicates(sensors: list[Params], link: str) -> list[Params]:
    """Sensors without those that are named like an earlier one, as robots have them whose xacro is included twice."""
    first: dict[str, Params] = {}
    kept = []
    for element in sensors:
        name = element.attribute("name").strip()
        known = first.setdefault(name, element)
        if name and known is not element:
            message = f"link {link!r} has two sensors named {name!r}; that of line {known.where.line} is used"
            element.warning("SK-URDF-030", message, "give one of them another name")
            element.mark_all_read()
        else:
            kept.append(element)
    return kept


def is_massless(link: SceneLink) -> bool:
    """Whether a link is only a frame."""
    return not link.inertial.given or math.isclose(link.inertial.mass, 0.0, abs_tol=0.0)

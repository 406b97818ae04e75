"""Reader of `<link>`: collisions, visuals, sensors, lights and mass."""

from __future__ import annotations

from dataclasses import replace

from simkit.diagnostics import did_you_mean
from simkit.loaders.sdf.entity_names import scoped
from simkit.loaders.sdf.frames import world_pose
from simkit.loaders.sdf.geometry import read_geometry
from simkit.loaders.sdf.inertial import read_fluid_added_mass, read_inertial
from simkit.loaders.sdf.light import read_lights
from simkit.loaders.sdf.load_context import NamedElement, Workspace
from simkit.loaders.sdf.material import read_material, read_transparency
from simkit.loaders.sdf.optics import read_optics
from simkit.loaders.sdf.plugin import read_particle_emitters, read_plugins
from simkit.loaders.sdf.sensor import read_sensors
from simkit.loaders.sdf.surface import read_surface
from simkit.params import Params
from simkit.scene import SceneCollision, SceneLink, SceneVisual, Surface
from simkit.scene.geometry import vec3


def read_link(part: NamedElement, model: str, static: bool, windy: bool, workspace: Workspace) -> SceneLink:
    """Return a link; the poses of all frames must be resolved.

    Args:
        part: the named `<link>` element.
        model: scoped name of its model.
        static: true if the model is static.
        windy: true if wind acts on links of the model that have no `<enable_wind>` of their own.
        workspace: state of the load.
    """
    element = part.element
    link_name = scoped(model, part.name)
    pose = world_pose(part.frame)
    element.child("pose")
    read = [_collision(part, c, name, link_name, workspace) for name, c in part.named("collision")]
    collisions = tuple(c for c, _ in read if c is not None)
    densities = [density for c, density in read if c is not None]
    return SceneLink(
        name=part.name,
        scoped=link_name,
        pose_world=pose,
        inertial=read_inertial(element, part.name, collisions, densities, static, workspace.mesh_reader),
        gravity=element.boolean("gravity", True),
        kinematic=element.boolean("kinematic", False),
        self_collide=element.boolean("self_collide", False),
        collisions=collisions,
        visuals=read_visuals(part, link_name, workspace),
        sensors=read_sensors(part, link_name, pose),
        lights=read_lights(part, link_name, pose),
        plugins=read_plugins(element.all("plugin"), link_name)
        + read_particle_emitters(element.all("particle_emitter"), link_name),
        where=element.where,
        velocity_decay=_velocity_decay(element),
        enable_wind=element.boolean("enable_wind", windy),
        fluid_added_mass=read_fluid_added_mass(element),
    )


def read_visuals(part: NamedElement, link: str, workspace: Workspace) -> tuple[SceneVisual, ...]:
    """Return the visuals of a link, with the scoped name of the link in front of their names."""
    visuals = (_visual(part, element, name, link, workspace) for name, element in part.named("visual"))
    return tuple(visual for visual in visuals if visual is not None)


def _velocity_decay(element: Params) -> tuple[float, float]:
    """Return the fractions of the linear and of the angular velocity that are lost at every step."""
    block = element.block("velocity_decay")
    return block.number("linear", 0.0, minimum=0.0, maximum=1.0), block.number("angular", 0.0, minimum=0.0, maximum=1.0)


def _collision(
    part: NamedElement, element: Params, name: str, link: str, workspace: Workspace
) -> tuple[SceneCollision | None, float | None]:
    """Return a collision and its density [kg/m³]; the density is None if not given."""
    what = f"collision {name!r} of link {part.name!r}"
    shape = read_geometry(element, part.file, workspace, what)
    density = element.number("density", 1000.0, minimum=0, maximum=1e15) if element.has("density") else None
    surface = _with_friction_frame(read_surface(element), part, element, link)
    if shape is None:
        element.mark_all_read()
        return None, density
    collision = SceneCollision(
        name=name,
        scoped=scoped(link, name),
        pose_link=part.pose_of(element, what),
        geometry=shape,
        surface=surface,
        laser_retro=element.number("laser_retro", 0.0),
        where=element.where,
        optics=read_optics(element),
    )
    return collision, density


def _with_friction_frame(surface: Surface, part: NamedElement, element: Params, link: str) -> Surface:
    """Return the surface with the friction direction `<fdir1>` in the frame of a link.

    If the file gives the direction in another frame, it is converted to the link that this frame moves with.
    """
    name = surface.fdir1_frame
    if not name:
        return surface
    scope, frames = part.scope, part.scope.chain(name)
    if frames and frames[-1].kind == "link":
        return surface
    direction = element.block("surface").block("friction").block("ode").child("fdir1") or element
    owner = f"the direction of friction of link {part.name!r}"
    body = None if frames is None else scope.body(name, direction.where, owner)
    if body is None or body.kind != "link":
        if frames is None:
            message = f"{owner} is given in the unknown frame {name!r}; the collision's own frame is used"
            direction.warning("SK-SDF-040", message, did_you_mean(name, scope.all_names()))
        return replace(surface, fdir1_frame="")
    turned = world_pose(body).inverse().rotate((scope.world @ scope.pose_of(name)).rotate(surface.fdir1))
    model_name = link.rpartition("::")[0]
    frame = body.scoped.removeprefix(f"{model_name}::") if model_name else body.scoped
    return replace(surface, fdir1=vec3(turned), fdir1_frame=frame)


def _visual(part: NamedElement, element: Params, name: str, link: str, workspace: Workspace) -> SceneVisual | None:
    what = f"visual {name!r} of link {part.name!r}"
    shape = read_geometry(element, part.file, workspace, what)
    if shape is None:
        element.mark_all_read()
        return None
    return SceneVisual(
        name=name,
        scoped=scoped(link, name),
        pose_link=part.pose_of(element, what),
        geometry=shape,
        material=read_material(element, part.file, workspace),
        transparency=read_transparency(element),
        cast_shadows=element.boolean("cast_shadows", True),
        visibility_flags=element.integer("visibility_flags", -1, minimum=-1, maximum=0xFFFFFFFF) & 0xFFFFFFFF,
        laser_retro=element.number("laser_retro", 0.0),
        where=element.where,
        plugins=read_plugins(element.all("plugin"), scoped(link, name)),
        optics=read_optics(element),
    )

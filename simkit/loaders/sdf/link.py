"""`<link>`: collisions, visuals, sensors, lights and mass."""

from __future__ import annotations

from dataclasses import replace

from simkit.diagnostics import did_you_mean
from simkit.loaders.sdf.entity_names import named_elements, scoped
from simkit.loaders.sdf.frames import world_pose
from simkit.loaders.sdf.geometry import read_geometry
from simkit.loaders.sdf.inertial import read_inertial
from simkit.loaders.sdf.light import read_light
from simkit.loaders.sdf.load_context import NamedElement, Workspace, local_pose
from simkit.loaders.sdf.material import read_material
from simkit.loaders.sdf.plugin import read_plugins
from simkit.loaders.sdf.sensor import read_sensor
from simkit.loaders.sdf.surface import read_surface
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import SceneCollision, SceneLight, SceneLink, SceneSensor, SceneVisual, Surface


def read_link(part: NamedElement, model: str, static: bool, windy: bool, workspace: Workspace) -> SceneLink:
    """A link whose frame is known.

    Args:
        model: scoped name of its model.
        static: whether the model is static.
        windy: whether the wind pushes the links of the model that do not say it themselves.
    """
    element, diagnostics = part.element, workspace.diagnostics
    own = scoped(model, part.name)
    pose = world_pose(part.frame)
    element.child("pose")
    read = [
        _collision(part, c, name, own, workspace)
        for name, c in named_elements(element.all("collision"), f"link {part.name!r}", diagnostics, part.file.version)
    ]
    collisions = tuple(c for c, _ in read if c is not None)
    densities = [density for c, density in read if c is not None]
    visuals = tuple(
        visual
        for name, v in named_elements(element.all("visual"), f"link {part.name!r}", diagnostics, part.file.version)
        if (visual := _visual(part, v, name, own, workspace)) is not None
    )
    return SceneLink(
        name=part.name,
        scoped=own,
        pose_world=pose,
        inertial=read_inertial(element, part.name, collisions, densities, static, diagnostics, workspace.mesh_reader),
        gravity=element.boolean("gravity", True),
        kinematic=element.boolean("kinematic", False),
        self_collide=element.boolean("self_collide", False),
        collisions=collisions,
        visuals=visuals,
        sensors=_sensors(part, own, pose, workspace),
        lights=_lights(part, own, pose, workspace),
        plugins=read_plugins(element.all("plugin"), own),
        where=element.where,
        velocity_decay=_velocity_decay(element),
        enable_wind=element.boolean("enable_wind", windy),
    )


def _velocity_decay(element: Params) -> tuple[float, float]:
    """The part of the linear and of the angular velocity lost at every step."""
    block = element.block("velocity_decay")
    return block.number("linear", 0.0, minimum=0.0, maximum=1.0), block.number("angular", 0.0, minimum=0.0, maximum=1.0)


def _collision(
    part: NamedElement, element: Params, name: str, link: str, workspace: Workspace
) -> tuple[SceneCollision | None, float | None]:
    """A collision and its density [kg/m³], None where not given."""
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
        pose_link=local_pose(element, part.scope, part.frame, what),
        geometry=shape,
        surface=surface,
        laser_retro=element.number("laser_retro", 0.0),
        where=element.where,
    )
    return collision, density


def _with_friction_frame(surface: Surface, part: NamedElement, element: Params, link: str) -> Surface:
    """A surface whose `<fdir1>` is told in a link: in the one that the frame moves with that the file names."""
    name = surface.fdir1_frame
    if not name:
        return surface
    scope, frames = part.scope, part.scope.chain(name)
    if frames and frames[-1].kind == "link":
        return surface
    found = element.block("surface").block("friction").block("ode").child("fdir1")
    where = element.where if found is None else found.where
    owner = f"the direction of friction of link {part.name!r}"
    body = None if frames is None else scope.body(name, where, owner)
    if body is None or body.kind != "link":
        if frames is None:
            message = f"{owner} is told in {name!r}, which is no frame here; it is taken in the collision's own"
            hint = did_you_mean(name, scope.all_names())
            scope.diagnostics.warning("SK-SDF-040", message, where, hint)
        return replace(surface, fdir1_frame="")
    turned = world_pose(body).inverse().rotate((scope.world @ scope.pose_of(name)).rotate(surface.fdir1))
    own = link.rpartition("::")[0]
    return replace(
        surface,
        fdir1=(float(turned[0]), float(turned[1]), float(turned[2])),
        fdir1_frame=body.scoped.removeprefix(f"{own}::") if own else body.scoped,
    )


def _visual(part: NamedElement, element: Params, name: str, link: str, workspace: Workspace) -> SceneVisual | None:
    what = f"visual {name!r} of link {part.name!r}"
    shape = read_geometry(element, part.file, workspace, what)
    if shape is None:
        element.mark_all_read()
        return None
    return SceneVisual(
        name=name,
        scoped=scoped(link, name),
        pose_link=local_pose(element, part.scope, part.frame, what),
        geometry=shape,
        material=read_material(element, part.file, workspace),
        transparency=element.number("transparency", 0.0, minimum=0.0, maximum=1.0),
        cast_shadows=element.boolean("cast_shadows", True),
        visibility_flags=element.integer("visibility_flags", -1, minimum=-1, maximum=0xFFFFFFFF) & 0xFFFFFFFF,
        laser_retro=element.number("laser_retro", 0.0),
        where=element.where,
        plugins=read_plugins(element.all("plugin"), scoped(link, name)),
    )


def _sensors(part: NamedElement, link: str, pose: Pose, workspace: Workspace) -> tuple[SceneSensor, ...]:
    found = named_elements(part.element.all("sensor"), f"link {part.name!r}", workspace.diagnostics, part.file.version)
    return tuple(
        read_sensor(
            e, name, link, False, local_pose(e, part.scope, part.frame, f"sensor {name!r}"), pose, workspace.diagnostics
        )
        for name, e in found
    )


def _lights(part: NamedElement, link: str, pose: Pose, workspace: Workspace) -> tuple[SceneLight, ...]:
    found = named_elements(part.element.all("light"), f"link {part.name!r}", workspace.diagnostics, part.file.version)
    return tuple(
        read_light(
            e,
            name,
            scoped(link, name),
            pose @ local_pose(e, part.scope, part.frame, f"light {name!r}"),
            link,
            workspace.diagnostics,
        )
        for name, e in found
    )

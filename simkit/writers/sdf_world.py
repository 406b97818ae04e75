"""SDF text of a scene: one file with all content, without includes and with resolved poses."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from simkit.compiler.refused_inertias import format_moments, repair_inertia
from simkit.diagnostics import Diagnostics
from simkit.number_text import counted
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene import (
    Animation,
    Atmosphere,
    Inertial,
    PersonLook,
    Scene,
    SceneActor,
    SceneFrame,
    SceneJoint,
    SceneLink,
    SceneModel,
    SceneWorld,
    SphericalCoordinates,
    Trajectory,
)
from simkit.scene.simkit_elements import written_name
from simkit.scene.world import Fog
from simkit.writers import sdf_elements as parts
from simkit.writers.sdf_elements import UriOf
from simkit.writers.xml_text import (
    changed_element,
    changed_elements,
    document,
    element,
    field_elements,
    numbers,
    pose,
    text_element,
)

_WORLD = "world"
_VERSION = "1.11"
_LENIENT = "1.6"  # last version that allows equal names of different elements, and `::` in names
_FRAMES = ("model", "link", "joint", "frame")
_NOT_IN_SDF = ("planar", "floating")


def sdf_text(scene: Scene, diagnostics: Diagnostics, uri_of: UriOf | None = None) -> str:
    """Return the text of an SDF file with the content of a scene.

    Args:
        scene: worlds, or one bare model or light.
        diagnostics: collector of a warning for each feature that SDF does not support.
        uri_of: function that returns the URI to write, given a file and its original URI; None keeps all URIs.
    """
    return document(_Writer(diagnostics, uri_of or _original_uri).root(scene))


def _original_uri(_file: Path, uri: str) -> str:
    return uri


class _Writer:
    """Writer of the elements of one scene."""

    def __init__(self, diagnostics: Diagnostics, uri_of: UriOf) -> None:
        self.diagnostics, self.uri_of = diagnostics, uri_of

    def root(self, scene: Scene) -> Params:
        children: list[Params] = [self.world(w) for w in scene.worlds]
        if not scene.worlds and scene.model is not None:
            children.append(self.model(scene.model, IDENTITY))
        if not scene.worlds and scene.light is not None:
            children.append(parts.light(scene.light, scene.light.pose_world))
        return element("sdf", children, version=_LENIENT if _needs_lenience(children) else _VERSION)

    # ------------------------------------------------------------------ worlds

    def world(self, world: SceneWorld) -> Params:
        links = _links_of(world.models)
        joints = (self.joint(j, "", links) for j in world.joints)
        children = [
            _physics_element(world),
            *field_elements(world, "gravity", "magnetic_field"),
            element("wind", [text_element("linear_velocity", world.wind)]) if any(world.wind) else None,
            _atmosphere_element(world.atmosphere),
            _spherical_coordinates_element(world.spherical_coordinates),
            *changed_elements(world, "entity_services", "gazebo_quirks"),
            _scene_element(world),
            *(parts.plugin(p) for p in world.plugins),
            *(parts.light(li, li.pose_world) for li in world.lights),
            *(self.frame(f, IDENTITY, "", links) for f in world.frames),
            *(self.model(m, IDENTITY) for m in world.models if m.moved_by is None),
            *(_actor(a) for a in world.actors),
            *joints,
        ]
        return element("world", children, name=world.name)

    # ------------------------------------------------------------------ models

    def model(self, model: SceneModel, outer: Pose) -> Params:
        """Return a model; `outer` is the world pose of its parent."""
        here = model.pose_world
        model = self._without_world_link(model)
        links = {link.scoped: link for link in model.all_links()}
        attributes = {"name": model.name}
        canonical = _name_inside(model.canonical_link, model.scoped)
        first = model.links[0].name if model.links else ""
        if canonical and canonical != first:
            attributes["canonical_link"] = canonical
        self._report_lost(model)
        children = [
            pose(outer.inverse() @ here),
            changed_element("static", model.declared_static, False),
            *changed_elements(model, "self_collide", "allow_auto_disable"),
            *(self.frame(f, here, model.scoped, links) for f in model.frames),
            *(self.link(link, here) for link in model.links),
            *(self.joint(j, model.scoped, links) for j in model.joints),
            _world_joint(model, canonical) if model.base == "fixed" and canonical else None,
            *(self.model(nested, here) for nested in model.models),
            *(parts.plugin(p) for p in model.plugins),
            *model.controls,
        ]
        return element("model", children, **attributes)

    def frame(self, frame: SceneFrame, here: Pose, model: str, links: dict[str, SceneLink]) -> Params:
        """Return a frame; its pose is relative to the frame that it is attached to, as SDF requires."""
        attributes = {"name": frame.name}
        carrier = links.get(frame.attached_to)
        if carrier is not None:
            attributes["attached_to"] = _name_inside(frame.attached_to, model)
            here = carrier.pose_world
        return element("frame", [pose(here.inverse() @ frame.pose_world)], **attributes)

    def link(self, link: SceneLink, here: Pose) -> Params:
        linear, angular = link.velocity_decay
        decay = element("velocity_decay", [text_element("linear", linear), text_element("angular", angular)])
        inverse = link.pose_world.inverse()
        children = [
            pose(here.inverse() @ link.pose_world),
            parts.inertial(self._written_inertia(link), link.fluid_added_mass),
            *changed_elements(link, "gravity", "kinematic", "self_collide", "enable_wind"),
            decay if linear or angular else None,
            *(parts.collision(c, self.uri_of) for c in link.collisions),
            *(parts.visual(v, self.uri_of) for v in link.visuals),
            *(parts.light(li, inverse @ li.pose_world) for li in link.lights),
            *(parts.sensor(s, s.pose_link) for s in link.sensors),
            *(parts.plugin(p) for p in link.plugins),
        ]
        return element("link", children, name=link.name)

    def joint(self, joint: SceneJoint, model: str, links: dict[str, SceneLink]) -> Params | None:
        """Return a joint; None, with a warning, for a joint type that SDF does not have."""
        if joint.type in _NOT_IN_SDF:
            left = "its child link moves freely" if joint.type == "floating" else "it is omitted"
            message = f"joint {joint.scoped!r}: SDF has no {joint.type} joint; {left}"
            self.diagnostics.warning("SK-WRITE-001", message, joint.where)
            return None
        child = links.get(joint.child_link)
        frame = (child.pose_world if child is not None else IDENTITY).inverse() @ joint.pose_world
        axes = [
            parts.axis(a, name, joint.type, _name_inside(a.mimic.joint, model) if a.mimic else "")
            for a, name in zip(joint.axes, ("axis", "axis2"), strict=False)
        ]
        of_type = []
        if joint.type == "screw":
            of_type = [text_element("screw_thread_pitch", joint.thread_pitch)]
        elif joint.type == "gearbox":
            reference = text_element("gearbox_reference_body", _name_inside(joint.gearbox_reference, model))
            of_type = [*field_elements(joint, "gearbox_ratio"), reference]
        children = [
            pose(frame),
            text_element("parent", _name_inside(joint.parent_link, model)),
            text_element("child", _name_inside(joint.child_link, model)),
            *of_type,
            *axes,
            *(parts.sensor(s, frame.inverse() @ s.pose_link) for s in joint.sensors),
            *(parts.plugin(p) for p in joint.plugins),
        ]
        return element("joint", children, name=joint.name, type=joint.type)

    def _written_inertia(self, link: SceneLink) -> Inertial:
        """Return the link's inertia; for a negative moment, the nearest inertia that SDF accepts."""
        repair = repair_inertia(link.inertial)
        if link.inertial.mass <= 0 or repair.old[0] >= -1e-15:
            return link.inertial
        moments = f"{format_moments(repair.old)} become {format_moments(repair.new)}"
        message = f"link {link.scoped!r}: SDF does not allow a negative moment of inertia; {moments}"
        self.diagnostics.warning("SK-WRITE-003", message, link.where)
        return repair.inertial

    def _without_world_link(self, model: SceneModel) -> SceneModel:
        """Replace a URDF link named `world` by the world itself."""
        scoped = f"{model.scoped}::{_WORLD}"
        ground = next((link for link in model.links if link.name == _WORLD), None)
        if ground is None or model.base != "fixed" or any(j.child_link == scoped for j in model.joints):
            return model
        if ground.collisions or ground.visuals or ground.sensors or ground.lights:
            message = f"link {scoped!r} is the world, which has no shapes in SDF; its shapes are omitted"
            self.diagnostics.warning("SK-WRITE-002", message, ground.where)
        links = tuple(link for link in model.links if link is not ground)
        joints = tuple(replace(j, parent_link=_WORLD) if j.parent_link == scoped else j for j in model.joints)
        is_fixed = any(j.parent_link == _WORLD for j in joints)
        first = links[0].scoped if links else ""
        canonical = first if model.canonical_link == scoped else model.canonical_link
        base = "auto" if is_fixed else model.base
        return replace(model, links=links, joints=joints, canonical_link=canonical, base=base)

    def _report_lost(self, model: SceneModel) -> None:
        lost = {
            "transmission": len(model.transmissions),
            "<safety_controller>": sum(j.safety is not None for j in model.joints),
            "<calibration>": sum(j.calibration is not None for j in model.joints),
        }
        listed = ", ".join(
            counted(count, name, name if name[0] == "<" else "") for name, count in lost.items() if count
        )
        if listed:
            message = f"model {model.scoped!r}: SDF does not support {listed}; they are omitted"
            self.diagnostics.warning("SK-WRITE-002", message, model.where)
        if model.mjcf is not None:
            message = f"model {model.scoped!r} is an MJCF model: actuators, tendons, sensors and settings of"
            self.diagnostics.warning("SK-WRITE-002", f"{message} the engine are omitted", model.where)


def _actor(actor: SceneActor) -> Params:
    """Return an actor with its script; its files keep their names."""
    skin = [text_element("filename", actor.skin), text_element("scale", actor.skin_scale)]
    script = [*field_elements(actor, "loop", "delay_start", "auto_start"), *map(_trajectory, actor.trajectories)]
    children = [
        pose(actor.pose_world),
        element("skin", skin) if actor.skin else None,
        *map(_animation, actor.animations),
        None if actor.person is None else _person_element(actor.person),
        element("script", script),
        *(parts.plugin(p) for p in actor.plugins),
    ]
    return element("actor", children, name=actor.name)


def _trajectory(trajectory: Trajectory) -> Params:
    points = [
        element("waypoint", [*field_elements(w, "time"), pose(w.pose) or element("pose", "0 0 0 0 0 0")])
        for w in trajectory.waypoints
    ]
    tension = {"tension": numbers((trajectory.tension,))} if trajectory.tension else {}
    return element("trajectory", points, id=str(trajectory.id), type=trajectory.type, **tension)


def _animation(animation: Animation) -> Params:
    children = [text_element("filename", animation.uri), *field_elements(animation, "scale", "interpolate_x")]
    return element("animation", children, name=animation.name)


def _world_joint(model: SceneModel, canonical: str) -> Params:
    """Return the joint that fixes a model with a fixed base to the world."""
    ends = [text_element("parent", _WORLD), text_element("child", canonical)]
    used_names = {j.name for j in model.joints} | {link.name for link in model.links}
    name = "fixed_to_world"
    while name in used_names:
        name += "_"
    return element("joint", ends, name=name, type="fixed")


def _name_inside(scoped: str, model: str) -> str:
    """Return a scoped name as it is written inside a model."""
    return scoped.removeprefix(f"{model}::") if model else scoped


def _person_element(look: PersonLook) -> Params:
    """Return the appearance of a person model of simkit."""
    children = [changed_element("height", look.height, None), *(text_element(k, v) for k, v in look.colours.items())]
    return element(written_name("person", "actor"), children)


def _links_of(models: Iterable[SceneModel]) -> dict[str, SceneLink]:
    return {link.scoped: link for m in models for link in m.all_links()}


def _needs_lenience(nodes: Iterable[Params]) -> bool:
    """Check whether there are names that SDF 1.7 and later reject."""
    stack = list(nodes)
    while stack:
        node = stack.pop()
        named = [c for c in node.children if c.name in _FRAMES]
        names = [c.attributes.get("name", "") for c in named]
        if len(set(names)) < len(names) or any("::" in n or n == _WORLD for n in names):
            return True
        stack += [c for c in node.children if c.name in ("model", "link", "joint")]
    return False


# ------------------------------------------------------------------ settings of the world


def _physics_element(world: SceneWorld) -> Params:
    """Return `<physics>`."""
    children = [
        *field_elements(world.physics, "max_step_size", "real_time_factor"),
        changed_element("simkit:contact_law", world.physics.contact_law, "simkit"),
        *changed_elements(world.physics, "max_contacts"),
    ]
    return element("physics", children, name="default", type=world.physics.engine or "ode")


def _scene_element(world: SceneWorld) -> Params:
    """Return `<scene>`."""
    around = world.surroundings
    children = [
        *field_elements(around, "ambient", "background", "shadows", "grid"),
        element("sky") if around.sky else None,
        None if around.fog is None else _fog(around.fog),
        *changed_elements(world, "quality", "renderer"),
    ]
    return element("scene", children)


def _fog(fog: Fog) -> Params:
    return element("fog", [text_element("color", fog.colour), *field_elements(fog, "type", "start", "end", "density")])


def _atmosphere_element(air: Atmosphere) -> Params:
    """Return `<atmosphere>`."""
    children = field_elements(air, "temperature", "temperature_gradient", "pressure")
    return element("atmosphere", children, type="adiabatic")


def _spherical_coordinates_element(place: SphericalCoordinates | None) -> Params | None:
    """Return `<spherical_coordinates>`; None without coordinates."""
    if place is None:
        return None
    custom = place.surface == "CUSTOM_SURFACE"
    children = [
        text_element("surface_model", place.surface),
        text_element("surface_axis_equatorial", place.equatorial) if custom else None,
        text_element("surface_axis_polar", place.polar) if custom else None,
        text_element("world_frame_orientation", "ENU"),
        text_element("latitude_deg", math.degrees(place.latitude)),
        text_element("longitude_deg", math.degrees(place.longitude)),
        *field_elements(place, "elevation"),
        text_element("heading_deg", math.degrees(place.heading)),
    ]
    return element("spherical_coordinates", children)

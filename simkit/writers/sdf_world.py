"""Scenes as SDF: one file with everything in it, includes written out and every pose resolved."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from simkit.compiler.refused_inertias import format_moments, repair_inertia
from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene import (
    Inertial,
    PersonLook,
    Scene,
    SceneActor,
    SceneFrame,
    SceneJoint,
    SceneLink,
    SceneModel,
    SceneWorld,
)
from simkit.scene.simkit_elements import written_name
from simkit.writers import sdf_elements as parts
from simkit.writers.sdf_elements import Place, changed_element, text_element
from simkit.writers.sdf_world_settings import physics_element, scene_element, spherical_coordinates_element
from simkit.writers.xml_text import document, element, numbers, pose

_WORLD = "world"
_VERSION = "1.11"
_LENIENT = "1.6"  # the last in which siblings of different kinds may share a name, and a name may have `::` in it
_FRAMES = ("model", "link", "joint", "frame")
_NOT_IN_SDF = ("planar", "floating")


def sdf_text(scene: Scene, diagnostics: Diagnostics, place: Place | None = None) -> str:
    """The text of an SDF file that means what the scene means.

    Args:
        scene: worlds, or one bare model or light.
        diagnostics: gets a warning for each thing that SDF has no word for.
        place: gives the URI to write for a file; None keeps each as it was written.
    """
    return document(_Writer(diagnostics, place or _as_written).root(scene))


def _as_written(_file: Path, uri: str) -> str:
    return uri


class _Writer:
    def __init__(self, diagnostics: Diagnostics, place: Place) -> None:
        self.diagnostics, self.place = diagnostics, place

    def root(self, scene: Scene) -> Params:
        children: list[Params] = [self.world(w) for w in scene.worlds]
        if not scene.worlds and scene.model is not None:
            children.append(self.model(scene.model, IDENTITY))
        if not scene.worlds and scene.light is not None:
            children.append(parts.light(scene.light, scene.light.pose_world))
        return element("sdf", "", children, version=_LENIENT if _needs_lenience(children) else _VERSION)

    # ------------------------------------------------------------------ worlds

    def world(self, world: SceneWorld) -> Params:
        air = world.atmosphere
        return element(
            "world",
            "",
            [
                physics_element(world),
                text_element("gravity", world.gravity),
                text_element("magnetic_field", world.magnetic_field),
                element("wind", "", [text_element("linear_velocity", world.wind)]) if any(world.wind) else None,
                element(
                    "atmosphere",
                    "",
                    [
                        text_element("temperature", air.temperature),
                        text_element("temperature_gradient", air.temperature_gradient),
                        text_element("pressure", air.pressure),
                    ],
                    type="adiabatic",
                ),
                None
                if world.spherical_coordinates is None
                else spherical_coordinates_element(world.spherical_coordinates),
                changed_element("gazebo_quirks", world.gazebo_quirks, False),
                scene_element(world),
                *(parts.plugin(p) for p in world.plugins),
                *(parts.light(li, li.pose_world) for li in world.lights),
                *(self.frame(f, IDENTITY, "", _links_of(world.models)) for f in world.frames),
                *(self.model(m, IDENTITY) for m in world.models if m.moved_by is None),
                *(self.actor(a) for a in world.actors),
                *(e for j in world.joints if (e := self.joint(j, "", _links_of(world.models))) is not None),
            ],
            name=world.name,
        )

    def actor(self, actor: SceneActor) -> Params:
        """An actor with its script; its files are named as they were."""
        ways = [
            element(
                "trajectory",
                "",
                [
                    element(
                        "waypoint", "", [text_element("time", w.time), pose(w.pose) or element("pose", "0 0 0 0 0 0")]
                    )
                    for w in way.waypoints
                ],
                id=str(way.id),
                type=way.type,
                **({"tension": numbers((way.tension,))} if way.tension else {}),
            )
            for way in actor.trajectories
        ]
        script = [
            text_element("loop", actor.loop),
            text_element("delay_start", actor.delay_start),
            text_element("auto_start", actor.auto_start),
            *ways,
        ]
        skin = [text_element("filename", actor.skin), text_element("scale", actor.skin_scale)]
        moves = [
            element(
                "animation",
                "",
                [
                    text_element("filename", a.uri),
                    text_element("scale", a.scale),
                    text_element("interpolate_x", a.interpolate_x),
                ],
                name=a.name,
            )
            for a in actor.animations
        ]
        return element(
            "actor",
            "",
            [
                pose(actor.pose_world),
                element("skin", "", skin) if actor.skin else None,
                *moves,
                _person_element(actor.person),
                element("script", "", script),
                *(parts.plugin(p) for p in actor.plugins),
            ],
            name=actor.name,
        )

    # ------------------------------------------------------------------ models

    def model(self, model: SceneModel, outer: Pose) -> Params:
        """A model; `outer` is the world pose of what holds it."""
        here = model.pose_world
        model = self._without_world_link(model)
        links = {link.scoped: link for link in model.all_links()}
        attributes = {"name": model.name}
        canonical = _name_inside(model.canonical_link, model.scoped)
        first = model.links[0].name if model.links else ""
        if canonical and canonical != first:
            attributes["canonical_link"] = canonical
        self._report_lost(model)
        return element(
            "model",
            "",
            [
                pose(outer.inverse() @ here),
                changed_element("static", model.declared_static, False),
                changed_element("self_collide", model.self_collide, False),
                changed_element("allow_auto_disable", model.allow_auto_disable, True),
                *(self.frame(f, here, model.scoped, links) for f in model.frames),
                *(self.link(link, here) for link in model.links),
                *(e for j in model.joints if (e := self.joint(j, model.scoped, links)) is not None),
                *(_world_joint(model, canonical) if model.base == "fixed" and canonical else ()),
                *(self.model(nested, here) for nested in model.models),
                *(parts.plugin(p) for p in model.plugins),
            ],
            **attributes,
        )

    def frame(self, frame: SceneFrame, here: Pose, model: str, links: dict[str, SceneLink]) -> Params:
        """A frame; its pose is relative to what it is attached to, which is the format's own rule."""
        attributes = {"name": frame.name}
        carrier = links.get(frame.attached_to)
        if carrier is not None:
            attributes["attached_to"] = _name_inside(frame.attached_to, model)
            here = carrier.pose_world
        return element("frame", "", [pose(here.inverse() @ frame.pose_world)], **attributes)

    def link(self, link: SceneLink, here: Pose) -> Params:
        linear, angular = link.velocity_decay
        decay = element("velocity_decay", "", [text_element("linear", linear), text_element("angular", angular)])
        inverse = link.pose_world.inverse()
        return element(
            "link",
            "",
            [
                pose(here.inverse() @ link.pose_world),
                parts.inertial(self._written_inertia(link)),
                changed_element("gravity", link.gravity, True),
                changed_element("kinematic", link.kinematic, False),
                changed_element("self_collide", link.self_collide, False),
                changed_element("enable_wind", link.enable_wind, False),
                decay if linear or angular else None,
                *(parts.collision(c, self.place) for c in link.collisions),
                *(parts.visual(v, self.place) for v in link.visuals),
                *(parts.light(li, inverse @ li.pose_world) for li in link.lights),
                *(parts.sensor(s, s.pose_link) for s in link.sensors),
                *(parts.plugin(p) for p in link.plugins),
            ],
            name=link.name,
        )

    def joint(self, joint: SceneJoint, model: str, links: dict[str, SceneLink]) -> Params | None:
        """A joint; None, with a warning, where SDF has none of its kind."""
        if joint.type in _NOT_IN_SDF:
            left = "its child link moves freely" if joint.type == "floating" else "it is left out"
            self.diagnostics.warning(
                "SK-WRITE-001", f"joint {joint.scoped!r}: SDF has no {joint.type} joint; {left}", joint.where
            )
            return None
        child = links.get(joint.child_link)
        frame = (child.pose_world if child is not None else IDENTITY).inverse() @ joint.pose_world
        axes = [
            parts.axis(a, name, joint.type, _name_inside(a.mimic.joint, model) if a.mimic else "")
            for a, name in zip(joint.axes, ("axis", "axis2"), strict=False)
        ]
        is_gearbox, is_screw = joint.type == "gearbox", joint.type == "screw"
        return element(
            "joint",
            "",
            [
                pose(frame),
                text_element("parent", _name_inside(joint.parent_link, model)),
                text_element("child", _name_inside(joint.child_link, model)),
                text_element("screw_thread_pitch", joint.thread_pitch) if is_screw else None,
                text_element("gearbox_ratio", joint.gearbox_ratio) if is_gearbox else None,
                text_element("gearbox_reference_body", _name_inside(joint.gearbox_reference, model))
                if is_gearbox
                else None,
                *axes,
                *(parts.sensor(s, frame.inverse() @ s.pose_link) for s in joint.sensors),
                *(parts.plugin(p) for p in joint.plugins),
            ],
            name=joint.name,
            type=joint.type,
        )

    def _written_inertia(self, link: SceneLink) -> Inertial:
        """The link's inertia; the nearest that SDF takes where it has a negative moment."""
        found = repair_inertia(link.inertial)
        if link.inertial.mass <= 0 or found.old[0] >= -1e-15:
            return link.inertial
        self.diagnostics.warning(
            "SK-WRITE-003",
            f"link {link.scoped!r}: SDF takes no negative moment of inertia, {format_moments(found.old)} become "
            f"{format_moments(found.new)}",
            link.where,
        )
        return found.inertial

    def _without_world_link(self, model: SceneModel) -> SceneModel:
        """A URDF link called `world` is the world itself."""
        scoped = f"{model.scoped}::{_WORLD}"
        ground = next((link for link in model.links if link.name == _WORLD), None)
        if ground is None or model.base != "fixed" or any(j.child_link == scoped for j in model.joints):
            return model
        if ground.collisions or ground.visuals or ground.sensors or ground.lights:
            self.diagnostics.warning(
                "SK-WRITE-002", f"link {scoped!r} is the world, which has no shapes in SDF; left out", ground.where
            )
        links = tuple(link for link in model.links if link is not ground)
        joints = tuple(replace(j, parent_link=_WORLD) if j.parent_link == scoped else j for j in model.joints)
        held = any(j.parent_link == _WORLD for j in joints)
        first = links[0].scoped if links else ""
        canonical = first if model.canonical_link == scoped else model.canonical_link
        base = "auto" if held else model.base
        return replace(model, links=links, joints=joints, canonical_link=canonical, base=base)

    def _report_lost(self, model: SceneModel) -> None:
        lost = {
            "transmissions": len(model.transmissions),
            "<ros2_control> blocks": len(model.controls),
            "<safety_controller>": sum(j.safety is not None for j in model.joints),
            "<calibration>": sum(j.calibration is not None for j in model.joints),
        }
        listed = ", ".join(f"{count} {name}" for name, count in lost.items() if count)
        if listed:
            self.diagnostics.warning(
                "SK-WRITE-002", f"model {model.scoped!r}: SDF has no word for {listed}; left out", model.where
            )
        if model.mjcf is not None:
            self.diagnostics.warning(
                "SK-WRITE-002",
                f"model {model.scoped!r} is in MuJoCo's own format: actuators, tendons, sensors and settings of the "
                "engine are left out",
                model.where,
            )


def _world_joint(model: SceneModel, canonical: str) -> Iterable[Params]:
    """The joint that holds a model to the world that was asked to stand still."""
    ends = [text_element("parent", _WORLD), text_element("child", canonical)]
    taken = {j.name for j in model.joints} | {link.name for link in model.links}
    name = "fixed_to_world"
    while name in taken:
        name += "_"
    return (element("joint", "", ends, name=name, type="fixed"),)


def _name_inside(scoped: str, model: str) -> str:
    """A scoped name as it is written inside a model."""
    return scoped.removeprefix(f"{model}::") if model else scoped


def _person_element(look: PersonLook | None) -> Params | None:
    """The looks of a person of our own."""
    if look is None:
        return None
    height = [] if look.height is None else [text_element("height", look.height)]
    return element(
        written_name("person", "actor"), "", height + [text_element(k, numbers(v)) for k, v in look.colours.items()]
    )


def _links_of(models: Iterable[SceneModel]) -> dict[str, SceneLink]:
    return {link.scoped: link for m in models for link in m.all_links()}


def _needs_lenience(nodes: Iterable[Params]) -> bool:
    """Whether there are names that SDF 1.7 and later refuse."""
    stack = list(nodes)
    while stack:
        node = stack.pop()
        named = [c for c in node.children if c.name in _FRAMES]
        names = [c.attributes.get("name", "") for c in named]
        if len(set(names)) < len(names) or any("::" in n or n == _WORLD for n in names):
            return True
        stack += [c for c in node.children if c.name in ("model", "link", "joint")]
    return False

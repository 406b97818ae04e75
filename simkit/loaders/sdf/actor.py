"""Reader of `<actor>`: a person or animal that follows a script."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from simkit.loaders.resources.uris import is_small_integer
from simkit.loaders.sdf.entity_names import named_elements, scoped
from simkit.loaders.sdf.frames import Frame, Scope
from simkit.loaders.sdf.link import read_visuals
from simkit.loaders.sdf.load_context import EntitySource, NamedElement, Workspace
from simkit.loaders.sdf.plugin import read_plugins
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import Animation, PersonLook, SceneActor, SceneVisual, Trajectory, Waypoint

_LATEST: Final = 1e15  # [s]; the number of rows of later times overflows


def read_actor(source: EntitySource, pose_world: Pose, scope: Scope, workspace: Workspace) -> SceneActor:
    """Return an actor; its pose in the world is already known."""
    element, name = source.element, source.name
    element.child("pose")
    skin, script = element.block("skin"), element.block("script")
    return SceneActor(
        name=name,
        pose_world=pose_world,
        skin=skin.text("filename", ""),
        skin_scale=skin.number("scale", 1.0),
        animations=tuple(_animation(a) for a in element.all("animation")),
        trajectories=tuple(_trajectory(t) for t in script.all("trajectory")),
        loop=script.boolean("loop", True),
        delay_start=script.number("delay_start", 0.0, minimum=0.0),
        auto_start=script.boolean("auto_start", True),
        plugins=read_plugins(element.all("plugin"), name),
        where=element.where,
        person=_person(element.block("person")) if element.has("person") else None,
        visuals=() if element.has("skin") else tuple(_link_visuals(source, scope, workspace)),
    )


def _link_visuals(source: EntitySource, scope: Scope, workspace: Workspace) -> list[SceneVisual]:
    """Return the visuals of the links of an actor without a skin, with their poses in the actor's frame."""
    visuals: list[SceneVisual] = []
    links, owner = source.element.all("link"), f"actor {source.name!r}"
    for name, link in named_elements(links, owner, workspace.diagnostics, source.file.version, "left out"):
        pose, link_name = link.pose("pose"), scoped(source.name, name)
        part = NamedElement(
            name, link, Frame(name, "link", link_name, scope, pose, where=link.where), scope, source.file
        )
        for visual in read_visuals(part, link_name, workspace):
            own_name = visual.name if len(links) == 1 else f"{name}_{visual.name}"
            visuals.append(replace(visual, name=own_name, pose_link=pose @ visual.pose_link))
    return visuals


def _person(element: Params) -> PersonLook:
    height = element.number("height", minimum=0.3, maximum=3.0) if element.has("height") else None
    colours = {}
    for name in ("shirt", "trousers", "skin", "hair"):
        if element.has(name):
            colours[name] = element.vector3(name, (0.5, 0.5, 0.5))
    return PersonLook(height, colours)


def _animation(element: Params) -> Animation:
    return Animation(
        element.attribute("name"),
        element.text("filename", required=True),
        element.number("scale", 1.0),
        element.boolean("interpolate_x", False),
    )


def _trajectory(element: Params) -> Trajectory:
    number = element.attribute("id", "0").strip()
    if not is_small_integer(number.removeprefix("-")):
        element.error("SK-PARAM-002", f"found <trajectory id={number!r}>; expected a whole number")
        number = "0"
    points = [
        Waypoint(p.number("time", required=True, minimum=-_LATEST, maximum=_LATEST), p.pose("pose"))
        for p in element.all("waypoint")
    ]
    for before, after, waypoint in zip(points, points[1:], element.all("waypoint")[1:], strict=False):
        if after.time < before.time:
            waypoint.error("SK-PARAM-002", f"found a waypoint at {after.time:g} s after one at {before.time:g} s")
    tension = element.number("tension", 0.0, minimum=0.0, maximum=1.0)
    return Trajectory(int(number), element.attribute("type"), tuple(points), tension)

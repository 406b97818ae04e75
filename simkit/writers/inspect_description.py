"""Description of a resolved file as plain data, as `simkit inspect --json` prints it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, fields
from pathlib import Path

from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.run_spec import JsonObject
from simkit.scene import (
    Atmosphere,
    Axis,
    Geometry,
    Scene,
    SceneCollision,
    SceneFrame,
    SceneJoint,
    SceneLight,
    SceneLink,
    SceneModel,
    ScenePlugin,
    SceneSensor,
    SceneVisual,
    SceneWorld,
    SphericalCoordinates,
)

_SAME_KIND = {
    "wideanglecamera": "wide_angle_camera",
    "thermal": "thermal_camera",
    "segmentation": "segmentation_camera",
    "boundingbox": "boundingbox_camera",
}
SensorReader = Callable[[SceneSensor, Diagnostics], tuple[SceneSensor, JsonObject | None]]
"""Function that returns a sensor with the defaults of its preset, and its options (None for an unknown type)."""


def describe_scene(scene: Scene, diagnostics: Diagnostics, read_sensor: SensorReader) -> JsonObject:
    """Describe a scene as a dict of JSON values.

    Args:
        scene: loaded scene.
        diagnostics: diagnostics of loading; diagnostics of invalid sensor options are added.
        read_sensor: function that reads the options of a sensor.
    """
    worlds = [_world(w, diagnostics, read_sensor) for w in scene.worlds]
    model = None if scene.model is None else _model(scene.model, diagnostics, read_sensor)
    return {
        "worlds": worlds,
        "model": model,
        "totals": _totals(scene),
        "diagnostics": [d.as_dict() for d in diagnostics],
    }


def _block_of_unknown(sensor: SceneSensor) -> JsonObject:
    """Return the camera and scan options of a sensor type that simkit does not simulate."""
    block: JsonObject = {}
    camera = sensor.params.child("camera")
    if camera is not None:
        image, clip = camera.block("image"), camera.block("clip")
        block["camera"] = {
            "width": image.integer("width", 320, minimum=1),
            "height": image.integer("height", 240, minimum=1),
            "hfov": camera.number("horizontal_fov", 1.047, minimum=0.0),
            "near": clip.number("near", 0.1),
            "far": clip.number("far", 100.0),
        }
    lidar = sensor.params.child("lidar") or sensor.params.child("ray")
    if lidar is not None:
        scan, limits = lidar.block("scan"), lidar.block("range")
        block["lidar"] = {
            **_sweep("h", scan.block("horizontal"), 640),
            **_sweep("v", scan.block("vertical"), 1),
            "range_min": limits.number("min", 0.0),
            "range_max": _json_number(limits.number("max", 0.0, finite=False)),
        }
    return block


def _sweep(prefix: str, block: Params, samples: int) -> JsonObject:
    low, high = sorted((block.number("min_angle", 0.0), block.number("max_angle", 0.0)))
    return {
        f"{prefix}_samples": block.integer("samples", samples, minimum=1),
        f"{prefix}_min": low,
        f"{prefix}_max": high,
    }


def _world(world: SceneWorld, diagnostics: Diagnostics, read_sensor: SensorReader) -> JsonObject:
    return {
        "name": world.name,
        "gravity": list(world.gravity),
        "magnetic_field": list(world.magnetic_field),
        "wind": list(world.wind),
        "atmosphere": _numbers_of(world.atmosphere),
        "spherical_coordinates": _numbers_of(world.spherical_coordinates),
        "physics": {"max_step_size": world.physics.max_step_size, "real_time_factor": world.physics.real_time_factor},
        "models": [_model(m, diagnostics, read_sensor) for m in world.models],
        "lights": [_light(light) for light in world.lights],
        "frames": [_frame(f) for f in world.frames],
        "joints": [_joint(j, diagnostics, read_sensor) for j in world.joints],
        "plugins": [_plugin(p) for p in world.plugins],
    }


def _model(model: SceneModel, diagnostics: Diagnostics, read_sensor: SensorReader) -> JsonObject:
    return {
        "name": model.name,
        "scoped": model.scoped,
        "static": model.declared_static,
        "static_effective": model.static,
        "canonical_link_resolved": model.canonical_link.removeprefix(f"{model.scoped}::"),
        "pose_world": model.pose_world.as_list(),
        "links": [_link(link, diagnostics, read_sensor) for link in model.links],
        "joints": [_joint(j, diagnostics, read_sensor) for j in model.joints],
        "frames": [_frame(f) for f in model.frames],
        "plugins": [_plugin(p) for p in model.plugins],
        "models": [_model(m, diagnostics, read_sensor) for m in model.models],
    }


def _link(link: SceneLink, diagnostics: Diagnostics, read_sensor: SensorReader) -> JsonObject:
    return {
        "name": link.name,
        "pose_world": link.pose_world.as_list(),
        "mass": link.inertial.mass,
        "com_world": [float(v) for v in link.pose_world.transform(link.inertial.com)],
        "inertia_com_linkframe": list(link.inertial.inertia),
        "collisions": [_shape(c) for c in link.collisions],
        "visuals": [_shape(v) for v in link.visuals],
        "sensors": [_sensor(s, diagnostics, read_sensor) for s in link.sensors],
        "lights": [_light(light) for light in link.lights],
    }


def _shape(shape: SceneCollision | SceneVisual) -> JsonObject:
    return {"name": shape.name, "pose_link": shape.pose_link.as_list(), "geom": _geometry(shape.geometry)}


def _geometry(geometry: Geometry) -> JsonObject:
    sizes = {f.name: _plain(getattr(geometry, f.name)) for f in fields(geometry)}
    return {"type": type(geometry).__name__.lower(), **sizes}


def _plain(value: object) -> object:
    if isinstance(value, tuple):
        return [_plain(v) for v in value]
    if isinstance(value, float):
        return _json_number(value)
    return str(value) if isinstance(value, Path) else value


def _sensor(named: SceneSensor, diagnostics: Diagnostics, read_sensor: SensorReader) -> JsonObject:
    sensor, details = read_sensor(named, diagnostics)
    return {
        "name": sensor.name,
        "type": _SAME_KIND.get(sensor.kind, sensor.kind),
        "update_rate": sensor.rate,
        "topic": sensor.topic,
        "pose_world": sensor.pose_world.as_list(),
        **(_block_of_unknown(sensor) if details is None else details),
    }


def _joint(joint: SceneJoint, diagnostics: Diagnostics, read_sensor: SensorReader) -> JsonObject:
    mimic = next((a.mimic for a in joint.axes if a.mimic is not None), None)
    return {
        "name": joint.name,
        "type": joint.type,
        "parent_link": joint.parent_link,
        "child_link": joint.child_link,
        "pose_world": joint.pose_world.as_list(),
        "axes": [_axis(a) for a in joint.axes],
        "mimic": None if mimic is None else asdict(mimic),
        "sensors": [_sensor(s, diagnostics, read_sensor) for s in joint.sensors],
    }


def _axis(axis: Axis) -> JsonObject:
    limits = ("lower", "upper", "effort", "velocity")
    rest = ("damping", "friction", "stiffness", "spring_ref")
    numbers = {name: _json_number(getattr(axis, name)) for name in (*limits, *rest)}
    return {"xyz_world": list(axis.xyz_world), **numbers}


def _numbers_of(settings: Atmosphere | SphericalCoordinates | None) -> JsonObject | None:
    """Return settings in the units of the scene; angles in rad."""
    if settings is None:
        return None
    return {f.name: _plain(getattr(settings, f.name)) for f in fields(settings) if f.name != "where"}


def _frame(frame: SceneFrame) -> JsonObject:
    return {"name": frame.name, "pose_world": frame.pose_world.as_list(), "attached_to": frame.attached_to}


def _light(light: SceneLight) -> JsonObject:
    return {
        "name": light.name,
        "type": light.type,
        "pose_world": light.pose_world.as_list(),
        "direction": list(light.direction),
        "cast_shadows": light.cast_shadows,
    }


def _plugin(plugin: ScenePlugin) -> JsonObject:
    return {"name": plugin.name, "filename": plugin.filename}


def _json_number(value: float) -> float | str:
    """Convert infinities to the texts `inf` and `-inf`, because JSON has no infinity."""
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return value


def _totals(scene: Scene) -> JsonObject:
    tops = [m for w in scene.worlds for m in w.models] + ([scene.model] if scene.model is not None else [])
    models = [m for top in tops for m in top.all_models()]
    links = [link for m in models for link in m.links]
    joints = [j for m in models for j in m.joints] + [j for w in scene.worlds for j in w.joints]
    owners: list[SceneLink | SceneJoint] = [*links, *joints]
    sensors = [s for owner in owners for s in owner.sensors]
    lights = [li for w in scene.worlds for li in w.lights] + [li for link in links for li in link.lights]
    visuals = [visual for link in links for visual in link.visuals]
    carriers: list[SceneModel | SceneLink | SceneJoint | SceneSensor | SceneVisual]
    carriers = [*models, *owners, *sensors, *visuals]
    owned = [p for carrier in carriers for p in carrier.plugins]
    return {
        "models": len(models),
        "links": len(links),
        "joints": len(joints),
        "collisions": sum(len(link.collisions) for link in links),
        "visuals": len(visuals),
        "sensors": len(sensors),
        "lights": len(lights) + (scene.light is not None),
        "plugins": len(owned) + sum(len(w.plugins) for w in scene.worlds),
        "mass": math.fsum(link.inertial.mass for link in links),
    }

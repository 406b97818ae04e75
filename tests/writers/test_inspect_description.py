"""Output of `simkit inspect --json`."""

from __future__ import annotations

import json
import math

import pytest

from simkit.build import describe_sensor
from simkit.diagnostics import Diagnostics
from simkit.loaders import Resolver, load_scene
from simkit.writers.inspect_description import describe_scene

MODEL = """<sdf version="1.9"><model name="m"><link name="a"/><link name="b"><inertial><mass>2</mass></inertial>
<visual name="v"><geometry><capsule><radius>0.1</radius><length>0.5</length></capsule></geometry></visual>
<sensor name="s" type="altimeter"/></link><joint name="j" type="revolute"><parent>a</parent><child>b</child>
<axis><xyz>0 1 0</xyz><limit><lower>-1</lower></limit></axis></joint></model></sdf>"""


def described(text: str) -> dict:
    diagnostics = Diagnostics()
    scene = load_scene(text, resolver=Resolver(), diagnostics=diagnostics)
    return describe_scene(scene, diagnostics, lambda sensor, found: (sensor, {"block": sensor.kind}))


def test_a_bare_model_is_plain_data_with_totals():
    out = json.loads(json.dumps(described(MODEL), allow_nan=False))
    assert out["worlds"] == []
    assert out["totals"] == {
        "models": 1, "links": 2, "joints": 1, "collisions": 0, "visuals": 1,
        "sensors": 1, "lights": 0, "plugins": 0, "mass": 3.0,
    }  # fmt: skip
    model = out["model"]
    assert (model["name"], model["static"], model["canonical_link_resolved"]) == ("m", False, "a")
    assert model["pose_world"] == [0, 0, 0, 1, 0, 0, 0]
    link = model["links"][1]
    assert link["visuals"][0]["geom"] == {"type": "capsule", "radius": 0.1, "length": 0.5}
    assert link["sensors"][0]["block"] == "altimeter"


def test_infinite_limits_are_texts():
    axis = described(MODEL)["model"]["joints"][0]["axes"][0]
    assert (axis["lower"], axis["upper"], axis["effort"]) == (-1.0, "inf", "inf")
    assert axis["xyz_world"] == [0, 1, 0]


def test_a_world_lists_lights_and_diagnostics():
    out = described(
        '<sdf version="1.9"><world name="w"><lihgt/><include><uri>model://sun</uri></include></world></sdf>'
    )
    world = out["worlds"][0]
    assert (world["name"], world["gravity"], world["physics"]["max_step_size"]) == ("w", [0, 0, -9.8], 0.001)
    assert [(light["name"], light["type"], light["cast_shadows"]) for light in world["lights"]] == [
        ("sun", "directional", True)
    ]
    assert [(d["code"], d["severity"], d["hint"]) for d in out["diagnostics"]] == [
        ("SK-SDF-011", "warning", "did you mean 'light'?")
    ]


def test_a_world_lists_its_surroundings():
    world = described(
        """<sdf version="1.9"><world name="w"><magnetic_field>1e-5 2e-5 3e-5</magnetic_field>
        <wind><linear_velocity>1 2 0</linear_velocity></wind>
        <atmosphere type="adiabatic"><temperature>290</temperature><pressure>90000</pressure></atmosphere>
        <spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>45</latitude_deg>
        <longitude_deg>90</longitude_deg><elevation>400</elevation><heading_deg>0</heading_deg>
        </spherical_coordinates></world></sdf>"""
    )["worlds"][0]
    assert (world["magnetic_field"], world["wind"]) == ([1e-5, 2e-5, 3e-5], [1, 2, 0])
    assert (world["atmosphere"]["temperature"], world["atmosphere"]["pressure"]) == (290, 90000)
    place = world["spherical_coordinates"]
    assert (place["latitude"], place["elevation"]) == (pytest.approx(math.pi / 4), 400)
    assert described('<sdf version="1.9"><world name="w"/></sdf>')["worlds"][0]["spherical_coordinates"] is None


def test_an_unsimulated_sensor_type_shows_its_camera_and_scan_options():
    diagnostics = Diagnostics()
    text = """<sdf version="1.9"><model name="m"><link name="l">
      <sensor name="eye" type="odd_camera"><camera><horizontal_fov>2</horizontal_fov>
        <image><width>640</width><height>480</height></image><clip><near>0.2</near><far>9</far></clip></camera></sensor>
      <sensor name="old" type="odd_lidar"><ray><scan><horizontal><samples>5</samples><min_angle>-1</min_angle>
        <max_angle>1</max_angle></horizontal></scan><range><min>0.1</min><max>inf</max></range></ray></sensor>
      </link></model></sdf>"""
    found = describe_scene(load_scene(text, resolver=Resolver(), diagnostics=diagnostics), diagnostics, describe_sensor)
    eye, old = found["model"]["links"][0]["sensors"]
    assert eye["camera"] == {"width": 640, "height": 480, "hfov": 2.0, "near": 0.2, "far": 9.0}
    scan = {"h_samples": 5, "h_min": -1.0, "h_max": 1.0, "v_samples": 1, "v_min": 0.0, "v_max": 0.0}
    assert old["lidar"] == {**scan, "range_min": 0.1, "range_max": "inf"}

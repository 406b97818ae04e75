"""Presets: each preset loads, a file takes precedence, wrong names are errors, and the page agrees with the data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sensor_worlds import box, cloud, sensor, world

import simkit
from simkit.diagnostics import NOWHERE, Diagnostics
from simkit.params import Params
from simkit.sensors import sensor_kinds
from simkit.sensors.artefacts import artefact_elements
from simkit.sensors.presets import Preset, find, preset_defaults, presets
from simkit.sensors.presets.preset import TIMING_ELEMENTS, outline
from simkit.sensors.presets.preset_page import describe_preset, presets_page

PAGE = Path(__file__).resolve().parents[3] / "docs" / "sensors" / "presets.md"
PLACE = """<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>47</latitude_deg>
  <longitude_deg>8</longitude_deg><elevation>400</elevation><heading_deg>0</heading_deg></spherical_coordinates>"""


def named(preset: str, kind: str, extra: str = "") -> str:
    return f'<sensor name="s" type="{kind}"><preset>{preset}</preset>{extra}</sensor>'


def world_of(kind: str, inside: str) -> str:
    """Return a world with everything that a sensor of the kind needs."""
    top = PLACE if kind == "navsat" else ""
    if "link" in sensor_kinds()[kind].belongs_to:
        return world(inside, top=top)
    inertial = "<inertial><mass>1</mass></inertial>"
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="m">
      <link name="base">{inertial}</link><link name="arm">{inertial}</link>
      <joint name="j" type="revolute"><parent>base</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis>
      {inside}</joint></model></world></sdf>"""


def load(text: str) -> Any:
    return simkit.load(text, seed=3)


def the_sensor(sim: Any) -> Any:
    return sim.sensor("m::l::s" if "m::l" in {link.scoped for link in sim.world.models[0].links} else "m::j::s")


def leaves(settings: Mapping[str, Any], path: tuple[str, ...] = ()) -> list[tuple[tuple[str, ...], Any]]:
    found: list[tuple[tuple[str, ...], Any]] = []
    for name, value in settings.items():
        found += leaves(value, (*path, name)) if isinstance(value, Mapping) else [((*path, name), value)]
    return found


KNOWN = [p for p in presets() if p.kind in sensor_kinds()]


@pytest.mark.parametrize("preset", KNOWN, ids=lambda p: f"{p.kind}-{p.name}")
def test_every_preset_loads_with_only_its_note_and_reads(preset: Preset) -> None:
    with load(world_of(preset.kind, named(preset.name, preset.kind))) as sim:
        spoken = [d for d in sim.diagnostics if "m::" in d.message]
        assert [d.code for d in spoken if d.severity != "note"] == []
        notes = [d for d in spoken if d.code == "SK-SENSOR-092"]
        assert len(notes) == 1
        unknown = {name for name in preset.beside if name not in {*TIMING_ELEMENTS, *artefact_elements()}}
        assert outline({n: v for n, v in preset.elements.items() if n not in unknown}) in notes[0].message
        assert ("SK-SENSOR-265" in {d.code for d in spoken}) is bool(unknown)
        assert preset.source == notes[0].hint
        device = the_sensor(sim)
        assert device.update_rate == preset.rate
        if preset.rate:
            sim.run(2.5 / preset.rate)
        sim.step(2)
        assert device.latest is not None


@pytest.mark.parametrize("preset", presets(), ids=lambda p: f"{p.kind}-{p.name}")
def test_a_preset_is_complete(preset: Preset) -> None:
    assert preset.maker and len(preset.source) > 15
    assert preset.block in preset.settings
    for path, value in leaves(preset.elements):
        for item in np.ravel(value).tolist():
            assert isinstance(item, (int, float, bool, str)), path
            if isinstance(item, float):
                assert math.isfinite(item)
    for name in (preset.name, *preset.aliases):
        assert find(name.lower().replace("-", " "))[preset.kind] is preset


@pytest.mark.parametrize("preset", presets(), ids=lambda p: f"{p.kind}-{p.name}")
def test_unconfirmed_elements_exist_and_are_marked_in_descriptions(preset: Preset) -> None:
    paths = [set(path) for path, _ in leaves(preset.elements)]
    for names in preset.unconfirmed:
        assert any(set(names.split()) <= path for path in paths)
    mark = f"unconfirmed: {', '.join(preset.unconfirmed)}"
    assert (mark in describe_preset(preset)) is bool(preset.unconfirmed)


def test_the_page_marks_bands_used_as_deviations() -> None:
    """A preset that uses an accuracy of ±x as a standard deviation says in its remark that this is our choice."""
    for preset in presets():
        if "deviation: " in preset.remark:
            assert "deviation: our choice" in preset.remark, preset.name
    assert "our choice" in presets_page() and "*unconfirmed*: " in presets_page()


def test_the_lidars_of_ouster_are_of_one_revision() -> None:
    seen = {p.name: p.settings["lidar"]["range"] for p in presets() if p.maker == "Ouster"}
    assert len(seen) == 6
    for name, reach in seen.items():
        assert reach == {"min": 0.3, "max": 45.0 if name.startswith("OS0") else 100.0}
        assert "Rev 06" in find(name)["lidar"].source


def test_all_kinds_that_have_presets_are_there() -> None:
    assert {p.kind for p in presets()} - set(sensor_kinds()) == set()
    assert len(presets()) >= 40


def test_a_lidar_gets_its_numbers_in_every_spelling_of_its_kind() -> None:
    for kind in ("lidar", "ray", "gpu_lidar", "gpu_ray"):
        with load(world(named("LDS-01", kind))) as sim:
            device = sim.sensor("m::l::s")
            assert device.update_rate == 5.0
            o = device.options
            assert (o.range_min, o.range_max, o.noise.stddev) == (0.12, 3.5, 0.01)
            assert o.horizontal.samples == 360
            assert o.horizontal.step == pytest.approx(math.radians(1), abs=1e-8)


@pytest.mark.parametrize("block", ["lidar", "ray"])
def test_each_element_of_the_file_takes_precedence(block: str) -> None:
    own = f"""<update_rate>20</update_rate><{block}><range><max>2</max></range>
      <scan><horizontal><samples>90</samples></horizontal></scan></{block}>"""
    with load(world(named("LDS-01", "ray", own))) as sim:
        device, o = sim.sensor("m::l::s"), sim.sensor("m::l::s").options
        assert device.update_rate == 20
        assert (o.range_min, o.range_max, o.horizontal.samples, o.noise.stddev) == (0.12, 2.0, 90, 0.01)
        (note,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-092"]
        assert "min 0.12" in note.message
        assert "max 3.5" not in note.message
        assert "update_rate" not in note.message
        assert [d for d in sim.diagnostics if d.severity == "warning"] == []


def test_the_prefix_and_a_rate_of_zero_in_the_file_are_supported() -> None:
    text = world(
        '<sensor name="s" type="lidar"><simkit:preset>tim 571</simkit:preset><update_rate>0</update_rate></sensor>'
    )
    text = text.replace("<sdf ", '<sdf xmlns:simkit="simkit" ')
    with load(text) as sim:
        assert sim.sensor("m::l::s").update_rate == 0
        assert sim.sensor("m::l::s").options.range_max == 25


def imu_noise(own: str) -> Any:
    block = f"<imu><angular_velocity><x>{own}</x></angular_velocity></imu>"
    with load(world(named("ADIS16470", "imu", block))) as sim:
        assert [d.code for d in sim.diagnostics if d.severity == "warning"] == []
        return sim.sensor("m::l::s").options.angular_velocity


def test_a_deviation_of_the_file_replaces_the_presets_density() -> None:
    x, y, _ = imu_noise('<noise type="gaussian"><stddev>0.5</stddev></noise>')
    assert (x.stddev, x.noise_density) == (0.5, 0.0)
    assert x.bias_instability == y.bias_instability > 0
    assert y.noise_density == pytest.approx(math.radians(0.008), rel=1e-5)


def test_a_density_of_the_file_is_kept_and_the_type_comes_from_the_preset() -> None:
    x, y, _ = imu_noise("<noise><noise_density>0.25</noise_density></noise>")
    assert (x.noise_density, x.bias_instability) == (0.25, y.bias_instability)


def test_no_noise_in_the_file_is_no_noise() -> None:
    x, y, _ = imu_noise('<noise type="none"/>')
    assert (x.noise_density, x.bias_instability) == (0.0, 0.0)
    assert y.noise_density > 0


def test_an_encoder_with_a_resolution_of_its_own_takes_no_counts() -> None:
    own = "<encoder><resolution>0.001</resolution></encoder>"
    with load(world_of("encoder", named("AS5048A", "encoder", own))) as sim:
        assert sim.sensor("m::j::s").options.resolution == 0.001
        assert sim.sensor("m::j::s").options.position_noise.stddev == pytest.approx(math.radians(0.06), rel=1e-5)


@pytest.mark.parametrize(
    ("preset", "kind", "code", "hint"),
    [
        ("BMI808", "imu", "SK-SENSOR-090", "'BMI088'"),
        ("LDS-1", "lidar", "SK-SENSOR-090", "'LDS-01'"),
        ("", "imu", "SK-SENSOR-090", "BMI088"),
        ("VLP-16", "imu", "SK-SENSOR-091", "BMI088"),
        ("BMI088", "gpu_lidar", "SK-SENSOR-091", "VLP-16"),
    ],
)
def test_a_wrong_name_is_an_error_with_the_closest(preset: str, kind: str, code: str, hint: str) -> None:
    block = "<lidar><range><max>1</max></range></lidar>" if "lidar" in kind else ""
    with pytest.raises(simkit.LoadError) as caught:
        load(world(named(preset, kind, block)))
    (error,) = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert (error.code, error.line) == (code, error.line)
    assert error.line is not None
    assert hint in error.hint


def test_unread_elements_are_still_reported() -> None:
    with load(world(named("BMI088", "imu", "<imu><angular_velocty/></imu>"))) as sim:
        (warning,) = [d for d in sim.diagnostics if d.code == "SK-PARAM-003"]
        assert "angular_velocty" in warning.message


def test_inspect_shows_the_numbers() -> None:
    described = simkit.describe(world(named("VLP-16", "gpu_lidar")))
    shown = described["worlds"][0]["models"][0]["links"][0]["sensors"][0]
    assert shown["update_rate"] == 10
    assert (shown["lidar"]["v_samples"], shown["lidar"]["range_max"]) == (16, 100)
    assert "SK-SENSOR-092" in {d["code"] for d in described["diagnostics"]}


def test_a_vlp_16_has_16_rings_from_15_degrees_below_to_15_above() -> None:
    with load(world(named("VLP-16", "lidar"), others=box("b", "0 0 0 0 0 0", "40 40 0.1"))) as sim:
        device = sim.sensor("m::l::s")
        points = sim.subscribe(device.topic + "/points")
        sim.run(0.2)
        rings = cloud(points.latest)
        assert rings.shape == (16, 1800)
        assert rings["ring"][:, 0].tolist() == list(range(16))
        angles = np.degrees(device.options.vertical.angles)
        np.testing.assert_allclose(angles, np.arange(-15, 16, 2), atol=1e-5)
        # the ground 0.95 m below: the lowest ring meets it 3.55 m away
        low = np.hypot(rings["x"][0], rings["y"][0])
        assert low.mean() == pytest.approx(0.95 / math.tan(math.radians(15)), abs=0.01)


def test_the_white_noise_of_an_imu_is_density_by_the_root_of_its_rate() -> None:
    with load(world(named("BMI088", "imu", "<update_rate>400</update_rate>"))) as sim:
        sub = sim.subscribe(sim.sensor("m::l::s").topic)
        sim.run(5.0)
        rates = np.array([m.angular_velocity.x for m in sub.messages])
        assert rates.std() == pytest.approx(math.radians(0.014) * 20, rel=0.06)


def test_a_preset_can_be_chosen_on_the_command_line() -> None:
    lidar = sensor("lidar", "<preset>LDS-01</preset>", rate=7)
    with simkit.load(world(lidar), overrides=["m::l::s.preset=LDS-02", "m::l::s.lidar.range.min=0.3"]) as sim:
        o = sim.sensor("m::l::s").options
        assert (o.range_min, o.range_max, sim.sensor("m::l::s").update_rate) == (0.3, 8.0, 7.0)


def preset_with(monkeypatch: pytest.MonkeyPatch, **beside: Any) -> None:
    """Give LDS-01 these elements beside its block, and no others."""
    device = find("LDS-01")["lidar"]
    settings = {"lidar": device.settings["lidar"], **beside}
    changed = replace(device, settings=settings)
    monkeypatch.setattr(preset_defaults, "find", lambda name: {"lidar": changed})


@pytest.mark.needs_packs
def test_a_preset_sets_elements_beside_the_block(monkeypatch: pytest.MonkeyPatch) -> None:
    preset_with(monkeypatch, latency=0.05, dropout={"probability": 1.0})
    with load(world(named("LDS-01", "lidar"), others=box("b", "2 0 0 0 0 0", "1 40 4"))) as sim:
        device = sim.sensor("m::l::s")
        assert device.timing.latency == 0.05
        (note,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-092"]
        assert "latency 0.05, dropout probability 1" in note.message
        sim.run(0.5)
        assert np.isinf(device.latest.ranges).all()
        assert np.isfinite(device.truth.ranges).any()


def test_an_element_of_the_file_beside_the_block_replaces_the_presets(monkeypatch: pytest.MonkeyPatch) -> None:
    preset_with(monkeypatch, dropout={"probability": 1.0})
    own = named("LDS-01", "lidar", "<dropout/>")
    with load(world(own, others=box("b", "2 0 0 0 0 0", "1 40 4"))) as sim:
        sim.run(0.5)
        assert np.isfinite(sim.sensor("m::l::s").latest.ranges).any()


def test_without_its_pack_an_element_is_left_out_with_a_note(monkeypatch: pytest.MonkeyPatch) -> None:
    preset_with(monkeypatch, latency=0.05, element_of_a_pack={"probability": 0.5})
    with load(world(named("LDS-01", "lidar"))) as sim:
        assert sim.sensor("m::l::s").timing.latency == 0.05
        (note,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-265"]
        assert "<element_of_a_pack>" in note.message
        assert [d for d in sim.diagnostics if d.severity == "warning"] == []


def test_a_list_is_a_row_and_a_list_of_tables_is_repeated_elements() -> None:
    merge = preset_defaults._Merge(NOWHERE, Diagnostics())
    params = merge.merged(Params("sensor"), {"gaps": {"frames": [1, 2.5]}, "zone": [{"near": 1}, {"near": 2}]}, {})
    assert params.block("gaps").block("frames").value == "1 2.5"
    assert [zone.number("near") for zone in params.all("zone")] == [1, 2]


def test_a_spawned_robot_has_its_preset() -> None:
    link = f'<link name="l">{named("LDS-02", "lidar")}</link>'
    robot = f'<sdf version="1.9"><model name="r"><static>true</static>{link}</model></sdf>'
    with load(world("")) as sim:
        sim.spawn(robot)
        assert sim.sensor("r::l::s").options.range_max == 8.0


def test_a_urdf_names_one_in_its_gazebo_block() -> None:
    robot = f"""<robot name="r"><link name="base"><inertial><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <gazebo reference="base">{named("LDS-01", "ray")}</gazebo></robot>"""
    with load(robot) as sim:
        assert sim.sensor("r::base::s").options.range_max == 3.5


def test_the_settings_are_the_elements_of_a_file() -> None:
    """Settings have the form that `Params.from_dict` reads."""
    elements = find("LDS-01")["lidar"].elements
    block = Params.from_dict(dict(elements)).block("lidar").block("range")
    assert block.number("max") == 3.5


def test_the_page_agrees_with_the_data() -> None:
    """The command `python -m simkit.sensors.presets > docs/sensors/presets.md` writes the page."""
    assert PAGE.read_text(encoding="utf-8") == presets_page()


def test_one_preset_is_described() -> None:
    text = describe_preset(find("puck")["lidar"])
    assert "VLP-16 (Velodyne)" in text
    assert "also:   Puck" in text
    assert "samples 16" in text

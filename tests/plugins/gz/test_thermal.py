"""Thermal and ThermalSensor of Gazebo: temperatures of visuals, and reports about plugins without effect."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import simkit
from simkit.runtime.handles.visual import HeatSignature

BALL = "<geometry><sphere><radius>0.1</radius></sphere></geometry>"
KELVIN = "<temperature>{}</temperature>"


def thermal(content: str, name: str = "gz::sim::systems::Thermal", filename: str = "gz-sim-thermal-system") -> str:
    return f'<plugin filename="{filename}" name="{name}">{content}</plugin>'


def world(visual: str = "", *, link: str = "", model: str = "", nested: str = "", top: str = "") -> str:
    return f"""<sdf version="1.9" xmlns:simkit="https://simkit.invalid"><world name="w">{top}<model name="m">
      <static>true</static><link name="l"><visual name="v">{BALL}{visual}</visual><visual name="w">{BALL}</visual>{link}
      </link>{model}<model name="n"><link name="k"><visual name="v">{BALL}</visual></link>{nested}</model></model>
      </world></sdf>"""


def warnings(sim: Any) -> list[str]:
    return [d.code for d in sim.diagnostics if d.severity != "note"]


def test_a_visual_gets_the_temperature_of_its_plugin() -> None:
    with simkit.load(world(thermal(KELVIN.format(310.5)))) as sim:
        assert dict(sim.contents.temperatures) == {"m::l::v": 310.5}
        assert sim.contents.temperatures.by_visual() == {"m::l::v": 310.5}
        assert not warnings(sim)


@pytest.mark.parametrize(
    ("filename", "name"),
    [
        ("gz-sim-thermal-system", "gz::sim::systems::Thermal"),
        ("ignition-gazebo-thermal-system", "ignition::gazebo::systems::Thermal"),
        ("libgz-sim8-thermal-system.so", "gz::sim::v8::systems::Thermal"),
    ],
)
def test_older_names_load_the_same_plugin(filename: str, name: str) -> None:
    with simkit.load(world(thermal(KELVIN.format(300), name, filename))) as sim:
        assert dict(sim.contents.temperatures) == {"m::l::v": 300.0}


def test_the_temperature_of_a_link_or_model_applies_to_visuals_without_one() -> None:
    def parts(link: str, model: str, nested: str) -> str:
        return world(thermal(KELVIN.format(1)), link=link, model=model, nested=nested)

    on = [thermal(KELVIN.format(t)) for t in (2, 3, 4)]
    with simkit.load(parts(*on)) as sim:
        assert sim.contents.temperatures.by_visual() == {"m::l::v": 1, "m::l::w": 2, "m::n::k::v": 4}
    with simkit.load(parts("", on[1], "")) as sim:
        assert sim.contents.temperatures.by_visual() == {"m::l::v": 1, "m::l::w": 3, "m::n::k::v": 3}


def test_with_gazebo_quirks_only_plugins_on_visuals_count() -> None:
    text = world(model=thermal(KELVIN.format(300)), top="<simkit:gazebo_quirks>true</simkit:gazebo_quirks>")
    with simkit.load(text) as sim:
        assert not sim.contents.temperatures
        assert warnings(sim) == ["SK-SENSOR-141"]


def test_temperatures_below_absolute_zero_are_clamped() -> None:
    with simkit.load(world(thermal(KELVIN.format(-10)))) as sim:
        assert sim.contents.temperatures["m::l::v"] == 0
        assert warnings(sim) == ["SK-SENSOR-141"]


@pytest.mark.parametrize(
    ("content", "code"),
    [("", "SK-PARAM-001"), (KELVIN.format("hot"), "SK-PARAM-002"), (KELVIN.format("inf"), "SK-PARAM-002")],
)
def test_an_invalid_temperature_is_an_error(content: str, code: str) -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(thermal(content)))
    assert code in [d.code for d in caught.value.diagnostics]


# ---------------------------------------------------------------------- heat signatures


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    models = tmp_path / "models" / "randy"
    (models / "textures").mkdir(parents=True)
    cv2.imwrite(str(models / "textures" / "warm.png"), np.zeros((4, 4, 3), np.uint8))
    (models / "model.config").write_text('<model><name>randy</name><sdf version="1.9">model.sdf</sdf></model>')
    return tmp_path


RANGE = "<min_temp>290</min_temp><max_temp>310</max_temp>"


def test_a_heat_signature_next_to_the_model_file_is_found(folder: Path) -> None:
    plugin = thermal(f"<heat_signature>textures/warm.png</heat_signature>{RANGE}")
    model = f"""<sdf version="1.9"><model name="randy"><link name="l"><visual name="v">{BALL}{plugin}</visual></link>
      </model></sdf>"""
    (folder / "models" / "randy" / "model.sdf").write_text(model)
    text = '<sdf version="1.9"><world name="w"><include><uri>model://randy</uri></include></world></sdf>'
    with simkit.load(text, resource_paths=[folder / "models"]) as sim:
        picture = folder / "models" / "randy" / "textures" / "warm.png"
        assert dict(sim.contents.temperatures) == {"randy::l::v": HeatSignature(picture, 290, 310)}
        sim.spawn(folder / "models" / "randy" / "model.sdf", name="second")
        assert sim.contents.temperatures["second::l::v"] == sim.contents.temperatures["randy::l::v"]


def test_a_heat_signature_can_be_given_by_a_uri(folder: Path) -> None:
    plugin = thermal(f"<heat_signature>model://randy/textures/warm.png</heat_signature>{RANGE}")
    with simkit.load(world(plugin), resource_paths=[folder / "models"]) as sim:
        assert isinstance(sim.contents.temperatures["m::l::v"], HeatSignature)
        assert not warnings(sim)


def test_without_a_readable_heat_signature_the_surface_has_the_temperature_of_the_air(folder: Path) -> None:
    (folder / "text.png").write_text("warm")
    for name in ("no.png", "text.png", "model://nobody/warm.png"):
        (folder / "w.sdf").write_text(world(thermal(f"<heat_signature>{name}</heat_signature>")))
        with simkit.load(folder / "w.sdf") as sim:
            assert not sim.contents.temperatures
            assert warnings(sim) == ["SK-SENSOR-142"]


def test_a_heat_signature_overrides_a_temperature(folder: Path) -> None:
    both = "<temperature>400</temperature><heat_signature>models/randy/textures/warm.png</heat_signature>"
    (folder / "w.sdf").write_text(world(thermal(f"{both}<min_temp>310</min_temp><max_temp>290</max_temp>")))
    with simkit.load(folder / "w.sdf") as sim:
        found = sim.contents.temperatures["m::l::v"]
        assert isinstance(found, HeatSignature)
        assert (found.coldest, found.hottest) == (290, 310)
        assert warnings(sim) == ["SK-SENSOR-141"] * 2  # of both elements, and of the ends in the wrong order


# ---------------------------------------------------------------------- the table


def test_temperatures_survive_spawn_remove_reset_and_snapshots() -> None:
    with simkit.load(world(thermal(KELVIN.format(310)))) as sim:
        kept = sim.snapshot()
        sim.spawn(f"""<sdf version="1.9"><model name="x"><static>true</static><link name="l"><visual name="v">{BALL}
          {thermal(KELVIN.format(320))}</visual></link></model></sdf>""")
        assert sim.contents.temperatures["x::l::v"] == 320
        later = sim.snapshot()
        sim.remove("x")
        assert dict(sim.contents.temperatures) == {"m::l::v": 310}
        sim.remove("m")
        assert not sim.contents.temperatures
        sim.restore(later)
        assert dict(sim.contents.temperatures) == {"m::l::v": 310, "x::l::v": 320}
        sim.contents.temperatures["m::l::v"] = 5
        sim.restore(kept)
        assert dict(sim.contents.temperatures) == {"m::l::v": 310}
        sim.contents.temperatures["m"] = 5
        sim.reset()
        assert dict(sim.contents.temperatures) == {"m::l::v": 310}


def test_a_wrong_name_or_temperature_is_reported() -> None:
    with simkit.load(world()) as sim:
        with pytest.raises(KeyError, match="m::l::v"):
            sim.contents.temperatures["m::l::vv"] = 300
        with pytest.raises(ValueError, match="at least 0"):
            sim.contents.temperatures["m"] = -1
        with pytest.raises(ValueError, match="at least 0"):
            sim.contents.temperatures["m"] = float("nan")


# ---------------------------------------------------------------------- the sensor's plugin


def test_the_sensors_plugin_belongs_on_a_thermal_camera() -> None:
    plugin = thermal("<resolution>1</resolution>", "gz::sim::systems::ThermalSensor", "gz-sim-thermal-sensor-system")
    text = f"""<sdf version="1.9"><world name="w"><model name="m"><static>true</static><link name="l">
      <sensor name="s" type="imu">{plugin}</sensor></link></model></world></sdf>"""
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(text)
    assert [d.code for d in caught.value.diagnostics if d.severity == "error"] == ["SK-PLUGIN-003"]


@pytest.mark.needs_packs
def test_the_sensors_plugin_sets_range_and_resolution() -> None:
    content = "<min_temp>253.15</min_temp><max_temp>673.15</max_temp><resolution>3.0</resolution>"
    plugin = thermal(content, "gz::sim::systems::ThermalSensor", "gz-sim-thermal-sensor-system")
    text = f"""<sdf version="1.9"><world name="w"><model name="m"><static>true</static><link name="l">
      <sensor name="s" type="thermal"><camera/>{plugin}</sensor></link></model></world></sdf>"""
    with simkit.load(text) as sim:
        options = sim.sensor("m::l::s").options
        assert (options.coldest, options.hottest, options.resolution) == (253.15, 673.15, 3.0)
        assert not warnings(sim)

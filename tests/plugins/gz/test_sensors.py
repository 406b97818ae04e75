"""Sensors system of Gazebo: the colours of camera images, and the reports about its other parameters."""

from __future__ import annotations

from typing import Any

import pytest

import simkit

SCENE = "<scene><ambient>0.1 0.1 0.1 1</ambient><background>0.2 0.2 0.2 1</background></scene>"
FILE = "gz-sim-sensors-system"


def sensors(parameters: str, file: str = FILE, name: str = "gz::sim::systems::Sensors") -> str:
    return f"<plugin filename='{file}' name='{name}'>{parameters}</plugin>"


def world(*parts: str) -> str:
    return f"<sdf version='1.9'><world name='w'>{''.join(parts)}</world></sdf>"


def robot(plugin: str) -> str:
    return f"<model name='m'><static>true</static><link name='l'/>{plugin}</model>"


COLOURS = "<background_color>0.25 0.5 0.75</background_color><ambient_light>0.5 0.4 0.3 1</ambient_light>"


def colours_and_reports(text: str, *overrides: str) -> tuple[Any, Any, list[tuple[str, str]]]:
    """Return background, ambient light, and the diagnostics about the plugin."""
    with simkit.load(text, overrides=overrides) as sim:
        around = sim.world.surroundings
        assert tuple(sim.mj_model.vis.headlight.ambient) == pytest.approx(around.ambient[:3])
        reports = [(d.code, d.message) for d in sim.diagnostics if "Sensors" in d.message]
        return around.background[:3], around.ambient[:3], reports


@pytest.mark.parametrize("text", [world(SCENE, sensors(COLOURS)), world(SCENE, robot(sensors(COLOURS)))])
def test_its_colours_override_those_of_the_scene(text: str) -> None:
    background, ambient, reports = colours_and_reports(text)
    assert background == (0.25, 0.5, 0.75)
    assert ambient == (0.5, 0.4, 0.3)
    ((code, message),) = reports
    assert code == "SK-PLUGIN-005"
    assert message.endswith("used instead of the scene's colours: <background_color>, <ambient_light>")


def test_the_colours_of_a_robot_file_count_too() -> None:
    assert colours_and_reports(f"<sdf version='1.9'>{robot(sensors(COLOURS))}</sdf>")[0] == (0.25, 0.5, 0.75)


def test_older_spellings_are_the_same_plugin() -> None:
    old = sensors(COLOURS, "libignition-gazebo6-sensors-system.so", "ignition::gazebo::systems::Sensors")
    assert colours_and_reports(world(SCENE, old))[0] == (0.25, 0.5, 0.75)


def test_missing_colours_stay_those_of_the_scene() -> None:
    background, ambient, reports = colours_and_reports(world(SCENE, sensors("<render_engine>ogre2</render_engine>")))
    assert (background, ambient) == ((0.2, 0.2, 0.2), (0.1, 0.1, 0.1))
    assert [code for code, _ in reports] == ["SK-PLUGIN-005"]
    assert reports[0][1].endswith("not used: <render_engine>")


def test_the_command_line_overrides_the_plugin() -> None:
    text = world(SCENE, sensors(COLOURS))
    background, ambient, reports = colours_and_reports(text, "scene.background=0 0 1")
    assert (background, ambient) == ((0.0, 0.0, 1.0), (0.5, 0.4, 0.3))
    assert [code for code, _ in reports] == ["SK-PLUGIN-005", "SK-PLUGIN-011"]
    assert colours_and_reports(text, "gz::sim::systems::Sensors.ambient_light=1 0 0")[1] == (1.0, 0.0, 0.0)


def test_the_first_of_two_plugins_counts_and_the_second_is_a_warning() -> None:
    other = sensors("<background_color>1 1 1</background_color>")
    background, _, reports = colours_and_reports(world(SCENE, sensors(COLOURS), other))
    assert background == (0.25, 0.5, 0.75)
    assert [code for code, _ in reports] == ["SK-PLUGIN-005", "SK-PLUGIN-005", "SK-PLUGIN-011"]


def test_an_invalid_colour_is_an_error() -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(SCENE, sensors("<background_color>blue</background_color>")))
    assert [d.code for d in caught.value.diagnostics if d.severity == "error"] == ["SK-PARAM-002"]
    assert not [d for d in caught.value.diagnostics if d.code == "SK-PLUGIN-011"]

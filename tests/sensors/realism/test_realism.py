"""Realism of a run: ideal sensors, sensors by their data sheets, and sensors by a YAML file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.params import Params
from simkit.scene.simkit_elements import OWN_ELEMENTS
from simkit.sensors.realism.element_changes import without_errors
from simkit.testing.scenarios.scenario_file import read_scenario

WORLD = """<sdf version="1.9" xmlns:simkit="simkit"><world name="w">
  <model name="robot"><static>true</static><link name="l">
    <sensor name="laser" type="ray"><update_rate>10</update_rate><simkit:latency>0.02</simkit:latency>
      <simkit:dropout><probability>0.5</probability></simkit:dropout>
      <ray><scan><horizontal><samples>90</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle></horizontal></scan>
        <range><min>0.1</min><max>10</max></range><noise><type>gaussian</type><stddev>0.1</stddev></noise></ray></sensor>
    <sensor name="imu" type="imu"><update_rate>100</update_rate><imu><angular_velocity><x>
      <noise type="gaussian"><stddev>0.5</stddev></noise></x></angular_velocity></imu></sensor>
    <sensor name="tim" type="gpu_lidar"><simkit:preset>TiM571</simkit:preset></sensor>
  </link>
  <plugin name="truth" filename="libgazebo_ros_p3d.so"><body_name>l</body_name>
    <gaussian_noise>0.1</gaussian_noise></plugin>
  </model>
  <model name="wall"><static>true</static><pose>2.5 0 0 0 0 0</pose><link name="l">
    <collision name="c"><geometry><box><size>1 6 6</size></box></geometry></collision></link></model>
</world></sdf>"""


def load(realism: object, world: str = WORLD, **arguments: Any) -> simkit.Simulation:
    return simkit.load(world, realism=realism, **arguments)  # type: ignore[arg-type]


def problems(realism: object, **arguments: Any) -> list[tuple[str, str | None, int | None]]:
    with pytest.raises(simkit.LoadError) as caught:
        load(realism, **arguments)
    return [
        (d.code, Path(d.file).name if d.file else None, d.line)
        for d in caught.value.diagnostics
        if d.severity == "error"
    ]


@pytest.fixture
def saved(tmp_path: Path) -> Any:
    def save(text: str) -> str:
        file = tmp_path / "robot.yaml"
        file.write_text(text, encoding="utf-8")
        return str(file)

    return save


@pytest.mark.needs_packs
def test_ideal_sensors_have_neither_noise_nor_losses_nor_latency() -> None:
    with load("ideal") as sim:
        sim.run(0.3)
        laser, tim = sim.sensor("robot::l::laser"), sim.sensor("robot::l::tim")
        assert (laser.latest.ranges == laser.truth.ranges).all()
        assert laser.timing.latency == 0.0 and laser.artefacts == ()
        assert sim.sensor("robot::l::imu").latest.angular_velocity.x == 0.0
        assert (tim.options.range_max, tim.options.noise.stddev, tim.update_rate) == (25.0, 0.0, 15.0)
        (note,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-266"]
        assert "<dropout> of robot::l::laser" in note.message
        assert "<gaussian_noise> of robot::truth" in note.message


@pytest.mark.needs_packs
def test_a_value_of_set_has_priority_over_ideal() -> None:
    with load("ideal", overrides=["robot::l::laser.dropout.probability=1"]) as sim:
        sim.run(0.3)
        assert np.isinf(sim.sensor("robot::l::laser").latest.ranges).all()


def test_the_lidar_of_a_turtlebot3_is_recognised_and_others_are_listed() -> None:
    with simkit.load("turtlebot3_burger", realism="datasheet") as sim:
        found = {d.message.split("'")[1]: d.message for d in sim.diagnostics if d.code == "SK-SENSOR-267"}
        assert "LDS-01" in found["turtlebot3_burger::base_scan::lds"]
        assert "MPU-9250" in found["turtlebot3_burger::imu_link::imu"]
        # the file gives a deviation, which the density of the data sheet replaces
        noise = sim.sensor("turtlebot3_burger::imu_link::imu").options.angular_velocity[0]
        assert noise.stddev == 0.0 and noise.noise_density > 0.0
    with load("datasheet") as sim:
        (note,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-268"]
        assert "robot::l::laser, robot::l::imu" in note.message and "tim" not in note.message


def test_a_preset_of_set_is_the_one_that_the_datasheet_uses() -> None:
    preset = "turtlebot3_burger::base_scan::lds.preset=LDS-02"
    with simkit.load("turtlebot3_burger", realism="datasheet", overrides=[preset]) as sim:
        notes = [d.message for d in sim.diagnostics if d.code == "SK-SENSOR-092"]
        assert any("LDS-02" in message for message in notes) and not any("LDS-01" in message for message in notes)


@pytest.mark.needs_packs
def test_a_file_gives_presets_and_elements_to_the_sensors_that_its_patterns_match(saved: Any) -> None:
    file = saved("""
source: none
sensors:
  robot::l::laser:
    preset: LDS-01
    elements:
      update_rate: 20
      latency: null
      dropout: {probability: 1.0}
      lidar: {range: {max: 3}}
  imu:
    elements:
      imu: {angular_velocity: {xyz: {noise: {"@type": gaussian, mean: 2.0}}}}
plugins:
  "*p3d*":
    elements: {gaussian_noise: 0}
""")
    with load(file) as sim:
        laser = sim.sensor("robot::l::laser")
        assert (laser.update_rate, laser.timing.latency, laser.options.range_max) == (20.0, 0.0, 3.0)
        assert laser.options.range_min == 0.1 and laser.options.horizontal.samples == 90  # as in the file
        assert laser.options.noise.stddev == 0.01  # of the preset, in place of the file's 0.1
        sim.run(0.3)
        assert (laser.latest.ranges == 0.0).all()  # what the driver of the preset writes for a ray without a return
        rates = sim.sensor("robot::l::imu").latest.angular_velocity
        assert (rates.x, rates.y, rates.z) == (2.0, 2.0, 2.0)
        (note,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-269"]
        assert "*p3d* for robot::truth" in note.message


def test_all_mistakes_of_a_file_are_reported_with_their_lines(saved: Any) -> None:
    file = saved("""sensors:
  laser: {preset: LDS-1}
  imu:
    elements:
      angular_velocty: {x: 1}
  nobody: {preset: LDS-01}
""")
    assert problems(file) == [
        ("SK-SENSOR-272", "robot.yaml", 5),
        ("SK-SENSOR-271", "robot.yaml", 6),
        ("SK-SENSOR-090", "robot.yaml", 2),
    ]  # fmt: skip
    wrong_keys = saved("sensor: {}\nsensors:\n  laser: {presets: LDS-01}\n  imu: 3\n")
    assert problems(wrong_keys) == [("SK-SENSOR-270", "robot.yaml", line) for line in (1, 3, 4)]
    assert problems(saved("a: [\n")) == [("SK-SENSOR-270", "robot.yaml", 2)]
    assert problems(saved("")) == [("SK-SENSOR-270", "robot.yaml", 1)]
    assert problems(saved("source: me\n")) == [("SK-SENSOR-270", "robot.yaml", 1)]


@pytest.mark.needs_packs
def test_a_wrong_value_in_a_file_is_reported_with_its_line(saved: Any) -> None:
    file = saved("sensors:\n  laser:\n    elements:\n      dropout:\n        probability: 2\n")
    assert [entry[1:] for entry in problems(file)] == [("robot.yaml", 5)]


def test_an_unknown_choice_is_an_error_with_the_known_ones() -> None:
    assert problems("datashet") == [("SK-SENSOR-274", None, None)]
    assert problems("no_such_file.yaml") == [("SK-SENSOR-274", None, None)]


def test_a_missing_file_is_reported_by_its_name_with_the_most_similar_one(saved: Any) -> None:
    file = saved("sensors: {}")
    wrong = file.replace("robot", "robto")
    with pytest.raises(simkit.LoadError) as caught:
        load(wrong)
    text = str(caught.value)
    assert text.startswith(f"error SK-SENSOR-274: cannot find the file of realism, {wrong!r}")
    assert "did you mean 'robot.yaml'?" in text
    with pytest.raises(simkit.LoadError, match=r"help: --realism takes FILE or one of datasheet, ideal"):
        load("nothing_like_it.yaml")


@pytest.mark.needs_packs
def test_ideal_removes_each_own_element_of_a_sensor_that_is_an_error() -> None:
    kept = {"encoder", "phase", "point_layout", "preset", "scan_pattern", "set_rate_topic", "solar"}
    names = sorted(OWN_ELEMENTS["sensor"])
    params = Params("sensor", "", {}, [Params(name, "") for name in names])
    removed: set[str] = set()
    left = {child.name for child in without_errors(params, removed).children}
    assert left == kept and removed == set(names) - kept


def test_a_spawned_robot_has_the_realism_of_the_run() -> None:
    robot = WORLD[WORLD.index("  <model") : WORLD.index('  <model name="wall')]
    with load("ideal", '<sdf version="1.9"><world name="w"/></sdf>') as sim:
        sim.spawn(f'<sdf version="1.9" xmlns:simkit="simkit">{robot}</sdf>')
        assert sim.sensor("robot::l::laser").artefacts == ()


def test_a_reset_and_a_restored_snapshot_repeat_a_run_with_realism(saved: Any) -> None:
    file = saved("sensors: {laser: {preset: LDS-01, elements: {dropout: {probability: 0.25}}}}")
    with load(file) as sim:
        sim.run(0.25)
        state = sim.snapshot()
        sim.run(0.3)
        first = sim.sensor("robot::l::laser").latest.ranges.copy()
        sim.restore(state)
        sim.run(0.3)
        assert (sim.sensor("robot::l::laser").latest.ranges == first).all()
        sim.reset()
        sim.run(0.55)
        assert (sim.sensor("robot::l::laser").latest.ranges == first).all()


def test_a_scenario_file_names_a_realism_file_beside_it(saved: Any, tmp_path: Path) -> None:
    saved("sensors: {laser: {elements: {latency: 0}}}")
    (tmp_path / "w.sdf").write_text(WORLD, encoding="utf-8")
    (tmp_path / "s.yaml").write_text("world: w.sdf\nduration: 0.1\nrealism: robot.yaml\n", encoding="utf-8")
    spec = read_scenario(tmp_path / "s.yaml")
    assert Path(str(spec.options["realism"])).name == "robot.yaml"
    with simkit.load(spec.source, **spec.load_arguments()) as sim:
        assert sim.sensor("robot::l::laser").timing.latency == 0.0


@pytest.mark.parametrize(
    "text",
    [
        "sensors: {laser: {elements: &e {dropout: *e}}}",
        "sensors: {laser: {elements: {dropout: &d [*d]}}}",
        "a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n"
        + "".join(f"{n}: &{n} [{', '.join([f'*{m}'] * 10)}]\n" for m, n in zip("abcde", "bcdef", strict=True)),
    ],
)
def test_aliases_without_end_are_an_error(saved: Any, text: str) -> None:
    with pytest.raises(simkit.LoadError, match="SK-SENSOR-270.*values"):
        load(saved(text))

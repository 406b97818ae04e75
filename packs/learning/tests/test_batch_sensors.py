"""Sensors that a batch measures one environment after another: the bits of single environments."""

from __future__ import annotations

from typing import Any

import pytest

gymnasium = pytest.importorskip("gymnasium", reason="pip install 'simkit-robotics[experiments]'")

from rover_worlds import COMMAND_AND_ODOMETRY, MUJOCO, TWIST, assert_same_bits, rover, world  # noqa: E402

import simkit.gym  # noqa: E402
from simkit.errors import InputError  # noqa: E402
from simkit.gym import Observation  # noqa: E402

NOISE = "<noise><type>gaussian</type><stddev>0.02</stddev></noise>"
PLACE = """<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>48</latitude_deg>
<longitude_deg>11</longitude_deg><elevation>500</elevation></spherical_coordinates>"""
SENSORS = f"""<sensor name="altimeter" type="altimeter"><topic>height</topic><update_rate>10</update_rate>
<altimeter><vertical_position>{NOISE}</vertical_position></altimeter></sensor>
<sensor name="field" type="magnetometer"><topic>field</topic><magnetometer><x>{NOISE}</x></magnetometer></sensor>
<sensor name="air" type="air_pressure"><topic>air</topic><air_pressure><pressure>{NOISE}</pressure></air_pressure>
</sensor>
<sensor name="gps" type="navsat"><topic>gps</topic><update_rate>4</update_rate></sensor>
<sensor name="sonar" type="sonar"><pose>0.25 0 0.1 0 -1.57 0</pose><topic>sonar</topic><update_rate>20</update_rate>
<sonar><min>0.02</min><max>4</max><radius>0.7</radius>{NOISE}</sonar></sensor>
<sensor name="many" type="gpu_lidar"><pose>0 0 0.15 0 0 0</pose><topic>many</topic><update_rate>10</update_rate>
<lidar><scan><horizontal><samples>2100</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan>
<range><min>0.1</min><max>6</max></range>{NOISE}</lidar></sensor>"""


def camera(kind: str, topic: str, noise: str = "") -> str:
    return f"""<sensor name="{topic}" type="{kind}"><pose>0.2 0 0.2 0 0.1 0</pose><topic>{topic}</topic>
<update_rate>10</update_rate><camera><horizontal_fov>1.4</horizontal_fov><image><width>16</width><height>12</height></image>
<clip><near>0.05</near><far>20</far></clip>{noise}</camera></sensor>"""


def test_height_field_pressure_place_sonar_and_dense_scan_have_the_bits_of_single_robots() -> None:
    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY, sensors=SENSORS)).replace("<model", PLACE + "<model", 1)
    observation = {name: f"/{name}" for name in ("height", "field", "air", "sonar", "many")}
    observation |= {"gps": "/gps", "exact": Observation("/sonar", truth=True)}  # type: ignore[dict-item]
    assert assert_same_bits(source, 8, 2, time_limit=0.4, observation=observation) >= 2


def test_pictures_and_depths_of_a_batch_have_the_bits_of_single_robots() -> None:
    sensors = camera("camera", "eye", NOISE) + camera("depth_camera", "depth") + camera("rgbd_camera", "both")
    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY, sensors=sensors))
    observation: dict[str, Any] = {"eye": "/eye", "depth": "/depth", "both": "/both/image", "scan": "/rover/scan"}
    observation["exact"] = Observation("/eye", truth=True)
    overrides = (*MUJOCO, "scene.renderer=software")
    assert assert_same_bits(source, 4, 2, time_limit=0.2, observation=observation, overrides=overrides) >= 2


def test_pictures_of_robots_with_drawn_masses_have_the_bits_of_single_robots() -> None:
    """Each environment has a model of its own, with which its picture is drawn."""
    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY, sensors=camera("camera", "eye")))
    options: dict[str, Any] = {
        "observation": {"eye": "/eye"},
        "randomise": {"rover::base.inertial.mass": {"uniform": [5.0, 9.0]}},
        "overrides": (*MUJOCO, "scene.renderer=software"),
    }
    assert assert_same_bits(source, 4, 2, time_limit=0.2, **options) >= 2


def test_rays_of_one_environment_after_another_need_the_same_shapes_in_all() -> None:
    def grow(env: Any) -> None:
        env.sim.mj_model.geom_size[:] *= 1.0 + env.np_random.random()

    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY, sensors=SENSORS))
    envs: Any = simkit.gym.make_vec(
        source, num_envs=2, batch=True, observation="/sonar", action=TWIST, overrides=MUJOCO, on_reset=grow
    )
    with pytest.raises(InputError, match=r"SK-GYM-001.*sensor 'rover::base::sonar' sees"):
        envs.reset(seed=1)
    envs.close()

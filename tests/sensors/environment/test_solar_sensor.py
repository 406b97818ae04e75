"""Solar sensor, compared with geometry: direction, cone, shadow, cosine law, noise."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from sensor_worlds import box

import simkit
from simkit.pose import Pose, quat_rotate, rpy_from_quat

SUN = '<light name="sun" type="directional"><pose>0 0 10 0 0 0</pose><direction>-1 0 -1</direction></light>'
S = "m::l::s"


def solar(block: str = "", *, rate: float = 10, pose: str = "0 0 0 0 0 0", more: str = "") -> str:
    return (
        f'<sensor name="s" type="custom" gz:type="solar"><pose>{pose}</pose><update_rate>{rate}</update_rate>'
        f"<solar>{block}</solar>{more}</sensor>"
    )


def world(sensor: str, *others: str, lights: str = SUN, pose: str = "0 0 1 0 0 0", body: str = "") -> str:
    return (
        f'<sdf version="1.9"><world name="w">{lights}<model name="m"><static>true</static><pose>{pose}</pose>'
        f'<link name="l">{body}{sensor}</link></model>{"".join(others)}</world></sdf>'
    )


def lamp(kind: str = "point", pose: str = "0 0 3 0 0 0", more: str = "") -> str:
    return f'<light name="lamp" type="{kind}"><pose>{pose}</pose>{more}</light>'


def opened(block: str = "", *others: str, seed: int = 0, run: float = 0.1, **where: Any) -> simkit.Simulation:
    sensor = solar(block, **{k: where.pop(k) for k in ("rate", "more") if k in where})
    sim = simkit.load(world(sensor, *others, **where), seed=seed)
    sim.run(run)
    return sim


def axis(message: Any) -> np.ndarray:
    q = message.orientation
    return quat_rotate((q.w, q.x, q.y, q.z), (1, 0, 0))


def unit(*v: float) -> np.ndarray:
    return np.array(v) / np.linalg.norm(v)


def values(sim: simkit.Simulation, *names: str, seconds: float = 0.1) -> list[Any]:
    """Return the newest value on each of the sensor's topics."""
    subscriptions = [sim.subscribe(f"{sim.sensor(S).topic}/{name}") for name in names]
    sim.run(seconds)
    return [s.latest.data for s in subscriptions]


# ------------------------------------------------------------------ direction


def test_the_x_axis_of_its_orientation_points_to_where_a_directional_lights_rays_come_from() -> None:
    with opened(pose="3 2 1 0.3 -0.2 0.7") as sim:
        message, pose = sim.sensor(S).latest, sim.sensor(S).pose
    np.testing.assert_allclose(pose.rotate(axis(message)), unit(1, 0, 1), atol=1e-12)
    assert rpy_from_quat([getattr(message.orientation, k) for k in "wxyz"])[0] == pytest.approx(0, abs=1e-12)
    assert message.header.frame_id == S
    assert message.orientation_covariance[0] == 0
    assert message.angular_velocity_covariance[0] == message.linear_acceleration_covariance[0] == -1


def test_it_can_take_a_directional_light_to_be_where_its_pose_is() -> None:
    with opened("<towards>position</towards>", pose="4 0 7 0 0 0") as sim:
        np.testing.assert_allclose(axis(sim.sensor(S).latest), unit(-4, 0, 3), atol=1e-12)


def test_a_lamp_is_seen_where_it_is_also_when_a_moving_link_carries_it() -> None:
    carrier = (
        '<model name="car"><pose>5 0 1 0 0 1.5707963267948966</pose><link name="l">'
        '<light name="head" type="point"><pose>2 0 0 0 0 0</pose></light></link></model>'
    )
    with opened("<light_name>car::l::head</light_name>", carrier, lights="", run=0.001, rate=0) as sim:
        car = sim.link("car::l").pose
        towards = car.transform((2, 0, 0)) - (0, 0, 1)
        np.testing.assert_allclose(axis(sim.sensor(S).truth), towards / np.linalg.norm(towards), atol=1e-12)
        sim.run(0.3)
        towards = sim.link("car::l").pose.transform((2, 0, 0)) - (0, 0, 1)
        assert towards[2] < -0.3
        np.testing.assert_allclose(axis(sim.sensor(S).truth), towards / np.linalg.norm(towards), atol=1e-12)


def test_it_follows_a_light_that_is_moved_and_unread_samples_keep_the_light_of_their_time() -> None:
    with opened() as sim:
        sensor = sim.sensor(S)
        before = sim.snapshot()
        sim.light("sun").set_pose(Pose.from_rpy(0, 0, 0, 0, 0, math.pi / 2))
        np.testing.assert_allclose(axis(sensor.latest), unit(1, 0, 1), atol=1e-12)
        sim.run(0.1)
        np.testing.assert_allclose(axis(sensor.latest), unit(0, 1, 1), atol=1e-12)
        sim.restore(before)
        np.testing.assert_allclose(axis(sensor.latest), unit(1, 0, 1), atol=1e-12)
        sim.light("sun").set_pose(Pose.from_rpy(0, 0, 0, 0, 0, math.pi))
        sim.run(0.1)
        sim.reset()
        sim.run(0.1)
        np.testing.assert_allclose(axis(sensor.latest), unit(1, 0, 1), atol=1e-12)


def test_a_delayed_reading_has_the_light_at_the_time_of_its_sample() -> None:
    with opened(more="<latency>0.25</latency>", run=0.15) as sim:
        # samples at 0.001 and 0.1 are on their way
        sim.light("sun").set_pose(Pose.from_rpy(0, 0, 0, 0, 0, math.pi / 2))
        sim.run(0.21)
        np.testing.assert_allclose(axis(sim.sensor(S).latest), unit(1, 0, 1), atol=1e-12)
        sim.run(0.1)
        np.testing.assert_allclose(axis(sim.sensor(S).latest), unit(0, 1, 1), atol=1e-12)


# ------------------------------------------------------------------ validity


def is_invalid(message: Any) -> bool:
    q = message.orientation
    return message.orientation_covariance[0] == -1 and (q.w, q.x, q.y, q.z) == (1, 0, 0, 0)


def test_beyond_its_field_of_view_a_reading_is_invalid() -> None:
    # the direction to the light is 45 degrees from the normal
    for degrees, valid in ((89, False), (91, True)):
        with opened(f"<field_of_view>{math.radians(degrees)}</field_of_view>") as sim:
            assert values(sim, "valid") == [valid]
            assert is_invalid(sim.sensor(S).latest) is not valid
            assert sim.sensor(S).reading.incidence == pytest.approx(math.pi / 4)
            assert values(sim, "irradiance")[0] == pytest.approx(1000 / math.sqrt(2))


def test_a_light_that_is_off_or_no_light_gives_no_reading() -> None:
    off = SUN.replace("</light>", "<light_on>false</light_on></light>")
    for lights, block in ((off, ""), (lamp(), ""), ("", "")):
        with opened(block, lights=lights) as sim:
            assert is_invalid(sim.sensor(S).latest)
            assert values(sim, "valid", "irradiance") == [False, 0.0]


@pytest.mark.parametrize("angle, share", [(0.0, 1.0), (0.24, 1.0), (0.375, 0.25), (0.49, 0.0016), (0.51, 0.0)])
def test_a_spot_shines_within_its_cone_and_fades_at_its_rim(angle: float, share: float) -> None:
    cone = "<spot><inner_angle>0.5</inner_angle><outer_angle>1</outer_angle><falloff>2</falloff></spot>"
    place = f"{3 * math.sin(angle)} 0 {1 + 3 * math.cos(angle)} 0 0 0"
    block = f"<light_name>lamp</light_name><normal>{math.sin(angle)} 0 {math.cos(angle)}</normal>"
    with opened(block, lights=lamp("spot", place)[:-8] + cone + "</light>") as sim:
        assert values(sim, "valid", "irradiance") == [share > 0, pytest.approx(1000 * share, abs=1e-9)]


# ------------------------------------------------------------------ irradiance and power


@pytest.mark.parametrize("tilt", [-0.5, 0.0, 0.7, 1.2])
def test_irradiance_follows_the_cosine_law(tilt: float) -> None:
    with opened("<irradiance>800</irradiance>", pose=f"0 0 1 0 {tilt} 0") as sim:
        found = values(sim, "irradiance")[0]
    assert found == pytest.approx(800 * max(0.0, math.cos(math.pi / 4 - tilt)), abs=1e-9)


def test_from_behind_there_is_a_direction_but_no_irradiance() -> None:
    with opened("<normal>0 0 -1</normal><panel><area>1</area><efficiency>1</efficiency></panel>") as sim:
        assert values(sim, "valid", "irradiance", "power") == [True, 0.0, 0.0]


def test_a_panels_power_is_light_times_area_times_efficiency() -> None:
    panel = "<panel><area>0.5</area><efficiency>0.2</efficiency><normal>1 0 0</normal></panel>"
    with opened("<irradiance>900</irradiance>" + panel, pose="0 0 1 0 0.3 0") as sim:
        assert values(sim, "power")[0] == pytest.approx(900 * math.cos(math.pi / 4 + 0.3) * 0.5 * 0.2)


def test_the_sensors_irradiance_overrides_the_lights() -> None:
    own = SUN.replace("</light>", "<simkit:irradiance>600</simkit:irradiance></light>")
    namespaced = 'xmlns:simkit="https://simkit" version="1.9"'
    for block, lights, facing in (
        ("", SUN, 1000),
        ("", own, 600),
        ("<irradiance>light</irradiance>", own, 600),
        ("<irradiance>50</irradiance>", own, 50),
    ):
        text = world(solar(block), lights=lights).replace('version="1.9"', namespaced)
        with simkit.load(text) as sim:
            assert values(sim, "irradiance")[0] == pytest.approx(facing / math.sqrt(2))


@pytest.mark.parametrize("distance", [0.5, 1.0, 4.0])
def test_a_lamp_fades_by_the_chosen_rule(distance: float) -> None:
    fade = (
        "<attenuation><range>3</range><constant>1</constant><linear>0.5</linear><quadratic>0.25</quadratic>"
        "</attenuation>"
    )
    own = 1 / (1 + 0.5 * distance + 0.25 * distance**2) if distance <= 3 else 0.0
    for rule, factor in (("none", 1.0), ("inverse_square", distance**-2), ("attenuation", own)):
        block = f"<light_name>lamp</light_name><irradiance>100</irradiance><falloff>{rule}</falloff>"
        with opened(block, lights=lamp(pose=f"0 0 {1 + distance} 0 0 0", more=fade)) as sim:
            assert values(sim, "irradiance")[0] == pytest.approx(100 * factor)


# ------------------------------------------------------------------ shadow

SHADOW = "<shadow>true</shadow><panel><area>1</area><efficiency>0.5</efficiency></panel>"


def shadow_of(*others: str, block: str = "", **where: Any) -> str:
    with opened(SHADOW + block, *others, **where) as sim:
        sensor = sim.sensor(S)
        valid, irradiance, power, named = values(sim, "valid", "irradiance", "power", "shadow")
        assert sensor.shadow == sensor.reading.shadow == named
        assert is_invalid(sensor.latest) is is_invalid(sensor.truth) is not valid
        if named:
            assert (valid, irradiance, power) == (False, 0.0, 0.0)
        else:
            assert valid and irradiance > 0 and power == pytest.approx(irradiance / 2)
        return str(named)


def test_a_box_on_the_way_to_the_light_casts_its_shadow_and_truth_names_it() -> None:
    # the ray goes (0, 0, 1) + t (1, 0, 1); a box of 1 m about (x, 0, 4) is hit for 2 < x < 4
    for x, hit in ((1.9, False), (2.1, True), (3.9, True), (4.1, False)):
        found = shadow_of(box("tower", f"{x} 0 4 0 0 0", "1 1 1"))
        assert found == ("tower::l::v" if hit else "")


def test_the_nearest_of_several_is_named() -> None:
    assert shadow_of(box("far", "6 0 7 0 0 0", "1 1 1"), box("near", "3 0 4 0 0 0", "1 1 1")) == "near::l::v"


def test_without_the_element_nothing_casts_a_shadow() -> None:
    with opened("", box("tower", "3 0 4 0 0 0", "1 1 1")) as sim:
        assert values(sim, "valid") == [True]
        assert not [topic for topic in sim.topics() if topic.endswith("shadow")]


def test_only_a_lamp_has_something_behind_it() -> None:
    behind = box("wall", "0 0 5 0 0 0", "1 1 1")
    assert shadow_of(behind, block="<light_name>lamp</light_name>", lights=lamp(pose="0 0 3 0 0 0")) == ""
    assert shadow_of(behind, block="<light_name>lamp</light_name>", lights=lamp(pose="0 0 8 0 0 0")) == "wall::l::v"
    down = SUN.replace("-1 0 -1", "0 0 -1").replace("0 0 10 0", "0 0 3 0")
    assert shadow_of(behind, lights=down) == "wall::l::v"
    assert shadow_of(behind, block="<towards>position</towards>", lights=down) == ""


def test_a_sun_256_million_kilometres_away_casts_shadows_too() -> None:
    far = SUN.replace("0 0 10 0 0 0", "181e9 0 181e9 0 0 0")
    for towards in ("direction", "position"):
        block = f"<towards>{towards}</towards>"
        assert shadow_of(box("tower", "30 0 31 0 0 0", "1 1 1"), block=block, lights=far) == "tower::l::v"
        assert shadow_of(box("tower", "30 2 31 0 0 0", "1 1 1"), block=block, lights=far) == ""


def test_a_visual_without_a_shadow_lets_light_through() -> None:
    tower = box("tower", "3 0 4 0 0 0", "1 1 1")
    assert shadow_of(tower.replace('<visual name="v">', '<visual name="v"><cast_shadows>false</cast_shadows>')) == ""
    for transparency, name in ((0.4, "tower::l::v"), (0.6, "")):
        glass = f'<visual name="v"><transparency>{transparency}</transparency>'
        assert shadow_of(tower.replace('<visual name="v">', glass)) == name


def test_collisions_count_only_on_links_without_visuals() -> None:
    assert shadow_of(box("tower", "3 0 4 0 0 0", "1 1 1", visual=False)) == "tower::l::c"
    # the visual is small and not in the way, the collision is
    drawn = '<visual name="v"><geometry><sphere><radius>0.1</radius></sphere></geometry></visual></link>'
    aside = box("tower", "2.3 0 4 0 0 0", "1 1 1", visual=False).replace("</link>", drawn)
    assert shadow_of(aside) == ""


def test_its_own_link_is_its_housing_and_other_links_of_the_robot_are_not() -> None:
    housing = '<visual name="h"><geometry><sphere><radius>0.2</radius></sphere></geometry></visual>'
    assert shadow_of(body=housing) == ""
    # the same on a body of its own, with a mast on the way
    for static in ("true", "false"):
        mast = '<visual name="v"><geometry><box><size>0.1 0.1 4</size></box></geometry></visual>'
        robot = (
            f'<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>{SUN}<model name="m"><static>{static}</static>'
            f'<pose>0 0 1 0 0 0</pose><link name="l">{housing}{solar(SHADOW)}</link>'
            f'<link name="mast"><pose>1 0 0 0 0 0</pose>{mast}</link>'
            '<joint name="j" type="fixed"><parent>l</parent><child>mast</child></joint></model></world></sdf>'
        )
        with simkit.load(robot) as sim:
            sim.run(0.1)
            assert sim.sensor(S).shadow == "m::mast::v"


def test_the_lamps_own_link_is_its_housing() -> None:
    bulb = '<visual name="v"><geometry><sphere><radius>0.2</radius></sphere></geometry></visual>'
    post = (
        '<model name="post"><static>true</static><pose>0 0 4 0 0 0</pose><link name="l">'
        f'{bulb}<light name="bulb" type="point"/></link></model>'
    )
    assert shadow_of(post, block="<light_name>post::l::bulb</light_name>", lights="") == ""


def test_a_box_that_falls_through_the_ray_casts_its_shadow_for_the_time_it_takes() -> None:
    """The box's edges cross the ray after a fall of 0.5 g t² = 1 m and 3 m; later readers get the same values."""
    falling = box("m2", "3 0 6 0 0 0", "1 1 1", collision=False).replace("<static>true</static>", "")
    found: dict[bool, list[str]] = {True: [], False: []}
    for listens in found:
        with opened(SHADOW, falling, run=0, rate=100) as sim:
            if listens:
                sim.subscribe(sim.sensor(S).topic)
            for _ in range(90):
                sim.run(0.01)
                found[listens].append(sim.sensor(S).shadow)
    assert found[True] == found[False]
    times = 0.01 * (1 + np.flatnonzero([name == "m2::l::v" for name in found[True]]))
    assert times[0] == pytest.approx(math.sqrt(2 * 1 / 9.8), abs=0.011)
    assert times[-1] == pytest.approx(math.sqrt(2 * 3 / 9.8), abs=0.011)
    assert len(times) == pytest.approx((times[-1] - times[0]) / 0.01 + 1, abs=0.1)


def test_the_ray_leaves_the_model_as_it_was() -> None:
    with opened(SHADOW, box("tower", "3 0 4 0 0 0", "1 1 1")) as sim:
        before = sim.mj_model.geom_group.copy()
        assert sim.sensor(S).shadow
        np.testing.assert_array_equal(sim.mj_model.geom_group, before)


def test_a_spawned_model_casts_a_shadow_and_a_removed_model_does_not() -> None:
    with opened(SHADOW) as sim:
        sensor = sim.sensor(S)
        assert sensor.shadow == ""
        sim.spawn(f'<sdf version="1.9">{box("tower", "3 0 4 0 0 0", "1 1 1")}</sdf>')
        sim.run(0.1)
        assert sensor.shadow == "tower::l::v"
        sim.remove("tower")
        sim.run(0.1)
        assert sensor.shadow == ""


def test_a_lamp_that_is_removed_leaves_darkness() -> None:
    post = (
        '<sdf version="1.9"><model name="post"><link name="l"><light name="x" type="directional"/></link></model></sdf>'
    )
    with simkit.load(world(solar(), lights="")) as sim:
        for _ in range(2):
            sim.run(0.1)
            assert is_invalid(sim.sensor(S).latest)
            sim.spawn(post)
            sim.run(0.1)
            assert not is_invalid(sim.sensor(S).latest)
            sim.remove("post")


# ------------------------------------------------------------------ noise


def errors(sim: simkit.Simulation, count: int) -> np.ndarray:
    """Return the rotation errors of readings about the sensor frame's axes [rad], shape (count, 3)."""
    subscription = sim.subscribe(sim.sensor(S).topic)
    sim.run(count * sim.timestep)
    true = axis(sim.sensor(S).truth)
    found = np.array([axis(m) for m in subscription.messages])
    return np.cross(true, found)


def test_the_direction_errs_by_an_angle_with_rayleighs_distribution() -> None:
    sigma, n = 0.02, 4000
    with opened(f"<noise type='gaussian'><stddev>{sigma}</stddev></noise>", rate=0, run=0) as sim:
        turns = errors(sim, n)
        true = axis(sim.sensor(S).truth)
    np.testing.assert_allclose(turns @ true, 0, atol=1e-12)
    angles = np.arcsin(np.linalg.norm(turns, axis=1))
    # Rayleigh: mean σ √(π/2), mean square 2 σ²; the bounds are four standard deviations of the estimates
    assert angles.mean() == pytest.approx(
        sigma * math.sqrt(math.pi / 2), abs=4 * sigma * math.sqrt((2 - math.pi / 2) / n)
    )
    assert (angles**2).mean() == pytest.approx(2 * sigma**2, abs=4 * 2 * sigma**2 / math.sqrt(n))
    assert np.mean(angles > 2 * sigma) == pytest.approx(math.exp(-2), abs=4 * math.sqrt(math.exp(-2) / n))
    # all directions of the rotation axis are equally likely
    across = np.cross(true, (0, 1, 0))
    about = np.arctan2(turns @ across, turns[:, 1])
    assert abs(np.exp(1j * about).mean()) < 4 / math.sqrt(n)
    assert abs(np.exp(2j * about).mean()) < 4 / math.sqrt(n)


def test_the_covariance_is_that_of_the_errors() -> None:
    sigma, n = 0.01, 4000
    with opened(f"<angular_noise>{sigma}</angular_noise>", rate=0, run=0, pose="0 0 1 0.5 0.4 0.3") as sim:
        turns = errors(sim, n)
        told = np.asarray(sim.sensor(S).truth.orientation_covariance).reshape(3, 3)
        read = np.asarray(sim.sensor(S).latest.orientation_covariance).reshape(3, 3)
    np.testing.assert_allclose(np.cov(turns.T), told, atol=4 * sigma**2 * math.sqrt(2 / n))
    np.testing.assert_allclose(read, told, atol=4 * 2 * sigma * sigma**2)


def test_noise_repeats_with_the_seed_for_any_earlier_readers() -> None:
    block = "<angular_noise>0.01</angular_noise>"
    with opened(block, rate=0, run=0) as early, opened(block, rate=0, run=0.05) as late:
        first = errors(early, 100)
        second = errors(late, 50)
        np.testing.assert_array_equal(first[50:], second)
        early.reset()
        early.run(0.05)
        np.testing.assert_array_equal(errors(early, 50)[-50:], second)
    with opened(block, rate=0, run=0, seed=1) as other:
        assert not np.array_equal(errors(other, 100), first)


def test_precision_rounds_pitch_and_yaw() -> None:
    noise = "<noise type='gaussian_quantized'><stddev>0.01</stddev><precision>0.05</precision></noise>"
    with opened(noise, rate=0, run=0.02) as sim:
        q = sim.sensor(S).latest.orientation
    angles = rpy_from_quat((q.w, q.x, q.y, q.z)) / 0.05
    np.testing.assert_allclose(angles, np.round(angles), atol=1e-9)
    assert abs(angles[1] + 16) <= 1


# ------------------------------------------------------------------ what is said


def messages_by_code(block: str, *others: str, lights: str = SUN) -> dict[str, str]:
    text = world(solar(block), *others, lights=lights)
    try:
        with simkit.load(text) as sim:
            return {d.code: d.message for d in sim.diagnostics}
    except simkit.LoadError as error:
        return {d.code: f"{d.message} {d.hint}" for d in error.diagnostics}


def test_all_invalid_options_are_reported_in_one_pass() -> None:
    block = (
        "<shadow>maybe</shadow><towards>up</towards><falloff>linear</falloff><normal>0 0 0</normal>"
        "<irradiance>much</irradiance><field_of_view>7</field_of_view><panel><area>-1</area></panel>"
    )
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(solar(block)))
    found = sorted(d.code for d in caught.value.diagnostics if d.severity == "error")
    assert found == ["SK-PARAM-001"] + ["SK-PARAM-002"] * 7


def test_an_unknown_light_is_an_error_that_lists_the_lights() -> None:
    found = messages_by_code("<light_name>son</light_name>")
    assert "lights are: 'sun'" in found["SK-SENSOR-080"] and "did you mean 'sun'" in found["SK-SENSOR-080"]
    assert "SK-SENSOR-082" in messages_by_code("", lights=lamp())
    assert messages_by_code("") == {}


def test_an_option_without_effect_is_reported() -> None:
    assert "falloff" in messages_by_code("<falloff>inverse_square</falloff>")["SK-SENSOR-083"]
    block = "<light_name>lamp</light_name><towards>position</towards>"
    assert "towards" in messages_by_code(block, lights=lamp())["SK-SENSOR-083"]


def test_a_model_without_a_world_has_invalid_readings_until_a_light_exists() -> None:
    sensor = solar("<light_name>sun</light_name>")
    model = f'<sdf version="1.9"><model name="m"><link name="l">{sensor}</link></model></sdf>'
    with simkit.load(model, base="fixed") as sim:
        sim.run(0.1)
        assert is_invalid(sim.sensor(S).latest)
        assert [d.code for d in sim.diagnostics if "SENSOR" in d.code] == ["SK-SENSOR-081"]

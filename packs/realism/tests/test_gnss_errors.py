"""Outages, types of fix and multipath of a satellite receiver have the times, shares and sizes of the file."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit.errors import SimkitError

WORLD = """<sdf version="1.9" xmlns:simkit="simkit"><world name="w"><gravity>0 0 0</gravity>
  <physics type="ode"><max_step_size>{step}</max_step_size></physics>
  <spherical_coordinates><latitude_deg>48</latitude_deg><longitude_deg>11</longitude_deg><elevation>500</elevation>
    <heading_deg>{heading}</heading_deg></spherical_coordinates>
  <model name="m"><pose>{pose} 0 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>
    <sensor name="gps" type="navsat"><update_rate>{rate}</update_rate><topic>fix</topic>
      <navsat>{noise}</navsat>{errors}</sensor></link></model></world></sdf>"""
NORTH, EAST = math.radians(1) * 6366000, math.radians(1) * 6389000 * math.cos(math.radians(48))  # [m/deg], to 1 %


def world(errors: str, *, pose: str = "0 0", rate: float = 10, noise: str = "", step: float = 0.1, heading: float = 0):
    return WORLD.format(errors=errors, pose=pose, rate=rate, noise=noise, step=step, heading=heading)


def fixes(text: str, duration: float, speed: float = 0.0, seed: int = 0) -> list:
    with simkit.load(text, seed=seed) as sim:
        kept = sim.subscribe("/fix")
        if speed:
            sim.model("m").set_velocity((speed, 0.0, 0.0), (0.0, 0.0, 0.0))
        sim.run(duration)
        return list(kept.messages)


def errors_of(messages: list) -> np.ndarray:
    """Return the errors to east, north and up [m], shape (n, 3)."""
    return np.array([((m.longitude - 11) * EAST, (m.latitude - 48) * NORTH, m.altitude - 500) for m in messages])


def statuses(messages: list) -> np.ndarray:
    return np.array([message.status.status for message in messages])


def times(messages: list) -> np.ndarray:
    return np.array([m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in messages])


def correlation(rows: np.ndarray, lag: int) -> float:
    return float((rows[:-lag] * rows[lag:]).mean() / (rows * rows).mean())


def test_a_window_has_no_fix_and_the_first_fix_comes_after_its_time() -> None:
    errors = """<simkit:outages><window>1 2</window><window>4 4.5</window><time_to_fix>0.5</time_to_fix>
      </simkit:outages>"""
    messages = fixes(world(errors), 6.0)
    lost = np.round(times(messages)[statuses(messages) == -1], 6)
    expected = [*np.arange(10, 25), *np.arange(40, 50)]
    np.testing.assert_allclose(lost, np.array(expected) / 10)
    (first, *_) = [m for m in messages if m.status.status == -1]
    assert math.isnan(first.latitude) and math.isnan(first.altitude) and first.position_covariance_type == 0


@pytest.mark.parametrize(
    ("shape", "heading"),
    [
        ("<box>2 -1 4 1</box>", 0),
        ("<box>2 -1 4 1</box>", 70),
        ("<polygon>2 -9 4 -9 4 9 2 9</polygon>", 0),
        (f"<geodetic_polygon>47 {11 + 2 / EAST:.9f} 47 {11 + 4 / EAST:.9f} 49 {11 + 4 / EAST:.9f} 49 "
         f"{11 + 2 / EAST:.9f}</geodetic_polygon>", 0),
    ],
)  # fmt: skip
def test_an_area_without_reception_is_where_the_file_places_it(shape: str, heading: float) -> None:
    """At 1 m/s to the x axis, the receiver is in the area from 2 s to 4 s."""
    errors = f"<simkit:outages><area>{shape}</area></simkit:outages>"
    messages = fixes(world(errors, pose="0 0", heading=heading), 6.0, speed=1.0)
    lost = times(messages)[statuses(messages) == -1]
    assert abs(lost[0] - 2.05) < 0.12 and abs(lost[-1] - 3.95) < 0.12 and len(lost) in (19, 20, 21)


def test_random_outages_have_their_rate_and_duration() -> None:
    errors = "<simkit:outages><rate>0.05</rate><mean_duration>5</mean_duration></simkit:outages>"
    is_out = statuses(fixes(world(errors, rate=1, step=1), 4000)) == -1
    begins = np.flatnonzero(is_out[1:] & ~is_out[:-1])
    # a share of 0.05 / (0.05 + 1/5); the errors of neighbouring samples are correlated over 4 s
    assert abs(is_out.mean() - 0.2) < 4 * math.sqrt(0.16 * 8 / 4000)
    # seen at whole seconds, an outage ends with the probability 0.8·(1 - exp(-0.25)) at the next sample
    ends = 0.8 * (1 - math.exp(-0.25))
    lengths = is_out.sum() / len(begins)
    assert abs(lengths * ends - 1) < 4 / math.sqrt(len(begins))


def test_the_error_of_the_first_fix_decays() -> None:
    errors = """<simkit:outages><window>0 1</window><fix_error>10</fix_error><settling_time>2</settling_time>
      </simkit:outages>"""
    firsts = []
    with simkit.load(world(errors)) as sim:
        for seed in range(80):
            sim.reset(seed=seed)
            kept = sim.subscribe("/fix")
            sim.run(3.05)
            rows = errors_of([m for m in kept.messages if m.status.status == 0])
            firsts.append(rows[0])
            np.testing.assert_allclose(rows[20], rows[0] / math.e, atol=0.02 + 0.02 * abs(rows[0]).max())
            kept.close()
    spread = np.array(firsts).std()
    assert abs(spread / 10 - 1) < 4 / math.sqrt(2 * 240) + 0.01


def test_types_of_fix_have_their_shares_errors_and_covariances() -> None:
    errors = """<simkit:fix_types><mean_duration>2</mean_duration>
      <fix><status>gbas</status><probability>0.6</probability><stddev>0.02</stddev><satellites>24</satellites></fix>
      <fix><status>fix</status><probability>0.3</probability><stddev>1.5</stddev><vertical_stddev>3</vertical_stddev>
        <satellites>9</satellites></fix>
      <fix><status>no_fix</status><probability>0.1</probability></fix></simkit:fix_types>"""
    noise = "<position_sensing><horizontal><noise type='gaussian'><stddev>0.5</stddev></noise></horizontal>"
    messages = fixes(world(errors, rate=1, step=1, noise=noise + "</position_sensing>"), 2500)
    found = statuses(messages)
    for status, share in ((2, 0.6), (0, 0.3), (-1, 0.1)):
        # the type is redrawn each 2 s on average, so about 2·2 / 1 samples are one draw
        assert abs((found == status).mean() - share) < 4 * math.sqrt(share * (1 - share) * 4.1 / 2500)
    for status, horizontal, vertical in ((2, math.hypot(0.5, 0.02), 0.02), (0, math.hypot(0.5, 1.5), 3.0)):
        kept = [m for m in messages if m.status.status == status]
        rows = errors_of(kept)
        covariance = np.array(kept[0].position_covariance).reshape(3, 3)
        np.testing.assert_allclose(np.diag(covariance), (horizontal**2, horizontal**2, vertical**2), rtol=1e-9)
        assert kept[0].position_covariance_type == 2
        allowed = 4 / math.sqrt(2 * len(rows)) + 0.01
        assert np.abs(rows.std(axis=0) / (horizontal, horizontal, vertical) - 1).max() < allowed


def test_a_type_of_fix_with_an_area_occurs_there_and_nowhere_else() -> None:
    errors = """<simkit:fix_types><mean_duration>1000</mean_duration><fix><status>gbas</status></fix>
      <fix><status>fix</status><area><box>2 -1 4 1</box></area></fix></simkit:fix_types>"""
    messages = fixes(world(errors), 6.0, speed=1.0)
    is_inside = (times(messages) > 2.05) & (times(messages) < 3.95)
    is_outside = (times(messages) < 1.95) | (times(messages) > 4.05)
    assert (statuses(messages)[is_inside] == 0).all() and (statuses(messages)[is_outside] == 2).all()


def test_multipath_has_its_size_and_its_correlation_in_time() -> None:
    errors = """<simkit:multipath><stddev>3</stddev><vertical_stddev>5</vertical_stddev>
      <correlation_time>5</correlation_time></simkit:multipath>"""
    rows = errors_of(fixes(world(errors, rate=1, step=1), 4000))
    # about 4000 / (2·5) independent samples
    assert np.abs(rows.std(axis=0) / (3, 3, 5) - 1).max() < 4 / math.sqrt(2 * 400) + 0.01
    for channel in range(3):
        assert abs(correlation(rows[:, channel], 5) - math.exp(-1)) < 4 / math.sqrt(400)


def test_multipath_is_correlated_in_place() -> None:
    errors = """<simkit:multipath><stddev>3</stddev><correlation_time>1e6</correlation_time>
      <correlation_length>20</correlation_length></simkit:multipath>"""
    messages = fixes(world(errors, rate=1, step=1), 3000, speed=2.0)
    rows = np.array([m.altitude for m in messages])
    # the altitude of a plane's point grows with the distance; 6 km make a parabola of 3 m, which is subtracted
    distance = 2.0 * times(messages)
    rows = rows - np.polyval(np.polyfit(distance, rows, 2), distance)
    assert abs(rows.std() / 3 - 1) < 4 / math.sqrt(2 * 150) + 0.02
    assert abs(correlation(rows, 10) - math.exp(-1)) < 4 / math.sqrt(150)
    assert errors_of(fixes(world(errors, rate=1, step=1), 200)).std(axis=0).max() < 0.4  # while it stands, no change


def test_multipath_acts_in_its_areas_only() -> None:
    errors = """<simkit:multipath><stddev>3</stddev><area><box>2 -1 4 1</box></area>
      <area><box>4 -1 6 1</box><stddev>300</stddev></area></simkit:multipath>"""
    messages = fixes(world(errors), 8.0, speed=1.0)
    up = np.abs([m.altitude - 500 for m in messages])
    now = times(messages)
    assert up[(now < 1.9) | (now > 6.1)].max() < 1e-4
    assert 1e-3 < up[(now > 2.1) & (now < 3.9)].max() < 15
    assert up[(now > 4.1) & (now < 5.9)].max() > 15


ALL = """<simkit:outages><rate>0.2</rate><mean_duration>1</mean_duration><time_to_fix>0.4</time_to_fix>
  <fix_error>3</fix_error></simkit:outages><simkit:multipath><stddev>2</stddev></simkit:multipath>
  <simkit:fix_types><mean_duration>1</mean_duration><correlation_time>5</correlation_time>
  <fix><stddev>1</stddev></fix><fix><status>sbas</status><stddev>0.4</stddev></fix></simkit:fix_types>"""


def bits(messages: list) -> list[bytes]:
    return [np.array((m.latitude, m.longitude, m.altitude, m.status.status)).tobytes() for m in messages]


def test_reset_and_restore_repeat_the_bits_and_readers_change_nothing() -> None:
    text = world(ALL)
    whole = bits(fixes(text, 20.0))
    assert len(set(whole)) > 100
    with simkit.load(text) as sim:
        sim.run(10.0)
        kept = sim.subscribe("/fix")
        state = sim.snapshot()
        sim.run(10.0)
        after = bits(kept.messages)
        assert after == whole[-len(after) :]
        sim.restore(state)
        again = sim.subscribe("/fix")
        sim.run(10.0)
        assert bits(again.messages)[-100:] == after[-100:]
        sim.reset()
        third = sim.subscribe("/fix")
        sim.run(20.0)
        assert bits(third.messages)[-100:] == whole[-100:]


def test_the_detailed_fix_has_status_satellites_and_nan_without_a_fix() -> None:
    errors = """<simkit:fix_types><fix><status>sbas</status><satellites>11</satellites></fix></simkit:fix_types>
      <simkit:outages><window>1 2</window></simkit:outages>"""
    with simkit.load(world(errors)) as sim:
        kept = sim.subscribe("/fix/gps_fix")
        sim.run(1.5)
        first, last = kept.messages[0], kept.messages[-1]
        assert (first.status.status, first.status.satellites_used) == (1, 11)
        assert (last.status.status, last.status.satellites_used) == (-1, 0)
        assert math.isnan(last.latitude) and math.isnan(last.speed) and math.isnan(last.err)
        truth = sim.sensor("m::l::gps").truth
        assert truth.status.status == 0 and truth.latitude == pytest.approx(48.0)


@pytest.mark.parametrize(
    ("errors", "text"),
    [
        ("<simkit:outages><window>3 2</window></simkit:outages>", "the begin before the end"),
        ("<simkit:outages><area><box>1 2 3</box></area></simkit:outages>", "x_min y_min x_max y_max"),
        ("<simkit:outages><area/></simkit:outages>", "no shape"),
        ("<simkit:multipath><area><polygon>1 2 3 4</polygon></area></simkit:multipath>", "<polygon>1 2 3 4</polygon>"),
        ("<simkit:fix_types/>", "needs a <fix> without an <area>"),
        ("<simkit:fix_types><fix><status>rtk</status></fix></simkit:fix_types>", "one of no_fix, fix, sbas, gbas"),
    ],
)
def test_a_mistake_is_an_error_at_its_line(errors: str, text: str) -> None:
    with pytest.raises(SimkitError) as caught:
        simkit.load(world(errors))
    assert text in str(caught.value)

"""Timing: the grid and its phase, jitter, latency, rates that change, and their diagnostics."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from sensor_worlds import sensor, world

import simkit
from simkit.runtime.engine.simulated_time import Clock, SampleTiming

IMU = "<imu><angular_velocity><x>{}</x></angular_velocity></imu>"
NOISE = (
    '<noise type="gaussian"><stddev>0.1</stddev><dynamic_bias_stddev>0.3</dynamic_bias_stddev>'
    "<dynamic_bias_correlation_time>5</dynamic_bias_correlation_time></noise>"
)


def imu(extra: str = "", rate: float = 10, noise: str = "", name: str = "s", topic: str = "i") -> str:
    return sensor("imu", IMU.format(noise), rate=rate, extra=f"<topic>{topic}</topic>{extra}", name=name)


def load(extra: str = "", rate: float = 10, noise: str = "", top: str = "", seed: int = 0) -> Any:
    return simkit.load(world(imu(extra, rate, noise), top=top, static=False), seed=seed)


def stamp(message: Any) -> int:
    """Return the stamp of a message [ns]."""
    return int(message.header.stamp.sec) * 10**9 + int(message.header.stamp.nanosec)


class Arrivals:
    """Messages of a topic, each with its tick of arrival."""

    def __init__(self, sim: Any, topic: str = "/i") -> None:
        self.sim, self.messages, self.ticks = sim, [], []
        sim.subscribe(topic, callback=self._hear, keep=1)

    def _hear(self, message: Any) -> None:
        self.messages.append(message)
        self.ticks.append(self.sim.tick)

    @property
    def stamps(self) -> list[int]:
        """Return the stamps of all messages [ms]."""
        return [stamp(m) // 1_000_000 for m in self.messages]

    @property
    def rates(self) -> list[float]:
        return [m.angular_velocity.x for m in self.messages]


def codes(sim: Any) -> list[str]:
    return [d.code for d in sim.diagnostics if d.code.startswith("SK-SENSOR")]


# ---------------------------------------------------------------------- the grid


@pytest.mark.parametrize("step", [0.001, 0.004])
def test_many_sensors_at_odd_rates_keep_exactly_to_their_grids(step: float) -> None:
    rates = ["7.3", "62.5", "30", "0.3333333333333333", "100", "29.97", "1", "233"]
    parts = "".join(
        imu(name=f"s{i}", topic=f"t{i}", extra=f"<update_rate>{r}</update_rate>").replace(
            "<update_rate>10</update_rate>", ""
        )
        for i, r in enumerate(rates)
    )
    physics = f'<physics name="p" type="ode"><max_step_size>{step}</max_step_size></physics>'
    with simkit.load(world(parts, top=physics)) as sim:
        arrivals = [Arrivals(sim, f"/t{i}") for i in range(len(rates))]
        sim.run(7)
        for text, found in zip(rates, arrivals, strict=True):
            period = 1 / (Fraction(1, 3) if text.startswith("0.333") else Fraction(text)) / Fraction(str(step))
            expected = [1] + [math.ceil(k * period) for k in range(1, 2000) if k * period <= 7 / Fraction(str(step))]
            assert found.ticks == expected, text
            assert [stamp(m) for m in found.messages] == [sim.engine.clock.time_ns(t) for t in expected]


def test_gazebo_cuts_the_period_to_whole_milliseconds() -> None:
    with load(rate=30, top="<gazebo_quirks>true</gazebo_quirks>") as sim:
        arrivals = Arrivals(sim)
        sim.run(0.2)
        assert arrivals.stamps == [1, 33, 66, 99, 132, 165, 198]
    # Gazebo truncates this period to 0 ms and would hang
    with load(rate=5000, top="<gazebo_quirks>true</gazebo_quirks>") as sim:
        arrivals = Arrivals(sim)
        sim.run(0.003)
        assert arrivals.stamps == [1, 2, 3]


def test_a_phase_shifts_the_grid_and_the_first_sample() -> None:
    with load("<phase>0.0305</phase>") as sim:
        arrivals = Arrivals(sim)
        assert sim.sensor("m::l::s").latest is None
        sim.run(0.35)
        assert arrivals.stamps == [31, 131, 231, 331]
    with load("<phase>0.25</phase>") as sim:  # longer than a period, so the grid begins later
        arrivals = Arrivals(sim)
        sim.run(0.5)
        assert arrivals.stamps == [250, 350, 450]
    with load("<phase>0.25</phase>", rate=0) as sim:
        arrivals = Arrivals(sim)
        sim.run(0.252)
        assert arrivals.stamps == [250, 251, 252]


# ---------------------------------------------------------------------- jitter


def test_jitter_scatters_samples_evenly_around_the_grid_and_keeps_their_number() -> None:
    with load("<jitter>0.04</jitter>", seed=3) as sim:
        arrivals = Arrivals(sim)
        sim.run(60)
    stamps = np.array(arrivals.stamps)
    assert np.all(np.diff(stamps) > 0)
    assert len(stamps) in (600, 601)
    off = stamps[1:] - 100 * np.arange(1, len(stamps))
    assert abs(off).max() <= 40
    assert off.max() > 35 and off.min() < -35
    assert off.mean() == pytest.approx(0, abs=4 * 23 / math.sqrt(600))
    assert off.std() == pytest.approx(40 / math.sqrt(3), rel=0.08)


def test_the_jitter_of_a_sample_does_not_depend_on_earlier_samples() -> None:
    clock, draws = Clock(0.001), np.random.default_rng(0).uniform(-1, 1, 400)
    grid = clock.samples(SampleTiming(Fraction(1, 97), Fraction(1, 500), Fraction(1, 250), lambda k: float(draws[k])))
    assert grid is not None
    walked, tick = [], 0
    while len(walked) < 300:
        tick = grid.next(tick)
        walked.append(tick)
    assert all(a < b for a, b in itertools.pairwise(walked))
    for i in (0, 17, 150, 298):
        assert [grid.next(t) for t in range(walked[i], walked[i + 1])] == [walked[i + 1]] * (walked[i + 1] - walked[i])


@pytest.mark.parametrize("steps", [2, 3, 4, 5])
def test_jitter_of_nearly_half_a_short_period_never_loses_a_sample(steps: int) -> None:
    rate = 1000 / steps
    with load(f"<jitter>{0.4999 * steps / 1000}</jitter>", rate=rate) as sim:
        arrivals = Arrivals(sim)
        sim.run(2)
        assert len(arrivals.stamps) == pytest.approx(2000 / steps, abs=1)


def test_jitter_repeats_with_the_seed_and_after_reset_and_restore() -> None:
    def stamps(sim: Any) -> list[int]:
        arrivals = Arrivals(sim)
        sim.run(3)
        return arrivals.stamps

    with load("<jitter>0.03</jitter>", seed=1) as sim, load("<jitter>0.03</jitter>", seed=2) as other:
        first = stamps(sim)
        state = sim.snapshot()
        second = stamps(sim)
        sim.restore(state)
        assert stamps(sim) == second
        sim.reset()
        assert stamps(sim) == first
        assert stamps(other) != first
        sim.reset(seed=2)
        other.reset()
        assert stamps(sim) == stamps(other)


# ---------------------------------------------------------------------- latency


def test_latency_delays_the_arrival_and_changes_no_content() -> None:
    with load("<latency>0.2503</latency>", noise=NOISE) as late, load(noise=NOISE) as early:
        after, before = Arrivals(late), Arrivals(early)
        late.run(2)
        early.run(2)
        assert after.stamps == before.stamps[: len(after.stamps)]
        assert [t - s for t, s in zip(after.ticks, after.stamps, strict=True)] == [251] * len(after.ticks)
        assert after.rates == before.rates[: len(after.rates)]
        newest = late.sensor("m::l::s")
        assert stamp(newest.latest) == stamp(newest.truth) == 1_700_000_000
        assert newest.truth.angular_velocity.x == 0.0


def test_it_is_measured_when_it_is_due_and_not_when_it_arrives() -> None:
    source = world(imu("<latency>0.1</latency>", rate=0), static=False, top="<gravity>0 0 0</gravity>")
    with simkit.load(source) as sim:
        arrivals, unread = Arrivals(sim), sim.sensor("m::l::s")
        sim.run(0.05)
        sim.model("m").set_velocity((0, 0, 0), (0.7, 0, 0))
        sim.run(0.1)
        assert unread.latest.angular_velocity.x == 0.0
        sim.run(0.001)
        assert unread.latest.angular_velocity.x == pytest.approx(0.7)
        assert [t for t, x in zip(arrivals.stamps, arrivals.rates, strict=True) if x] == [51]


def test_the_time_of_subscription_changes_no_late_reading() -> None:
    def values(listen: tuple[float, float]) -> list[Any]:
        out, (begin, end) = [], listen
        with load(
            "<latency>0.35</latency><latency_jitter>0.2</latency_jitter><jitter>0.03</jitter>", noise=NOISE
        ) as sim:
            read = None
            for _ in range(30):
                if read is None and sim.time >= begin:
                    read = sim.subscribe("/i")
                elif read is not None and sim.time >= end:
                    read.close()
                sim.run(0.1)
                latest = sim.sensor("m::l::s").latest if sim.time > 2.5 else None
                out.append(latest and (stamp(latest), latest.angular_velocity.x))
        return out

    everyone = values((0, 9))
    assert everyone[-1]
    assert values((9, 9)) == values((0.7, 9)) == values((0.2, 1.1)) == everyone


def test_late_readings_keep_their_order_when_latency_varies() -> None:
    with load("<latency>0.3</latency><latency_jitter>0.3</latency_jitter>", rate=20) as sim:
        arrivals = Arrivals(sim)
        sim.run(20)
        assert arrivals.stamps == sorted(arrivals.stamps)
        delays = np.array(arrivals.ticks) - np.array(arrivals.stamps)
        assert delays.min() >= 0 and delays.max() <= 600
        assert np.ptp(delays) > 300


def test_readings_on_their_way_survive_a_restore_and_not_a_reset() -> None:
    with load("<latency>0.55</latency><latency_jitter>0.1</latency_jitter>", noise=NOISE) as sim:
        arrivals = Arrivals(sim)
        sim.run(1.03)
        state = sim.snapshot()
        count = len(arrivals.stamps)
        sim.run(2)
        first = arrivals.ticks[count:], arrivals.stamps[count:], arrivals.rates[count:]
        assert first[1][0] < 1000
        sim.restore(state)
        count = len(arrivals.stamps)
        sim.run(2)
        assert (arrivals.ticks[count:], arrivals.stamps[count:], arrivals.rates[count:]) == first
        sim.reset()
        assert sim.sensor("m::l::s").latest is None
        count = len(arrivals.stamps)
        sim.run(0.7)
        assert arrivals.stamps[count] == 1


def test_readings_on_their_way_survive_a_spawn_and_a_new_rate() -> None:
    with load("<latency>0.25</latency>", noise=NOISE) as sim, load("<latency>0.25</latency>", noise=NOISE) as plain:
        arrivals, other = Arrivals(sim), Arrivals(plain)
        sim.run(0.52)
        sim.spawn('<sdf version="1.9"><model name="new"><static>true</static><link name="l"/></model></sdf>')
        sim.run(0.01)
        sim.sensor("m::l::s").set_rate(4)
        sim.run(1)
        plain.run(1.53)
        assert arrivals.stamps == [1, 100, 200, 300, 400, 500, 750, 1000, 1250]
        assert arrivals.rates[:6] == other.rates[:6]
        assert [t - s for t, s in zip(arrivals.ticks, arrivals.stamps, strict=True)] == [250] * 9


# ---------------------------------------------------------------------- rates that change


def test_a_new_rate_stays_on_the_grid_of_the_beginning() -> None:
    with load("<phase>0.013</phase>", rate=100) as sim:
        arrivals = Arrivals(sim)
        sim.run(0.0405)
        sim.sensor("m::l::s").set_rate(20)
        sim.run(0.16)
        sim.sensor("m::l::s").set_rate(1 / 3)
        sim.run(6)
        assert arrivals.stamps == [13, 23, 33, 63, 113, 163, 3013, 6013]


def test_a_rate_may_come_from_a_topic() -> None:
    with load("<set_rate_topic>rate</set_rate_topic>") as sim:
        assert sim.topics()["/rate"] == "std_msgs/msg/Float64"
        arrivals = Arrivals(sim)
        sim.run(0.25)
        sim.publish("/rate", {"data": 20.0})
        sim.run(0.25)
        assert arrivals.stamps == [1, 100, 200, 300, 350, 400, 450, 500]
        for wrong in (-1.0, math.nan):
            sim.publish("/rate", {"data": wrong})
        sim.run(0.01)
        assert codes(sim) == ["SK-SENSOR-026"] * 2
        assert sim.sensor("m::l::s").update_rate == 20


def test_gazebo_takes_no_rate_above_the_files() -> None:
    with load("<set_rate_topic>rate</set_rate_topic>", top="<gazebo_quirks>true</gazebo_quirks>") as sim:
        for rate, then in ((20.0, 10), (0.0, 10), (5.0, 5)):
            sim.publish("/rate", {"data": rate})
            sim.run(0.01)
            assert sim.sensor("m::l::s").update_rate == then


def test_a_restore_brings_the_rate_back() -> None:
    with load() as sim:
        state = sim.snapshot()
        sim.sensor("m::l::s").set_rate(50)
        sim.restore(state)
        arrivals = Arrivals(sim)
        sim.run(0.3)
        assert arrivals.stamps == [1, 100, 200, 300]


def test_a_snapshot_remembers_the_seed() -> None:
    with load(noise=NOISE, seed=4) as sim:
        arrivals = Arrivals(sim)
        sim.run(0.55)
        state = sim.snapshot()
        sim.run(1)
        expected = arrivals.rates[6:]
        sim.reset(seed=9)
        sim.run(0.3)
        sim.restore(state)
        count = len(arrivals.rates)
        sim.run(1)
        assert arrivals.rates[count:] == expected
        assert sim.engine.streams.seed == 4


# ---------------------------------------------------------------------- what is said


@pytest.mark.parametrize(
    ("extra", "rate", "code"),
    [
        ("<jitter>0.05</jitter>", 10, "SK-SENSOR-022"),
        ("<latency>0.1</latency><latency_jitter>0.2</latency_jitter>", 10, "SK-SENSOR-022"),
        ("<latency>-1</latency>", 10, "SK-PARAM-002"),
        ("<latency>nan</latency>", 10, "SK-PARAM-002"),
        ("<phase>soon</phase>", 10, "SK-PARAM-002"),
        ("<always_on>maybe</always_on>", 10, "SK-PARAM-002"),
    ],
)
def test_impossible_timing_is_an_error(extra: str, rate: float, code: str) -> None:
    with pytest.raises(simkit.LoadError) as caught:
        load(extra, rate)
    assert [d.code for d in caught.value.diagnostics if d.severity == "error"] == [code]
    assert caught.value.diagnostics[0].line is not None


@pytest.mark.parametrize(
    ("extra", "rate", "expected"),
    [
        ("<jitter>0.01</jitter>", 0, ["SK-SENSOR-023"]),
        ("<jitter>0.0001</jitter>", 10, ["SK-SENSOR-023"]),
        ("<enable_metrics>true</enable_metrics>", 10, ["SK-SENSOR-025"]),
        ("<always_on>true</always_on><visualize>true</visualize>", 10, []),
        ("", 1e9, ["SK-SENSOR-028"]),
        ("", 1000, []),
        ("", 30, []),
    ],
)
def test_options_without_effect_are_reported(extra: str, rate: float, expected: list[str]) -> None:
    with load(extra, rate) as sim:
        assert codes(sim) == expected


JOINT = """<sdf version="1.9"><model name="m"><link name="a">{link}</link><link name="b"/>
  <joint name="j" type="fixed"><parent>a</parent><child>{child}</child>{joint}</joint></model></sdf>"""


@pytest.mark.parametrize("place", ["link", "joint"])
def test_a_sensor_under_the_wrong_parent_is_left_out_with_a_warning(place: str) -> None:
    kind = {"link": "force_torque", "joint": "imu"}[place]
    parts = {"link": "", "joint": "", "child": "b", place: f'<sensor name="s" type="{kind}"/>'}
    with simkit.load(JOINT.format(**parts)) as sim:
        (found,) = [d for d in sim.diagnostics if d.severity == "warning"]
        assert found.code == "SK-SENSOR-024"
        assert {"link": "belongs to a joint", "joint": "belongs to a link"}[place] in found.message
        assert not sim.contents.sensors
        sim.step(10)
    with pytest.raises(simkit.LoadError):
        simkit.load(JOINT.format(**parts), strict=True)


def test_a_sensor_on_a_joint_without_a_child_is_reported_without_a_traceback() -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(JOINT.format(link="", child="nobody", joint='<sensor name="s" type="force_torque"/>'))
    assert [d.code for d in caught.value.diagnostics if d.severity == "error"] == ["SK-SDF-004"]


def test_a_rate_below_zero_is_every_step_as_in_gazebo() -> None:
    """Some of Gazebo's own worlds contain `<update_rate>-1`."""
    with load(rate=-1) as sim:
        sub = sim.subscribe("/i")
        sim.step(7)
        assert len(sub.messages) == 7
        assert sim.sensor("m::l::s").update_rate == 0
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-029"] == ["note"]


@pytest.mark.parametrize("kind", ["imu", "contact"])
def test_a_topic_without_a_letter_or_digit_is_an_error(kind: str) -> None:
    topic = "<topic>@@@/</topic>"
    bad = f'<sensor name="s" type="{kind}">{f"<contact>{topic}</contact>" if kind == "contact" else topic}</sensor>'
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(bad))
    (error,) = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert error.code == "SK-PARAM-002"
    assert "@@@/" in error.message


def test_a_rate_topic_without_a_letter_is_an_error() -> None:
    with pytest.raises(simkit.LoadError) as caught:
        load("<set_rate_topic>\u00fc</set_rate_topic>")
    (found,) = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert found.code == "SK-PARAM-002" and "<set_rate_topic>" in found.message

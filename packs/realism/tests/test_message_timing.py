"""Late messages, gaps and stamps follow the histograms and numbers of the file, and repeat after reset and restore."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import simkit
from simkit.errors import SimkitError

WORLD = """
<sdf version="1.9" xmlns:simkit="simkit"><world name="w">
  <physics type="ode"><max_step_size>0.002</max_step_size></physics>
  <model name="m"><static>true</static><link name="l">
    <sensor name="height" type="altimeter"><update_rate>{rate}</update_rate><topic>height</topic>
      <altimeter><vertical_position><noise type="gaussian"><stddev>1</stddev></noise></vertical_position></altimeter>
      {timing}
    </sensor>
  </link></model>
</world></sdf>"""
HISTOGRAM = """<simkit:latency_histogram><values>0 0.004 0.05</values><weights>2 5 3</weights>
<keep_order>{keep}</keep_order></simkit:latency_histogram>"""
BURSTS = """<simkit:gaps><probability>0.1</probability>
<values>1 2 6</values><weights>6 3 1</weights></simkit:gaps>"""


def world(timing: str, rate: float = 500.0) -> str:
    return WORLD.format(timing=timing, rate=rate)


def stamp_ns(message: object) -> int:
    stamp = message.header.stamp
    return int(stamp.sec * 1_000_000_000 + stamp.nanosec)


def received(text: str, duration: float, seed: int = 0) -> list[tuple[int, int, float]]:
    """Return arrival [ns], stamp [ns] and height of each message."""
    rows: list[tuple[int, int, float]] = []
    with simkit.load(text, seed=seed) as sim:
        sim.subscribe("/height", lambda m: rows.append((sim.time_ns, stamp_ns(m), m.vertical_position)))
        sim.run(duration)
    return rows


def test_latencies_have_the_weights_of_the_histogram() -> None:
    rows = received(world(HISTOGRAM.format(keep="false")), 6.0)
    counts = Counter(arrival - stamp for arrival, stamp, _ in rows)
    total = sum(counts.values())
    assert set(counts) == {0, 4_000_000, 50_000_000}
    for latency, share in ((0, 0.2), (4_000_000, 0.5), (50_000_000, 0.3)):
        assert abs(counts[latency] / total - share) < 4 * np.sqrt(share * (1 - share) / total)


def test_messages_keep_their_order_unless_the_file_says_otherwise() -> None:
    ordered = received(world(HISTOGRAM.format(keep="true")), 2.0)
    stamps = [stamp for _, stamp, _ in ordered]
    assert stamps == sorted(stamps)
    free = received(world(HISTOGRAM.format(keep="false")), 2.0)
    stamps = [stamp for _, stamp, _ in free]
    arrivals = [arrival for arrival, _, _ in free]
    assert arrivals == sorted(arrivals) and stamps != sorted(stamps)
    # the same readings arrive, only their order differs
    first, second = ({stamp: height for _, stamp, height in rows} for rows in (ordered, free))
    common = first.keys() & second.keys()
    assert len(common) > 900 and all(first[stamp] == second[stamp] for stamp in common)


def test_the_latency_of_the_file_is_added_to_the_drawn_one() -> None:
    drawn = "<simkit:latency_histogram><values>0.01</values></simkit:latency_histogram>"
    rows = received(world("<latency>0.02</latency>" + drawn, rate=50), 1.0)
    assert {arrival - stamp for arrival, stamp, _ in rows} == {30_000_000}


def test_a_bin_width_spreads_the_latencies_over_their_bin() -> None:
    drawn = "<simkit:latency_histogram><values>0.2</values><bin_width>0.2</bin_width></simkit:latency_histogram>"
    rows = received(world(drawn.replace("</values>", "</values><keep_order>false</keep_order>")), 4.3)
    latencies = np.array([arrival - stamp for arrival, stamp, _ in rows if stamp < 4e9]) * 1e-9
    assert 0.1 <= latencies.min() < 0.104 and 0.298 < latencies.max() <= 0.302
    # arrivals are on the grid of steps, on average half a step late
    assert abs(latencies.mean() - 0.201) < 4 * 0.2 / np.sqrt(12 * len(latencies))


def test_a_histogram_can_be_a_file_beside_the_world(tmp_path: Path) -> None:
    (tmp_path / "late.csv").write_text("\ufeff# recorded\nseconds,weight\n0.004,3\n\n0.02,1\n", encoding="utf-8")
    timing = "<simkit:latency_histogram><file>late.csv</file><keep_order>0</keep_order></simkit:latency_histogram>"
    (tmp_path / "w.sdf").write_text(world(timing))
    rows = received(str(tmp_path / "w.sdf"), 4.0)
    late = np.mean([arrival - stamp == 20_000_000 for arrival, stamp, _ in rows])
    assert abs(late - 0.25) < 4 * np.sqrt(0.25 * 0.75 / len(rows))


@pytest.mark.parametrize(
    ("timing", "text"),
    [
        ("<latency_histogram><values>1 2</values><weights>1</weights></latency_histogram>", "2 <values> and 1 <weigh"),
        ("<latency_histogram><values>1 x</values></latency_histogram>", "'x'"),
        ("<latency_histogram><values>-1</values></latency_histogram>", "'-1'"),
        ("<latency_histogram><values>1</values><weights>0</weights></latency_histogram>", "no weight above 0"),
        ("<latency_histogram><file>no.csv</file></latency_histogram>", "there is no file 'no.csv'"),
        ("<latency_histogram/>", "needs <values> or <file>"),
        ("<gaps><probability>0.1</probability><values>1.5</values></gaps>", "'1.5'"),
        ("<gaps><mean_length>3</mean_length></gaps>", "needs <probability>"),
    ],
)
def test_a_wrong_histogram_is_an_error_at_its_line(timing: str, text: str) -> None:
    timing = timing.replace("<latency_h", "<simkit:latency_h").replace("</latency_h", "</simkit:latency_h")
    timing = timing.replace("<gaps", "<simkit:gaps").replace("</gaps", "</simkit:gaps")
    with pytest.raises(SimkitError) as caught:
        simkit.load(world(timing))
    assert text in str(caught.value)


def gap_lengths(rows: list[tuple[int, int, float]], period_ns: int) -> list[int]:
    stamps = np.array([stamp for _, stamp, _ in rows])
    lengths: list[int] = (np.diff(stamps) // period_ns - 1).tolist()
    return lengths


def test_gaps_begin_and_last_as_the_histogram_says() -> None:
    lengths = gap_lengths(received(world(BURSTS), 20.0), 2_000_000)
    gaps = [length for length in lengths if length > 0]
    counts = Counter(gaps)
    assert set(counts) == {1, 2, 6}
    for length, share in ((1, 0.6), (2, 0.3), (6, 0.1)):
        assert abs(counts[length] / len(gaps) - share) < 4 * np.sqrt(share * (1 - share) / len(gaps))
    # a gap may begin after each message that arrives
    assert abs(len(gaps) / len(lengths) - 0.1) < 4 * np.sqrt(0.1 * 0.9 / len(lengths))


def test_gaps_with_a_mean_length_are_geometric() -> None:
    timing = "<simkit:gaps><probability>0.05</probability><mean_length>4</mean_length></simkit:gaps>"
    gaps = np.array([n for n in gap_lengths(received(world(timing), 40.0), 2_000_000) if n > 0])
    assert abs(gaps.mean() - 4) < 4 * np.sqrt(12 / len(gaps))
    # the variance of a geometric distribution with the mean 4 is 12
    assert abs((gaps == 1).mean() - 0.25) < 4 * np.sqrt(0.25 * 0.75 / len(gaps))


def test_the_latest_message_is_the_last_that_arrived() -> None:
    timing = "<simkit:gaps><probability>1</probability><values>4</values></simkit:gaps>"
    with simkit.load(world(timing, rate=100)) as sim:
        sim.run(0.06)
        sensor = sim.sensor("m::l::height")
        # samples 1 to 4 are lost, the fifth arrives, and the next gap begins after it
        assert sensor.count == 7 and stamp_ns(sensor.latest) == stamp_ns(sensor.truth) == 40_000_000


def test_stamps_follow_the_clock_and_the_truth_keeps_the_time() -> None:
    timing = "<simkit:clock><offset>0.25</offset><drift>1e-3</drift></simkit:clock>"
    with simkit.load(world(timing, rate=10)) as sim:
        sim.run(2.05)
        sensor = sim.sensor("m::l::height")
        assert stamp_ns(sensor.truth) == 2_000_000_000
        assert stamp_ns(sensor.latest) == 2_252_000_000


def test_a_driver_can_stamp_at_the_arrival() -> None:
    timing = HISTOGRAM.format(keep="false") + "<simkit:clock><stamp>arrival</stamp></simkit:clock>"
    rows = received(world(timing), 0.5)
    assert all(arrival == stamp for arrival, stamp, _ in rows) and len(rows) > 200


def test_a_negative_offset_never_gives_a_stamp_before_the_epoch() -> None:
    rows = received(world("<simkit:clock><offset>-0.1</offset></simkit:clock>", rate=100), 0.3)
    assert {stamp for _, stamp, _ in rows if stamp < 5_000_000} == {0}
    assert rows[-1][1] == rows[-1][0] - 100_000_000


def test_reset_and_restore_in_a_gap_repeat_the_messages() -> None:
    text = world(HISTOGRAM.format(keep="false") + BURSTS + "<simkit:clock><drift>1e-4</drift></simkit:clock>")
    with simkit.load(text, seed=3) as sim:
        rows: list[tuple[int, int, float]] = []
        sim.subscribe("/height", lambda m: rows.append((sim.time_ns, stamp_ns(m), m.vertical_position)))
        sim.run(0.5)
        first = list(rows)
        state = sim.snapshot()
        rows.clear()
        sim.run(0.5)
        after = list(rows)
        sim.restore(state)
        rows.clear()
        sim.run(0.5)
        assert rows == after and len(after) > 50
        rows.clear()
        sim.reset()
        sim.run(0.5)
        assert rows == first


def test_messages_do_not_depend_on_who_listens() -> None:
    text = world(HISTOGRAM.format(keep="true") + BURSTS)
    with simkit.load(text) as sim:
        sim.run(1.0)
        rows: list[tuple[int, int, float]] = []
        sim.subscribe("/height", lambda m: rows.append((sim.time_ns, stamp_ns(m), m.vertical_position)))
        sim.run(1.0)
    assert rows == [row for row in received(text, 2.0) if row[0] > 1_000_000_000]


@pytest.mark.parametrize("kind", ["imu", "lidar"])
def test_sensors_that_gather_their_samples_lose_the_same_messages(kind: str) -> None:
    block = "" if kind == "imu" else "<lidar><range><min>0.1</min><max>5</max></range></lidar>"
    text = (
        WORLD.replace('type="altimeter"', f'type="{kind}"')
        .replace("<altimeter>", "<!--")
        .replace("</altimeter>", f"-->{block}")
    )
    text = text.format(timing=BURSTS, rate=100)
    with simkit.load(text) as sim:
        kept = sim.subscribe("/height")
        sim.run(1.0)
        stamps = [stamp_ns(message) for message in kept.messages]
    expected = [stamp for _, stamp, _ in received(world(BURSTS, rate=100), 1.0)]
    assert stamps == expected


SWEPT = """<sdf version="1.9" xmlns:simkit="simkit"><world name="w">
  <physics type="ode"><max_step_size>0.002</max_step_size></physics>
  <model name="m"><static>true</static><link name="l">
    <sensor name="scan" type="lidar"><update_rate>10</update_rate><topic>scan</topic><simkit:sweep>true</simkit:sweep>
      <lidar><scan><horizontal><samples>36</samples><min_angle>-3.14</min_angle><max_angle>3.14</max_angle></horizontal>
        </scan><range><min>0.1</min><max>10</max></range></lidar>{timing}
    </sensor></link></model></world></sdf>"""


def test_a_scan_that_sweeps_is_late_lost_and_stamped_as_any_other() -> None:
    timing = """<simkit:latency_histogram><values>0.25</values></simkit:latency_histogram>
      <simkit:gaps><probability>0.3</probability><values>2</values></simkit:gaps>
      <simkit:clock><offset>1</offset></simkit:clock>"""
    rows = []
    with simkit.load(SWEPT.format(timing=timing)) as sim:
        sim.subscribe("/scan", lambda m: rows.append((sim.time_ns, stamp_ns(m) - 1_000_000_000)))
        sim.run(5.0)
    # the stamp is the time of the first ray; the last ray is a turn of almost 0.1 s later
    assert all(340_000_000 < arrival - stamp <= 352_000_000 for arrival, stamp in rows)
    steps = np.diff([stamp for _, stamp in rows]) // 100_000_000
    assert set(steps.tolist()) == {1, 3} and 10 < len(rows) < 45

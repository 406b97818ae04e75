"""Differences between two runs and their descriptions."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from made_up import (
    CONTACTS,
    IMU,
    JOINTS,
    MACHINE,
    ODOM,
    OTHER_MACHINE,
    SCAN,
    hashed,
    record,
    rounded,
    states,
    stream,
    times,
)

from simkit.run_spec import Tolerance
from simkit.testing.golden.compare.runs import compare
from simkit.testing.run_record.record import Column, Stream

STEP = 2.0**-15


def scan(change: Any = None, *, when: Any = None, **settings: float) -> Stream:
    """Return two seconds of a lidar with 360 rays; `change` may modify the array (messages, rays)."""
    when = times(20, 10.0, 0.1) if when is None else when
    ranges = np.full((len(when), 360), 2.0, np.float32)
    ranges += np.linspace(0.0, 0.5, 360, dtype=np.float32)
    ranges[:, 300:] = np.inf
    if change is not None:
        change(ranges)
    fields = {"range_max": 3.5, **settings}
    columns = {"ranges": ranges, **{k: np.full(len(when), v, np.float32) for k, v in fields.items()}}
    return stream("/scan", SCAN, when, columns, {"header.frame_id": ["lidar"] * len(when)})


def imu(noise: float = 1.0, *, seed: int = 0, when: Any = None) -> Stream:
    when = times(400, 200.0) if when is None else when
    draws = np.random.default_rng(seed).standard_normal((len(when), 3)) * noise * 0.01
    return stream("/imu", IMU, when, {f"linear_acceleration.{axis}": draws[:, i] for i, axis in enumerate("xyz")})


def words(golden: Any, run: Any, **options: Any) -> list[str]:
    return [d.words for d in compare(golden, run, **options).differences]


def golden_of(*streams: Stream, step: float = STEP, **more: Any) -> Any:
    return record(*(rounded(s, step) for s in streams), **more)


# ---------------------------------------------------------------------- the same machine


def test_a_repeated_run_passes_although_the_golden_run_is_rounded() -> None:
    found = compare(golden_of(scan(), imu()), record(scan(), imu()))
    assert found.passed and found.tier == "exact" and not found.notes
    assert (found.topics, found.messages) == (2, 420)


def test_different_rays_are_reported_with_number_sign_and_time() -> None:
    def nearer(ranges: Any) -> None:
        ranges[11:, 45:59] += 0.012

    (found,) = compare(golden_of(scan()), record(scan(nearer))).differences
    assert found.words == "/scan.ranges: 14 of 360 rays (45 to 58) +12 mm from t = 1.20 s"
    assert (found.topic, found.field, found.kind, found.unit, found.index) == ("/scan", "ranges", "value", "m", 11)
    assert found.time == pytest.approx(1.2) and found.size == pytest.approx(0.012, abs=2 * STEP)


def test_a_growing_difference_reports_its_largest_value() -> None:
    def away(ranges: Any) -> None:
        ranges[5:, 10] -= 0.002 * np.arange(1, len(ranges) - 4)

    (said,) = words(golden_of(scan()), record(scan(away)))
    assert said == "/scan.ranges: 1 of 360 rays (number 10) −2 mm from t = 0.60 s, up to −30 mm at t = 2.00 s"


def test_one_different_message_and_every_third_are_described_differently() -> None:
    def once(ranges: Any) -> None:
        ranges[4] += 0.5

    def now_and_then(ranges: Any) -> None:
        ranges[4::3] += 0.5

    assert "at t = 0.50 s, in that message only" in words(golden_of(scan()), record(scan(once)))[0]
    assert "from t = 0.50 s, in 6 of 16 messages" in words(golden_of(scan()), record(scan(now_and_then)))[0]


def test_differences_of_both_signs_and_lost_hits_are_described() -> None:
    def mixed(ranges: Any) -> None:
        ranges[3:, 0:10:2] += 0.02
        ranges[3:, 1:10:2] -= 0.02
        ranges[3:, 20:22] = np.inf
        ranges[3:, 310] = 1.0
        ranges[3:, 30] = np.nan

    said = words(golden_of(scan()), record(scan(mixed)))[0]
    assert said == (
        "/scan.ranges: 14 of 360 rays up to ±20 mm, 1 became NaN, 2 became infinite, 1 became finite from t = 0.40 s"
    )


def test_infinity_equals_infinity_and_nan_equals_nan() -> None:
    def nothing(ranges: Any) -> None:
        ranges[:, :5] = np.nan
        ranges[:, 5:9] = -np.inf

    assert not words(golden_of(scan(nothing)), record(scan(nothing)), exact=False)


def test_a_changed_constant_is_described_as_a_setting() -> None:
    assert words(golden_of(scan(), step=2**-20), record(scan(range_max=4.0))) == [
        "/scan.range_max: 3.5 m became 4 m",
    ]


def test_a_difference_below_the_rounding_is_a_difference_in_bits() -> None:
    def a_little(ranges: Any) -> None:
        ranges[12, 7] += 1e-6

    (found,) = compare(golden_of(scan()), record(scan(a_little))).differences
    assert found.kind == "bits" and math.isnan(found.size)
    assert found.words == "/scan: bits differ from t in 1–2 s, by less than 15.3 µm"


def test_differences_at_one_time_are_sorted_by_their_ratio_to_the_tolerance() -> None:
    other = imu()
    other.columns["linear_acceleration.x"].values[100:] += 0.001
    other.columns["linear_acceleration.z"].values[100:] += 0.5
    found = compare(golden_of(imu()), record(hashed(other))).differences
    assert [d.field for d in found] == ["linear_acceleration.z", "linear_acceleration.x"]


def test_differences_come_in_the_order_of_time() -> None:
    def late(ranges: Any) -> None:
        ranges[15:] += 1.0

    other = imu()
    other.columns["linear_acceleration.y"].values[10:] += 1.0
    found = compare(golden_of(imu(), scan()), record(hashed(other), scan(late))).differences
    assert [d.topic for d in found] == ["/imu", "/scan"]


# ---------------------------------------------------------------------- counts, times, topics


def test_a_changed_rate_is_reported_in_hertz_and_messages() -> None:
    when = np.unique(np.ceil(np.arange(1, 403) / 201.0 * 1000.0)).astype(np.int64) * 1_000_000
    golden = imu(when=times(400, 200.0, 0.005))
    (found,) = compare(golden_of(golden), record(imu(when=when))).differences
    assert found.kind == "count" and found.unit == "Hz" and found.size == pytest.approx(1.0, abs=0.1)
    assert found.words == "/imu: 200 Hz became 201 Hz: 400 messages became 402"


def test_streams_that_end_early_or_start_late_are_described() -> None:
    short = words(golden_of(imu()), record(imu(when=times(300, 200.0))))
    assert any(s == "/imu: ends at t = 1.495 s: 400 messages became 300" for s in short)
    late = words(golden_of(imu()), record(imu(when=times(400, 200.0) + 3_000_000)))
    assert late == ["/imu: every message is sent 3 ms later"]


def test_values_are_compared_up_to_the_first_different_time() -> None:
    def near_the_end(ranges: Any) -> None:
        ranges[12:] += 1.0

    when = times(20, 10.0, 0.1)
    when[8:] += 50_000_000
    found = compare(golden_of(scan()), record(scan(near_the_end, when=when))).differences
    assert [d.kind for d in found] == ["time"]
    assert found[0].words == "/scan: message 9 is sent 50 ms later at t = 0.95 s; 20 messages as before"


def test_a_missing_and_a_new_topic_are_both_named() -> None:
    renamed = replace(imu(), topic="/imu/data")
    found = compare(golden_of(imu(), scan()), record(scan(), renamed)).differences
    assert [(d.kind, d.words) for d in found] == [
        ("missing", f"/imu: is gone, 400 messages of {IMU} are missing; /imu/data of its type is new"),
        ("extra", f"/imu/data: is new, 400 messages of {IMU}"),
    ]


def test_a_changed_message_type_is_reported_and_not_compared() -> None:
    other = replace(scan(), topic="/imu")
    assert words(golden_of(imu()), record(other)) == [f"/imu: {IMU} became {SCAN}"]


# ---------------------------------------------------------------------- joints, contacts, orientations, texts


def joints(off: float = 0.0) -> Stream:
    when = times(40, 20.0)
    position = np.outer(np.arange(40), (0.1, 0.2)) + np.array([off, 0.0]) * (np.arange(40) >= 10)[:, None]
    return stream("/joint_states", JOINTS, when, {"position": position}, {"name": ["left, right"] * 40})


def test_joints_are_compared_by_name_with_the_unit_of_their_type() -> None:
    turning = {"models[m].joints[left].type": "continuous", "models[m].joints[right].type": "revolute"}
    sliding = dict.fromkeys(turning, "prismatic")
    golden = golden_of(joints())
    assert words(golden, record(joints(0.01)))[0].startswith("/joint_states.position: left +0.01 rad or m from t = 0.5")
    assert words(golden, record(joints(0.01), leaves=turning))[0].startswith(
        "/joint_states.position: left +0.573° from"
    )
    assert words(golden, record(joints(0.01), leaves=sliding))[0].startswith("/joint_states.position: left +10 mm from")


def test_changed_lengths_of_lists_are_reported() -> None:
    lengths = np.ones(10, np.int64)
    more = lengths.copy()
    more[4:] = 3
    golden = stream("/bumper", CONTACTS, times(10, 10.0), {"contacts.depths": Column(np.zeros(10), lengths)})
    run = stream("/bumper", CONTACTS, times(10, 10.0), {"contacts.depths": Column(np.zeros(int(more.sum())), more)})
    (found,) = compare(golden_of(golden), record(run)).differences
    assert found.kind == "count" and found.words == "/bumper.contacts.depths: 1 contacts became 3 at t = 0.40 s"


def odom(yaw: float = 0.0, roll: float = 0.0, sign: float = 1.0) -> Stream:
    half = 0.5 * np.where(np.arange(50) >= 20, yaw, 0.0) + 0.3
    quaternion = np.stack([np.zeros(50), np.zeros(50), np.sin(half), np.cos(half)])
    if roll:
        quaternion = np.stack(
            [np.full(50, math.sin(roll / 2)), np.zeros(50), np.zeros(50), np.full(50, math.cos(roll / 2))]
        )
    columns = {f"pose.pose.orientation.{axis}": sign * quaternion[i] for i, axis in enumerate("xyzw")}
    return stream("/odom", ODOM, times(50, 50.0), columns)


def test_an_orientation_is_one_angle_about_an_axis() -> None:
    (found,) = compare(golden_of(odom()), record(odom(yaw=math.radians(-2.0)))).differences
    assert found.words == "/odom.pose.pose.orientation: −2° about z from t = 0.40 s"
    assert found.field == "pose.pose.orientation" and found.unit == "rad"
    assert found.columns == tuple(f"pose.pose.orientation.{axis}" for axis in "xyzw")
    assert found.size == pytest.approx(math.radians(2.0), abs=2 * STEP)


def test_a_quaternion_and_its_negative_are_the_same_rotation() -> None:
    assert not words(golden_of(odom()), record(odom(sign=-1.0)), exact=False)
    (said,) = words(golden_of(odom()), record(odom(sign=-1.0)))
    assert "the same rotation with opposite quaternion sign" in said


def test_quaternions_that_are_not_unit_length_are_compared_as_numbers() -> None:
    nothing = {f"orientation.{axis}": np.zeros(5) for axis in "xyzw"}
    some = {**nothing, "orientation.x": np.full(5, 0.5)}
    golden, run = (stream("/imu", IMU, times(5, 5.0), columns) for columns in (nothing, some))
    assert [d.field for d in compare(golden_of(golden), record(run)).differences] == ["orientation.x"]


def test_both_texts_are_shown() -> None:
    other = scan()
    other.words["header.frame_id"][7:] = ["laser"] * 13
    (found,) = compare(golden_of(scan()), record(hashed(other))).differences
    assert found.kind == "text"
    assert found.words == "/scan.header.frame_id: “lidar” became “laser” from t = 0.80 s"


# ---------------------------------------------------------------------- another machine


def test_another_machine_is_compared_with_tolerances_and_its_differences_are_listed() -> None:
    def a_little(ranges: Any) -> None:
        ranges += 3e-4

    found = compare(golden_of(scan()), record(scan(a_little), machine=OTHER_MACHINE))
    assert found.passed and found.tier == "tolerant"
    assert found.machine == {"mujoco": ("4.0.0", "4.0.1")}
    (note,) = found.notes
    assert note.startswith("/scan.ranges: up to 0.3 mm off") and "within 1 mm +" in note


def test_other_instructions_of_numpy_and_blas_allow_no_difference() -> None:
    def a_little(ranges: Any) -> None:
        ranges += 3e-4

    here = {**MACHINE, "processor features": "AVX512F OPENBLAS_CORETYPE=Zen"}
    found = compare(golden_of(scan()), record(scan(a_little), machine=here))
    assert not found.passed and found.tier == "exact" and not found.machine


def test_another_ray_tracer_allows_differences_in_topics_of_rays_only() -> None:
    here = {**MACHINE, "ray tracer": "embree 4.4.0 avx2"}

    def a_little(ranges: Any) -> None:
        ranges += 3e-4

    found = compare(golden_of(scan(), imu()), record(scan(a_little), imu(), machine=here))
    assert found.passed and found.tier == "exact" and not found.is_identical
    assert found.machine == {"ray tracer": ("", "embree 4.4.0 avx2")}
    shifted = imu()
    shifted.columns["linear_acceleration.z"].values[:] += 1e-4
    assert words(golden_of(scan(), imu()), record(scan(), hashed(shifted), machine=here))


def test_equal_bits_of_another_machine_are_identical_and_cannot_be_blessed() -> None:
    same = compare(golden_of(scan()), record(scan(), machine=OTHER_MACHINE))
    assert same.tier == "tolerant" and same.is_identical and not same.can_be_blessed

    def a_little(ranges: Any) -> None:
        ranges += 3e-4

    near = compare(golden_of(scan()), record(scan(a_little), machine=OTHER_MACHINE))
    assert near.passed and not near.is_identical and near.can_be_blessed


def test_a_share_of_the_rays_may_differ_more_on_another_machine() -> None:
    def edges(ranges: Any, number: int) -> None:
        ranges[:, 100 : 100 + number] += 1.0

    golden = golden_of(scan())
    few = record(scan(lambda r: edges(r, 7)), machine=OTHER_MACHINE)
    many = record(scan(lambda r: edges(r, 8)), machine=OTHER_MACHINE)
    assert compare(golden, few).passed  # 7 of 360 is less than 2 %
    assert words(golden, many) == ["/scan.ranges: 8 of 360 rays (100 to 107) +1 m from t = 0.10 s"]


def test_two_millimetres_one_degree_and_one_hertz_are_differences_on_another_machine() -> None:
    def moved(ranges: Any) -> None:
        ranges += 0.002

    golden = golden_of(scan(), odom(), imu())
    for changed in (scan(moved), odom(yaw=math.radians(1.0)), imu(when=times(402, 201.0))):
        run = [s for s in (scan(), odom(), imu()) if s.topic != changed.topic]
        assert not compare(golden, record(changed, *run, machine=OTHER_MACHINE)).passed


def test_a_tolerance_of_the_scenario_replaces_the_default() -> None:
    def off(ranges: Any) -> None:
        ranges += 0.004

    golden = golden_of(scan())
    for tolerance, passes in (
        (Tolerance("/scan", absolute=0.005), True),
        (Tolerance("/scan.ranges", relative=0.001), False),
        (Tolerance("/sc*", absolute=0.003), False),
        (Tolerance("/scan.ranges", ignore=True), True),
        (Tolerance("/other", absolute=1.0), False),
    ):
        run = record(scan(off), machine=OTHER_MACHINE, tolerances=(tolerance,))
        assert compare(golden, run).passed is passes, tolerance


def test_an_exact_field_is_compared_bit_by_bit_on_every_machine() -> None:
    def off(ranges: Any) -> None:
        ranges[3] += 1e-4

    run = record(scan(off), machine=OTHER_MACHINE, tolerances=(Tolerance("/scan", exact=True),))
    assert not compare(golden_of(scan()), run).passed


def test_an_ignored_topic_is_a_note_and_other_fields_are_still_compared() -> None:
    def off(ranges: Any) -> None:
        ranges += 1.0

    silent = compare(golden_of(scan()), record(scan(off), tolerances=(Tolerance("/scan", ignore=True),)))
    assert silent.passed and silent.notes == ["/scan is not compared"]
    ignored = (Tolerance("/scan.ranges", ignore=True),)
    assert compare(golden_of(scan()), record(scan(off), tolerances=ignored)).passed
    assert words(golden_of(scan()), record(scan(off, range_max=9.0), tolerances=ignored)) == [
        "/scan.range_max: 3.5 m became 9 m"
    ]


def test_an_event_may_shift_by_one_step_on_another_machine() -> None:
    when = np.array([100, 350, 360, 900]) * 1_000_000
    golden, run = (
        stream("/bumper", CONTACTS, at, {"contacts.depths": np.zeros((4, 1))})
        for at in (when, when + np.array([0, 1, 1, 0]) * 1_000_000)
    )
    assert compare(golden_of(golden), record(run, machine=OTHER_MACHINE)).passed
    assert not compare(golden_of(golden), record(run)).passed


def test_a_different_order_of_models_is_compared_with_tolerances() -> None:
    golden = record(leaves={"models[a].x": 1, "models[b].x": 2})
    run = record(leaves={"models[b].x": 2, "models[a].x": 1}, states=states(1e-12))
    found = compare(golden, run)
    assert found.passed and found.tier == "tolerant" and "have another order" in found.notes[0]
    assert not compare(golden, replace(run, leaves=golden.leaves)).passed
    assert not compare(golden, replace(run, leaves={"models[b].x": 3, "models[a].x": 1})).passed


# ---------------------------------------------------------------------- physics, world values, end


def test_a_physics_difference_names_the_first_tick_and_the_quantity() -> None:
    (found,) = compare(record(), record(states=states(0.003, first=1100))).differences
    assert (found.kind, found.topic, found.field) == ("state", "", "cart position x")
    assert found.words == "physics: state differs from t = 1.10 s (tick 1100): cart position x +3 mm at t = 1.25 s"
    assert found.time == pytest.approx(1.1) and found.size == pytest.approx(0.003)


def test_stored_states_are_compared_with_tolerances_on_another_machine() -> None:
    near = record(states=states(5e-4), machine=OTHER_MACHINE)
    far = record(states=states(0.01), machine=OTHER_MACHINE)
    assert compare(record(), near).passed
    assert words(record(), far) == ["physics: state differs from t = 1.00 s: cart position x +10 mm"]


def test_added_and_removed_moving_entities_are_named() -> None:
    other = states(names=("cart position x", "crate orientation w"))
    (said,) = words(record(), record(states=other))
    assert said == "physics: different moving entities: new: crate; gone: arm"


def test_the_physics_is_not_compared_if_the_scenario_excludes_it() -> None:
    assert compare(record(), record(states=states(1.0), state=False)).passed


def test_a_changed_world_value_is_a_difference_without_an_effect_on_outputs() -> None:
    golden = record(leaves={"a.size": 0.1, "a.pose": [0.0, math.nan]}, sources={"mesh.stl": "1"})
    same = record(leaves={"a.size": 0.1, "a.pose": [0.0, math.nan]}, sources={"mesh.stl": "1"})
    other = record(leaves={"a.size": 0.2, "a.pose": [0.0, math.nan]}, sources={"mesh.stl": "2"})
    assert compare(golden, same).passed
    (found,) = compare(golden, other).differences
    assert found.kind == "model" and "no recorded output differs" in found.words
    assert "a.size 0.1 → 0.2" in found.words and "mesh.stl has different content" in found.words
    assert compare(golden, replace(other, scenario=replace(other.scenario, model=False))).passed


def test_a_changed_world_is_no_second_difference_if_outputs_differ() -> None:
    golden = golden_of(scan(), leaves={"a": 1})
    assert [d.kind for d in compare(golden, record(scan(range_max=4.0), leaves={"a": 2})).differences] == ["value"]


def test_world_values_of_a_newer_simkit_are_a_note() -> None:
    newer = {**OTHER_MACHINE, "simkit": "2"}
    found = compare(record(leaves={"a": 1}), record(leaves={"a": 1, "b": 2}, machine=newer))
    assert found.passed and "exist in only one version of simkit: b" in found.notes[0]


def test_a_different_end_of_the_run_is_listed_first() -> None:
    def off(ranges: Any) -> None:
        ranges += 1.0

    found = compare(golden_of(scan()), record(scan(off), end="diverged at t = 0.3 s")).differences
    assert found[0].kind == "end" and "“diverged at t = 0.3 s”" in found[0].words and found[1].kind == "value"


def test_changed_diagnostics_of_loading_are_a_note() -> None:
    found = compare(record(diagnostics={"SK-A-001": 1}), record(diagnostics={"SK-A-001": 3}))
    assert found.passed and found.notes == ["loading reports SK-A-001 3 times; in the golden run 1 times"]


def test_a_topic_without_a_message_is_equal_to_itself() -> None:
    silent = stream("/never", IMU, times(0, 1.0), {})
    assert compare(record(silent), record(silent)).passed
    assert not compare(golden_of(imu()), record(stream("/imu", IMU, times(0, 1.0), {}))).passed

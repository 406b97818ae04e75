"""Checks of a run: results at the correct step with measured values, and no change of any bit."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit.errors import InputError
from simkit.run_spec import Check, RunSpec
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing.conditions import Watch
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario


def results(sim: Any, seconds: float, *checks: Check, reason: str = "duration", **options: Any) -> list[Any]:
    with Watch(sim, checks, **options) as watch:
        sim.run(seconds)
        return list(watch.results(reason))


def test_a_run_ends_at_the_very_step_at_which_its_condition_holds(yard: Any) -> None:
    sim = yard(speed=1.0)
    ended = run_scenario(RunSpec("", duration=9.0, until="pose('ball').x > 1"), sim)
    # rolling without slip keeps its speed: 1 m after 1 s, and one step more
    assert ended.reason == "until" and ended.passed
    assert sim.time == pytest.approx(1.0, abs=0.005)
    x = sim.model("ball").pose.position[0]
    assert 1.0 < x < 1.0 + 1.5 * sim.timestep
    assert ended.results[0].message == f"was reached at t = {sim.time:g} s: pose('ball').x was {x:.6g}"
    sim.run(0.1)  # the run can continue
    assert sim.time > 1.05


def test_a_condition_that_holds_from_the_start_ends_the_run_before_its_first_step(yard: Any) -> None:
    sim = yard()
    assert run_scenario(RunSpec("", until="pose('wall').x > 1"), sim).reason == "until"
    assert sim.tick == 0


def test_a_condition_that_is_not_reached_reports_the_nearest_values(yard: Any) -> None:
    sim = yard()
    sim.model("ball").set_velocity((0.0, 0.0, 2.0))
    ended = run_scenario(RunSpec("", until="pose('ball').z > 1", timeout=1.0), sim)
    # 0.25 + v²/2g is 0.454 m, after v/g = 0.204 s; minus g·t·dt/2 for steps of 2 ms
    assert ended.reason == "timeout" and not ended.passed
    message = ended.results[0].message
    assert message.startswith("was not reached by t = 1 s: pose('ball').z was 0.2499")
    assert message.endswith("nearest at t = 0.204 s: pose('ball').z was 0.452082")


def test_each_kind_of_check_reports_time_and_reason(yard: Any) -> None:
    checks = [
        Check("goal", expression="pose('ball').x > 0.5", by=1.0),
        Check("goal", expression="pose('ball').x > 0.5", by=0.2),
        Check("always", expression="abs(pose('ball').y) < 0.1"),
        Check("always", expression="pose('ball').x < 0.75"),
        Check("always", expression="pose('ball').x < 0.75", after=5.0),
        Check("always", expression="velocity('ball').x < 0.5", after=1.9),
        Check("final", expression="velocity('ball').x < 0.5 and pose('ball').x > 1"),
        Check("final", expression="time < 1 or not contact('ball', 'ground')"),
    ]
    found = results(yard(speed=1.0), 2.0, *checks)
    assert [result.passed for result in found] == [True, False, True, False, False, True, True, False]
    said = [result.message for result in found]
    assert said[0].startswith("was reached at t = 0.5")
    assert said[1].startswith("was not reached by t = 0.2 s: pose('ball').x was 0.20")
    assert said[3].startswith("did not hold at t = 0.75") and found[3].time == pytest.approx(0.75, abs=0.005)
    assert said[4] == "was never evaluated: the run ended at t = 2 s, before t = 5 s"
    assert said[7] == ("time was 2, contact('ball', 'ground') was true (ball::base touches ground::l) at t = 2 s")


def test_models_that_must_not_touch_are_named_with_the_links_that_did(yard: Any) -> None:
    checks = [
        Check("apart", models=("ball",)),
        Check("apart", models=("ball", "wall")),
        Check("apart", models=("ball", "arm")),
        Check("apart", models=("ball", "wall"), after=1.9),
    ]
    found = results(yard(speed=1.0), 1.8, *checks)
    assert [result.passed for result in found] == [False, False, True, False]
    # the wall's face is 1.9 m ahead and the ball's 0.25 m in front of its centre
    assert found[0].time == pytest.approx(1.65, abs=0.01) and found[0].time == found[1].time
    assert found[1].message == f"ball::base touches wall::l at t = {found[1].time:g} s"


def test_floors_are_ground_and_walls_are_not(yard: Any) -> None:
    ramp = (
        '<model name="ramp"><static>true</static><pose>-3 0 0 0 0.3 0</pose><link name="l"><collision name="c">'
        "<geometry><box><size>2 2 0.2</size></box></geometry></collision></link></model>"
        '<model name="die"><pose>-3 0 0.5 0 0.3 0</pose><link name="l"><inertial><mass>1</mass></inertial>'
        '<collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision></link></model>'
    )
    sim = yard(more=ramp)
    found = results(
        sim,
        3.0,
        Check("apart", models=("die",)),
        Check("final", expression="contact('die', 'ramp') and not contact('die')"),
        Check("final", expression="abs(contact_force('die', 'ramp') - 9.8 * cos(0.3)) < 0.3"),
        Check("final", expression="contacts('die::l', 'ramp::l::c') > 0"),
    )
    assert [result.message for result in found if not result.passed] == []


def test_sleeping_models_still_have_contacts(yard: Any) -> None:
    box = '<collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>'
    mass = "<inertial><mass>1</mass></inertial>"
    sim = yard(more=f'<model name="die"><pose>0 -1 0.1 0 0 0</pose><link name="l">{mass}{box}</link></model>')
    sim.run(5.0)
    sim.engine.physics.fresh()
    assert sim.mj_data.tree_asleep.max() >= 0  # otherwise the test would check nothing
    found = results(
        sim,
        0.1,
        Check("always", expression="contact('die', 'ground')"),
        Check("final", expression="abs(contact_force('die', 'ground') - 9.8) < 0.1"),
    )
    assert [result.message for result in found if not result.passed] == []


def test_topics_have_their_configured_rate(yard: Any) -> None:
    checks = [
        Check("rate", topic="/imu"),
        Check("rate", topic="/scan"),
        Check("rate", topic="imu", rate=60.0),
        Check("rate", topic="/scan", rate=5.2),
        Check("rate", topic="/skan"),
    ]
    found = results(yard(), 2.0, *checks)
    assert [result.passed for result in found] == [True, True, False, True, False]
    assert found[2].message.startswith("/imu: 50.0") and found[2].message.endswith("expected 60 Hz ± 5 %")
    assert found[4].message == "no publisher on /skan; did you mean '/scan'?"


def test_a_topic_that_stops_before_the_end_fails_its_rate_check(yard: Any) -> None:
    sim = yard()
    with Watch(sim, [Check("rate", topic="/imu")]) as watch:
        sim.run(1.0)
        sim.remove("ball")
        sim.run(1.0)
        (found,) = watch.results("duration")
    assert not found.passed and found.message.endswith("and no further message until t = 2 s")


def test_open_checks_fail_if_the_run_ends_early(yard: Any) -> None:
    checks = [
        Check("always", expression="time >= 0"),
        Check("final", expression="time >= 0"),
        Check("apart", models=("ball",)),
        Check("rate", topic="/imu"),
        Check("goal", expression="time > 0.1"),
    ]
    found = results(yard(), 0.5, *checks, reason="SK-PHYS-001 the simulation diverged")
    assert [result.passed for result in found] == [False, False, False, False, True]
    assert all("SK-PHYS-001" in result.message for result in found[:4])


def test_all_problems_are_reported_at_once_with_their_positions(yard: Any) -> None:
    checks = [
        Check("goal", expression="pose('bal').x > 1", where="a.yaml:3"),
        Check("final", expression="time", where="a.yaml:5"),
        Check("apart", models=("ball", "wal"), where="a.yaml:7"),
        Check("apart", where="a.yaml:9"),
        Check("rate", where="a.yaml:11"),
    ]
    with pytest.raises(InputError) as caught:
        Watch(yard(), checks)
    text = str(caught.value)
    for line, code in ((3, "005"), (5, "004"), (7, "005"), (9, "009"), (11, "009")):
        assert f"a.yaml:{line}: SK-COND-{code}" in text


def test_a_check_can_wait_for_a_topic(yard: Any) -> None:
    import simkit

    checks = [
        Check("final", expression="topic('/answer').data == 42"),
        Check("final", expression="topic('/answer').dat == 42"),
        Check("final", expression="count('/never') > 0"),
    ]
    with pytest.raises(InputError, match="SK-COND-006"):
        Watch(yard(), checks)
    sim = yard()
    with Watch(sim, checks, absent="wait") as watch:
        watch.look()
        publisher = sim.communication.bus.advertise("/answer", "std_msgs/msg/Int32")
        watch.look()
        publisher.publish(simkit.msgs.make("std_msgs/msg/Int32", data=42))
        found = watch.results("duration")
    assert [result.passed for result in found] == [True, False, False]
    assert "did you mean 'data'?" in found[1].message and "no publisher on /never" in found[2].message


def test_a_watch_changes_no_bits_and_other_subscribers_get_all_messages(yard: Any) -> None:
    checks = [
        Check("always", expression="pose('ball').x < 9 and velocity('ball').z < 9 and not contact('ball', 'post')"),
        Check("always", expression="topic('/imu').linear_acceleration.z > -1e9 and min(scan('/scan')) > 0"),
        Check("apart", models=("ball", "arm")),
        Check("rate", topic="/imu"),
    ]
    seen: list[Any] = []
    for asked in ((), checks, checks[:1]):
        sim, heard, counted = yard(speed=1.0), [], []
        sim.communication.bus.tap(
            "/imu", lambda message, to=heard: to.append(bytes(message.linear_acceleration.x.hex(), "ascii"))
        )
        sim.communication.bus.tap("/scan", lambda _, to=counted: to.append(_), takes_later=True)
        results(sim, 2.0, *asked)
        seen.append((state_hash(sim), heard, len(counted)))
    assert seen[0] == seen[1] == seen[2] and len(seen[0][1]) == 101 and seen[0][2] == 11


def test_a_count_is_correct_with_another_reader_of_the_newest_message(yard: Any) -> None:
    checks = [Check("final", expression="count('/imu') == 101 and topic('/imu').linear_acceleration.z > 9")]
    (found,) = results(yard(), 2.0, *checks)
    assert found.passed, found.message


def test_a_run_stopped_at_its_wall_clock_limit_has_not_passed(yard: Any) -> None:
    scenario = RunSpec("", duration=1e6, wall_timeout=0.05)
    ended = run_scenario(scenario, yard())
    assert ended.reason == "wall_timeout" and not ended.passed


def test_a_scenario_opens_and_runs_with_its_conditions() -> None:
    scenario = RunSpec("empty", duration=0.5, checks=(Check("final", expression="time == 0.5"),))
    with open_scenario(scenario) as sim:
        assert run_scenario(scenario, sim).passed


def test_a_new_model_with_the_name_of_a_removed_one_is_used(yard: Any) -> None:
    sim = yard()
    ball = f'<sdf version="1.9"><model name="crate">{CRATE}</model></sdf>'
    sim.spawn(ball, pose=simkit.Pose((5, 0, 9)))
    checks = [Check("final", expression="pose('crate').z > 3"), Check("always", expression="velocity('crate').z > -2")]
    with Watch(sim, checks) as watch:
        sim.remove("crate")
        sim.run(0.1)
        sim.spawn(ball, pose=simkit.Pose((5, 0, 4)))
        sim.run(0.1)
        found = [(result.passed, result.message) for result in watch.results("duration")]
    assert [passed for passed, _ in found] == [True, True]
    assert "pose('crate').z was 3.9" in found[0][1] and "velocity('crate').z was -0.9" in found[1][1]


def test_a_limit_on_a_removed_model_reports_until_when_it_held(yard: Any) -> None:
    sim = yard()
    with Watch(sim, [Check("always", expression="pose('ball').z > 0")]) as watch:
        sim.run(0.1)
        sim.remove("ball")
        sim.run(0.1)
        (result,) = watch.results("duration")
    assert result.message == ("held from t = 0 s to t = 0.1 s, then: pose('ball').z is unknown: ball was removed")


def test_a_constant_condition_is_reported_as_text(yard: Any) -> None:
    (result,) = results(yard(), 0.01, Check("final", expression="1 > 2"))
    assert result.message == "1 > 2 was false at t = 0.01 s"


CRATE = """<link name="l"><collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
<inertial><mass>1</mass></inertial></link>"""

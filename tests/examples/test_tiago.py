"""The chapter on TIAGo: each script of it does what it says, within numbers that a robot would be held to."""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "tiago"


@pytest.fixture(scope="module", autouse=True)
def beside() -> Any:
    """The scripts import what they share from beside them, as they do when they are run."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(FOLDER))
        yield


def script(name: str) -> dict[str, Any]:
    return runpy.run_path(str(FOLDER / f"{name}.py"))


# ---------------------------------------------------------------------- as scripts


SCRIPTS = ("velocity", "joints", "arm_trajectory", "look", "wave", "carry", "grasps")


@pytest.mark.parametrize("name", SCRIPTS)
def test_a_script_tells_what_it_does(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    parts = script(name)
    with pytest.raises(SystemExit) as ended:
        parts["main"](["--help"])
    assert ended.value.code == 0 and parts["__doc__"][:30] in capsys.readouterr().out


@pytest.mark.parametrize("where", ["nowhere/out.png", "out.gif", "--picture"])
@pytest.mark.parametrize("name", ["arm_trajectory", "look", "carry"])
def test_a_picture_that_cannot_be_written_is_told_before_anything_moves(
    name: str, where: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        script(name)["main"]([where])
    assert ended.value.code == 2 and not list(tmp_path.iterdir())


# ---------------------------------------------------------------------- grasps


@pytest.mark.labs
def test_the_best_of_the_grasps_that_are_reached_lifts_the_can() -> None:
    pytest.importorskip("pinocchio")
    grasps, lifted = script("grasps")["run"]()
    costs = [grasp.cost for grasp in grasps if grasp.joints]
    assert 3 <= len(costs) < len(grasps) == 24
    assert costs == sorted(costs) and grasps[0].cost == costs[0]
    assert lifted == pytest.approx(0.12, abs=0.01)


# ---------------------------------------------------------------------- the base


@pytest.fixture(scope="module")
def drives(beside: Any) -> Any:
    return script("velocity")["run"]()


def test_commands_at_3_hz_drive_it_forward_and_back_and_turn_it(drives: Any) -> None:
    """With 0.25 s until it gives up and 1/3 s between commands it slows by up to 0.083 m/s before each."""
    forward, backward, left = drives["forward"], drives["backward"], drives["left"]
    assert 3.0 * 0.5 * 0.75 < forward.forward < 3.0 * 0.5
    assert -3.0 * 0.15 < backward.forward < -3.0 * 0.15 * 0.7
    assert 3.0 * 0.5 * 0.75 < left.turned < 3.0 * 0.5
    assert abs(left.forward) < 0.02


def test_it_keeps_to_its_line(drives: Any) -> None:
    for name in ("forward", "backward"):
        assert abs(drives[name].turned) < 0.01
        assert abs(drives[name].aside) < 0.01


def test_it_stops_when_commands_stop(drives: Any) -> None:
    """A quarter of a second at speed, then 1 m/s² until it stands: at most 0.25 m from 0.5 m/s."""
    for name, part in drives.items():
        if name.startswith("after"):
            assert abs(part.speed) < 1e-3
            assert abs(part.forward) < 0.5 * 0.25 + 0.5**2 / 2
            assert abs(part.turned) < 0.5 * 0.25 + 0.5**2 / (2 * 2.09)


# ---------------------------------------------------------------------- trajectories


@pytest.fixture(scope="module")
def motion(beside: Any) -> Any:
    return script("arm_trajectory")["run"]()


def test_the_arm_goes_through_both_points(motion: Any) -> None:
    points = script("arm_trajectory")["POINTS"]
    assert (motion.result.error_code, motion.result.error_string) == (0, "Goal successfully reached!")
    for point in points:
        index = int(np.abs(motion.times - point.seconds).argmin())
        shift = np.array(point.velocities) * (motion.times[index] - point.seconds)
        np.testing.assert_allclose(motion.actual[index], np.array(point.positions) + shift, atol=0.02)
    np.testing.assert_allclose(motion.final, points[-1].positions, atol=0.005)


def test_it_does_not_stop_at_the_first_point(motion: Any) -> None:
    index = int(np.abs(motion.times - 2.0).argmin())
    speeds = (motion.actual[index + 1] - motion.actual[index - 1]) / (motion.times[index + 1] - motion.times[index - 1])
    np.testing.assert_allclose(speeds, 1.0, atol=0.1)


def test_the_arm_is_within_20_mrad_of_the_trajectory_at_every_moment(motion: Any) -> None:
    assert len(motion.times) > 150  # 50 Hz for 4 s
    assert motion.error < 0.02


def test_the_trajectory_can_be_drawn(motion: Any, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="the picture is drawn by matplotlib")
    script("arm_trajectory")["draw"](motion, tmp_path / "arm.png")
    assert (tmp_path / "arm.png").stat().st_size > 10_000


@pytest.fixture(scope="module")
def moves(beside: Any) -> Any:
    return script("joints")["run"]()


def test_torso_head_gripper_and_each_joint_of_the_arm_get_where_they_are_sent(moves: Any) -> None:
    every = script("joints")["EVERY"]
    assert {name for moved in moves for name in moved.wanted} == set(every)
    for moved in moves:
        assert moved.result.error_code == 0
        for name, wanted in moved.wanted.items():
            assert moved.after[every.index(name)] == pytest.approx(wanted, abs=1e-3 if "finger" in name else 5e-3)


def test_the_others_stay_where_they_are(moves: Any) -> None:
    every = script("joints")["EVERY"]
    for moved in moves:
        others = [i for i, name in enumerate(every) if name not in moved.wanted]
        np.testing.assert_allclose(moved.after[others], moved.before[others], atol=2e-3)


# ---------------------------------------------------------------------- looking


@pytest.fixture(scope="module")
def sights() -> Any:
    return script("look")["run"]()


def test_told_where_a_ball_is_it_looks_at_it(sights: Any) -> None:
    ahead, told, aside, led = sights
    assert ahead.angle > 0.2
    assert told.angle < 0.02
    assert aside.angle > 0.1
    assert led.angle < 0.02


def test_the_ball_comes_to_the_middle_of_the_picture(sights: Any) -> None:
    _, told, _, led = sights
    for view in (told, led):
        assert view.pixel[0] == pytest.approx(320, abs=15)
        assert view.pixel[1] == pytest.approx(240, abs=15)


# ---------------------------------------------------------------------- motions


@pytest.fixture(scope="module")
def wave(beside: Any) -> Any:
    return script("wave")["run"]()


@pytest.mark.slow
def test_it_waves(wave: Any) -> None:
    """arm_4 goes from 2.09 to 1.83, to 2.18, and to 1.83 rad, a second for each."""
    elbow = wave.positions[:, 3]
    turns = np.flatnonzero(np.diff(np.sign(np.diff(np.round(elbow[wave.times > wave.times[-1] - 3.5], 3)))))
    assert len(turns) >= 2
    last = elbow[wave.times > wave.times[-1] - 2.5]
    assert last.min() == pytest.approx(1.834, abs=0.02)
    assert last.max() == pytest.approx(2.18, abs=0.02)


@pytest.mark.slow
def test_it_gets_back_to_where_its_arm_was(wave: Any) -> None:
    np.testing.assert_allclose(wave.after, wave.before, atol=5e-3)


@pytest.mark.slow
def test_each_motion_says_that_all_went_well(wave: Any) -> None:
    assert [(r.success, r.error) for r in wave.results] == [(True, "")] * 3


# ---------------------------------------------------------------------- something to carry


@pytest.fixture(scope="module")
def carried(beside: Any) -> Any:
    return script("carry")["run"]()


@pytest.mark.slow
def test_it_lifts_the_bottle_by_0_3_m(carried: Any) -> None:
    before, after = carried.places["on the first table"], carried.places["lifted"]
    assert after[2] - before[2] == pytest.approx(0.31, abs=0.005)
    assert np.hypot(*(after - before)[:2]) < 0.01


@pytest.mark.slow
def test_held_in_the_air_it_does_not_slip(carried: Any) -> None:
    assert carried.slips["held"] < 5e-4
    assert carried.slips["carried"] < 2e-3  # with the drive and the turn
    assert carried.fingers < 1e-3


@pytest.mark.slow
def test_it_carries_it_to_the_other_table(carried: Any) -> None:
    way = carried.places["carried"] - carried.places["held"]
    assert np.hypot(*way[:2]) > 1.0
    assert abs(way[2]) < 0.005


@pytest.mark.slow
def test_it_puts_it_down_upright_and_lets_go(carried: Any) -> None:
    end = carried.places["let go"]
    assert end[2] == pytest.approx(0.55 + 0.075, abs=1e-3)
    assert abs(end[0] + 0.79) < 0.25
    assert abs(end[1] - 0.78) < 0.2
    assert carried.tilt < 0.01
    np.testing.assert_allclose(end[:2], carried.places["put down"][:2], atol=0.01)

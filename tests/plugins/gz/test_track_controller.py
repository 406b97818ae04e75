"""Track controller of Gazebo: a belt moves its load as far as friction allows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from belt_worlds import BELT, CENTRE, conveyor, crate, rubs, wall, world

import simkit
from simkit.runtime.contact import contact_law, friction_contacts

G = 9.8


def opened(*models: str, step: float = 0.001) -> simkit.Simulation:
    return simkit.load(world(*models, step=step))


def place(sim: simkit.Simulation, name: str = "crate") -> np.ndarray:
    return np.array(sim.model(name).pose.position)


@pytest.mark.parametrize("step", [0.001, 0.002, 0.004])
@pytest.mark.parametrize("speed", [0.5, -2.0])
def test_friction_accelerates_a_crate_to_the_speed_of_the_belt(step: float, speed: float) -> None:
    """The crate accelerates at mu·g up to the belt's speed, lags by v²/(2 mu g), and is not lifted."""
    with opened(conveyor(mu=0.7), crate(), step=step) as sim:
        sim.run(0.2)
        sim.publish(BELT, {"data": speed})
        highest = 0.0
        for _ in range(50):
            sim.run(0.02)
            highest = max(highest, float(place(sim)[2]))
        lag = speed * abs(speed) / (2 * 0.7 * G)
        assert place(sim)[0] == pytest.approx(speed - lag, abs=0.005 * abs(speed))
        assert sim.link("crate::link").linear_velocity[0] == pytest.approx(speed, abs=1e-6)
        assert highest < 0.055


def test_a_ball_on_a_belt_gets_two_sevenths_of_its_speed() -> None:
    """A solid ball on a belt gets 2/7 of the belt's speed, because friction also turns the ball."""
    ball = crate(shape="<sphere><radius>0.05</radius></sphere>")
    with opened(conveyor(mu=1.0), ball.replace(str(0.01 / 6), str(0.4 * 0.0025))) as sim:
        sim.run(0.1)
        sim.publish(BELT, {"data": 0.7})
        sim.run(1.0)
        assert sim.link("crate::link").linear_velocity[0] == pytest.approx(0.2, rel=0.02)


def test_a_held_crate_gets_the_friction_force_at_any_speed() -> None:
    for speed, step in ((0.2, 0.001), (10.0, 0.001), (10.0, 0.004)):
        with opened(conveyor(mu=0.5), crate(mass=2.0), wall(0.051), step=step) as sim:
            sim.publish(BELT, {"data": speed})
            sim.run(1.0)
            pushes = []
            for _ in range(100):
                sim.step()
                data = sim.engine.physics.fresh()
                rows = [c.efc_address for c in data.contact if abs(c.frame[0]) > 0.9 and c.efc_address >= 0]
                pushes.append(float(data.efc_force[rows].sum()))
            assert place(sim)[0] == pytest.approx(0.001, abs=5e-4)
            assert place(sim)[2] == pytest.approx(0.05, abs=5e-4)
            assert np.mean(pushes) == pytest.approx(0.5 * 2.0 * G, rel=0.035)


def test_the_slip_on_a_belt_counts_from_its_surface() -> None:
    """A crate that is carried does not slip; one that a wall holds slips at the speed of the belt."""
    for models, slip in ((), 0.0), ((wall(0.051),), 0.5):
        with opened(conveyor(), crate(), *models) as sim:
            sim.publish(BELT, {"data": 0.5})
            sim.run(1.0)
            (pair,) = (pair for pair in sim.why("crate").contacts if pair.second == "conveyor::belt::c")
            assert pair.slip_speed == pytest.approx(slip, abs=1e-5)
            assert pair.slides == (slip > 0.0)


def test_the_result_of_gazebos_conveyor_test_is_reproduced() -> None:
    """A belt with 0.5 m/s and 0.25 m/s² for 2 s moves 0.125 m in one second, 0.5 m in two, 0.875 m in three."""
    inner = (
        "<max_command_age>2.0</max_command_age><max_velocity>0.5</max_velocity>"
        "<max_acceleration>0.25</max_acceleration><min_acceleration>-0.25</min_acceleration>"
    )
    with opened(conveyor(inner), crate()) as sim:
        odometry = sim.subscribe("/model/conveyor/link/belt/odometry", keep=1)
        sim.run(1.0)
        sim.publish(BELT, {"data": 1.0})
        for way in (0.125, 0.5, 0.875):
            sim.run(1.0)
            assert place(sim)[0] == pytest.approx(way, abs=1e-3)
            assert odometry.messages[-1].pose.pose.position.x == pytest.approx(way, abs=1e-3)
        sim.run(2.0)
        assert place(sim)[0] == pytest.approx(1.0, abs=1e-3)
        assert odometry.messages[-1].twist.twist.linear.x == 0.0


def test_a_stopped_belt_needs_no_callback_and_holds() -> None:
    with opened(conveyor(), crate(pose="0 0 0.05 0 0 0")) as sim:
        sim.run(0.1)
        assert not sim.engine.scheduler.before.every
        sim.publish(BELT, {"data": 0.3})
        sim.run(0.5)
        assert not sim.engine.scheduler.before.every
        sim.publish(BELT, {"data": 0.0})
        sim.run(0.5)
        stood = place(sim)
        sim.run(0.5)
        np.testing.assert_allclose(place(sim), stood, atol=1e-6)


def test_a_sleeping_crate_wakes_when_the_belt_starts() -> None:
    with opened(conveyor(), crate(), crate("1 0 0.05 0 0 0", "other")) as sim:
        sim.run(3.0)
        assert sim.mj_data.tree_asleep[0] >= 0
        sim.publish(BELT, {"data": 0.3})
        sim.run(1.0)
        assert place(sim)[0] == pytest.approx(0.3, abs=0.01)


def test_a_centre_of_rotation_makes_the_crate_move_on_a_circle() -> None:
    """At 0.4 m/s around a point 1 m to the left, the crate turns by 0.4 rad per second along its path."""
    with opened(conveyor(mu=1.0), crate()) as sim:
        sim.publish(CENTRE, {"x": 0.0, "y": 1.0, "z": 0.0})
        sim.publish(BELT, {"data": 0.4})
        sim.run(2.0)
        angle = 0.4 * 2.0
        np.testing.assert_allclose(place(sim)[:2], (math.sin(angle), 1 - math.cos(angle)), atol=0.02)
        sim.publish(CENTRE, {"x": math.inf, "y": 0.0, "z": 0.0})
        before = place(sim)
        sim.run(1.0)
        np.testing.assert_allclose((place(sim) - before)[:2], (0.4, 0.0), atol=0.01)


def test_the_track_orientation_turns_the_belt_and_its_lower_side_moves_back() -> None:
    """A belt turned by 90° moves loads along y; the lower side of a belt above the crate moves it backwards."""
    with opened(conveyor("<track_orientation>0 0 1.5707963267948966</track_orientation>"), crate()) as sim:
        sim.publish(BELT, {"data": 0.5})
        sim.run(1.0)
        np.testing.assert_allclose(place(sim)[:2], (0.0, 0.5), atol=0.03)
    above = conveyor(pose="0 0 0.149 0 0 0")
    floor = '<model name="ice"><static>true</static><link name="link"><collision name="c"><geometry><plane/></geometry>'
    with opened(floor + rubs(0) + "</collision></link></model>", above, crate()) as sim:
        sim.publish(BELT, {"data": 0.5})
        sim.run(0.3)
        assert place(sim)[0] < -0.05


def test_a_belt_carries_a_crate_up_to_the_friction_angle() -> None:
    """The belt carries a crate up 15°; with mu below the slope's tangent the crate slides down."""
    pitch = math.radians(15)
    tilted = f"0 0 {-0.05 / math.cos(pitch)} 0 {-pitch} 0"
    for mu, climbs in ((0.6, True), (0.15, False)):
        with opened(conveyor(mu=mu, pose=tilted), crate(pose=f"0 0 {0.05 / math.cos(pitch)} 0 {-pitch} 0")) as sim:
            sim.publish(BELT, {"data": 0.5})
            sim.run(2.0)
            along = place(sim)[0] / math.cos(pitch)
            if climbs:
                assert along == pytest.approx(1.0, abs=0.06)
            else:
                down = G * (math.sin(pitch) - mu * math.cos(pitch))
                assert along == pytest.approx(-0.5 * down * 4, rel=0.03)


def test_a_crate_on_two_opposite_belts_turns() -> None:
    """The crate lies half on each belt, turns, and does not move."""
    left = conveyor(size="40 2 0.1", pose="0 1 -0.05 0 0 0", mu=1.0)
    right = conveyor(size="40 2 0.1", pose="0 -1 -0.05 0 0 0", mu=1.0).replace('"conveyor"', '"other"')
    with opened(left, right, crate()) as sim:
        sim.publish(BELT, {"data": -0.05})
        sim.publish(BELT.replace("conveyor", "other"), {"data": 0.05})
        sim.run(0.5)
        assert sim.link("crate::link").angular_velocity[2] > 0.03
        assert np.abs(place(sim)[:2]).max() < 0.01


def test_runs_after_a_reset_or_restore_and_with_a_subscriber_have_the_same_bits() -> None:
    def trace(sim: simkit.Simulation, reads: bool = False) -> list[bytes]:
        found = []
        for tick in range(400):
            if tick == 50:
                sim.publish(BELT, {"data": 1.0})
            if reads and tick % 7 == 0:
                sim.mj_data.qacc.copy()
                assert sim.link("crate::link").linear_acceleration is not None
            sim.step()
            found.append(sim.link("crate::link").pose.position.tobytes())
        return found

    models = (conveyor("<max_acceleration>3</max_acceleration>"), crate(pose="0 0.01 0.06 0.1 0 0.3"), wall(0.3))
    with opened(*models) as sim:
        first = trace(sim)
        snapshot = sim.snapshot()
        sim.run(0.2)
        after = sim.link("crate::link").pose.position.tobytes()
        sim.restore(snapshot)
        sim.run(0.2)
        assert sim.link("crate::link").pose.position.tobytes() == after
        sim.reset()
        assert trace(sim) == first
    with opened(*models) as sim:
        assert trace(sim, reads=True) == first


def test_it_works_on_spawned_and_nested_models() -> None:
    with opened(crate()) as sim:
        nested = (
            conveyor().replace('<model name="conveyor">', '<model name="line"><model name="conveyor">') + "</model>"
        )
        sim.spawn(f"<sdf version='1.9'>{conveyor()}</sdf>", name="conveyor")
        sim.publish(BELT, {"data": 0.5})
        sim.run(1.0)
        assert place(sim)[0] > 0.4
        sim.remove("conveyor")
        sim.run(0.05)
        assert place(sim)[2] < 0.045
    with opened(nested.replace("<pose>0 0 -0.05", "<pose>0 0 -0.05"), crate()) as sim:
        sim.publish(BELT, {"data": 0.5})
        sim.run(1.0)
        assert place(sim)[0] > 0.4


@pytest.mark.parametrize(
    ("inner", "code"),
    [
        ("<max_velocity>-1</max_velocity>", "SK-PARAM-002"),
        ("<odometry_publish_frequency>-1</odometry_publish_frequency>", "SK-PARAM-002"),
        ("<track_orientation>a b c</track_orientation>", "SK-PARAM-002"),
    ],
)
def test_invalid_parameters_are_reported(inner: str, code: str) -> None:
    with pytest.raises(simkit.LoadError) as error:
        opened(conveyor(inner))
    assert code in str(error.value)


def test_a_missing_link_is_reported_with_the_closest_name() -> None:
    with pytest.raises(simkit.LoadError, match="belt"):
        opened(conveyor().replace("<link>belt</link>", "<link>bel</link>"))


def test_a_nan_command_is_ignored() -> None:
    with opened(conveyor(), crate()) as sim:
        sim.publish(BELT, {"data": math.nan})
        sim.run(0.2)
        assert place(sim)[0] == pytest.approx(0.0, abs=1e-6)
        assert [d for d in sim.diagnostics if d.code == "SK-PLUGIN-041"]


@pytest.mark.parametrize("friction", [rubs(0.7), rubs(0.7, 0.2, "1 1 0")], ids=["even", "directed"])
@pytest.mark.parametrize("step", [0.001, 0.004])
def test_array_and_scalar_code_have_the_same_bits(step: float, friction: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Many contacts are computed with arrays, few with plain numbers; the limit between them changes no bit."""

    def run(many: int) -> bytes:
        for module in (contact_law, friction_contacts):
            monkeypatch.setattr(module, "ARRAY_THRESHOLD", many)
        crates = [crate(f"{0.2 * n} 0 0.05 0 0 {0.3 * n}", f"crate{n}") for n in range(4)]
        crates[3] = crates[3].replace("<mu>1.0</mu><mu2>1.0</mu2>", "<mu>0.9</mu><mu2>0.4</mu2><fdir1>1 0.5 0</fdir1>")
        belt = conveyor("<max_acceleration>9</max_acceleration>", surface=friction)
        with opened(belt, *crates, wall(0.7), step=step) as sim:
            sim.publish(BELT, {"data": 0.8})
            sim.run(0.1)
            sim.publish(CENTRE, {"x": 0.0, "y": 2.0, "z": 0.0})
            sim.run(0.1)
            found: bytes = sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes()
            return found

    assert run(0) == run(10**9)

"""gz's track controller: what lies on a belt goes with it, as far as friction takes it."""

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
def test_a_crate_is_speeded_up_by_friction_and_then_goes_with_the_belt(step: float, speed: float) -> None:
    """mu·g until it has the belt's speed: it lags by v²/(2 mu g); and nothing lifts it meanwhile."""
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


def test_what_rolls_is_carried_as_a_rolling_ball_is() -> None:
    """A solid ball on a belt gets 2/7 of the belt's speed: friction turns it while it pushes."""
    ball = crate(shape="<sphere><radius>0.05</radius></sphere>")
    with opened(conveyor(mu=1.0), ball.replace(str(0.01 / 6), str(0.4 * 0.0025))) as sim:
        sim.run(0.1)
        sim.publish(BELT, {"data": 0.7})
        sim.run(1.0)
        assert sim.link("crate::link").linear_velocity[0] == pytest.approx(0.2, rel=0.02)


def test_a_crate_that_is_held_fast_presses_with_friction_at_any_speed() -> None:
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


def test_gazebos_own_test_of_a_conveyor() -> None:
    """At most 0.5 m/s and 0.25 m/s², for 2 s: 0.125 m after a second, 0.5 after two, 0.875 after three."""
    inner = (
        "<max_command_age>2.0</max_command_age><max_velocity>0.5</max_velocity>"
        "<max_acceleration>0.25</max_acceleration><min_acceleration>-0.25</min_acceleration>"
    )
    with opened(conveyor(inner), crate()) as sim:
        heard = sim.subscribe("/model/conveyor/link/belt/odometry", keep=1)
        sim.run(1.0)
        sim.publish(BELT, {"data": 1.0})
        for way in (0.125, 0.5, 0.875):
            sim.run(1.0)
            assert place(sim)[0] == pytest.approx(way, abs=1e-3)
            assert heard.messages[-1].pose.pose.position.x == pytest.approx(way, abs=1e-3)
        sim.run(2.0)
        assert place(sim)[0] == pytest.approx(1.0, abs=1e-3)
        assert heard.messages[-1].twist.twist.linear.x == 0.0


def test_a_belt_that_stands_costs_no_hook_and_holds() -> None:
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


def test_it_carries_along_a_circle_round_a_centre() -> None:
    """At 0.4 m/s round a point 1 m to the left: 0.4 rad a second, the crate turns with its way."""
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


def test_the_belt_runs_the_way_it_is_turned_and_comes_back_below() -> None:
    """Turned by 90° it carries along y; on a belt hung over the crate, its lower side carries the other way."""
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


def test_a_slope_carries_up_to_the_angle_of_friction() -> None:
    """Along x it goes up 15° at the belt's speed; with mu below the slope's tangent it slides down in spite of it."""
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


def test_on_two_belts_that_run_against_each_other_a_crate_turns() -> None:
    """It lies half on each, and stays where it is."""
    left = conveyor(size="40 2 0.1", pose="0 1 -0.05 0 0 0", mu=1.0)
    right = conveyor(size="40 2 0.1", pose="0 -1 -0.05 0 0 0", mu=1.0).replace('"conveyor"', '"other"')
    with opened(left, right, crate()) as sim:
        sim.publish(BELT, {"data": -0.05})
        sim.publish(BELT.replace("conveyor", "other"), {"data": 0.05})
        sim.run(0.5)
        assert sim.link("crate::link").angular_velocity[2] > 0.03
        assert np.abs(place(sim)[:2]).max() < 0.01


def test_same_bits_after_a_reset_a_restore_and_with_a_reader() -> None:
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


def test_it_works_on_a_spawned_and_on_a_nested_model_and_goes_with_it() -> None:
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
def test_bad_parameters_are_reported(inner: str, code: str) -> None:
    with pytest.raises(simkit.LoadError) as error:
        opened(conveyor(inner))
    assert code in str(error.value)


def test_a_link_that_is_not_there_is_reported_with_the_closest() -> None:
    with pytest.raises(simkit.LoadError, match="belt"):
        opened(conveyor().replace("<link>belt</link>", "<link>bel</link>"))


def test_a_command_that_is_no_number_is_left_out() -> None:
    with opened(conveyor(), crate()) as sim:
        sim.publish(BELT, {"data": math.nan})
        sim.run(0.2)
        assert place(sim)[0] == pytest.approx(0.0, abs=1e-6)
        assert [d for d in sim.diagnostics if d.code == "SK-PLUGIN-041"]


@pytest.mark.parametrize("friction", [rubs(0.7), rubs(0.7, 0.2, "1 1 0")], ids=["even", "directed"])
@pytest.mark.parametrize("step", [0.001, 0.004])
def test_many_contacts_have_the_bits_that_few_have(step: float, friction: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Many are worked out on arrays, few as plain numbers: where the one begins changes nothing."""

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

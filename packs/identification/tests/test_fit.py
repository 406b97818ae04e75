"""Fits: parameters come back from recordings, with intervals, and mistakes have messages."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fit_worlds import pendulum, push, record, servo, slider, swing, turn

import simkit
from simkit import InputError, RunSpec
from simkit.recording import Recorder
from simkit.testing import open_scenario
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit_identification.fitting.problem import RepeatedRecording
from simkit_identification.fitting.readings import Channel, Readings
from simkit_identification.fitting.residuals import Residuals

MASS, DAMPING = "cart::car.inertial.mass", "cart::slide.axis.dynamics.damping"


@pytest.fixture(scope="module")
def pushed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recording of a slider with 2 kg, 1.5 N·s/m, a noise of 0.2 m/s² and a latency of 30 ms."""
    folder = tmp_path_factory.mktemp("bags")
    return record(
        slider(2.0, 1.5, 0.2, 0.03), folder / "pushed.mcap", push, topics=["/imu", "/model/*", "/joint_states"]
    )


def test_mass_and_damping_come_back_from_joint_states(pushed: Path) -> None:
    result = simkit.fit(slider(), pushed, [MASS, DAMPING], compare=["/joint_states"])
    assert result.values == {MASS: pytest.approx(2.0, rel=1e-5), DAMPING: pytest.approx(1.5, rel=1e-5)}
    assert all(low <= value <= high for value, (low, high) in zip((2.0, 1.5), result.intervals.values(), strict=True))
    assert result.has_converged and result.method == "least-squares" and not result.confusions
    assert result.error_before > 0.1 and result.error_after < 1e-4


@pytest.mark.slow
def test_a_search_without_derivatives_finds_both(pushed: Path) -> None:
    pytest.importorskip("cmaes", reason="the extra fit is not installed")
    vary = [f"{MASS}=0.5:4", f"{DAMPING}=0.2:4"]
    result = simkit.fit(slider(), pushed, vary, compare=["/joint_states"], method="cma", seed=1)
    assert list(result.values.values()) == pytest.approx([2.0, 1.5], rel=1e-3)


def test_noisy_readings_give_an_interval_that_holds_the_truth(pushed: Path) -> None:
    world = slider(1.0, 1.5, 0.2, 0.03)
    result = simkit.fit(world, pushed, MASS, compare="/imu")
    low, high = result.intervals[MASS]
    assert low < 2.0 < high and 0.01 < high - low < 0.4
    assert result.values[MASS] == pytest.approx(2.0, rel=0.05)


def test_the_deviation_of_noise_comes_from_the_residuals(pushed: Path) -> None:
    path = "cart::car::imu.imu.linear_acceleration.x.noise.stddev"
    world = slider(2.0, 1.5, 0.1, 0.03)
    result = simkit.fit(world, pushed, [path], compare="/imu")
    low, high = result.intervals[path]
    assert low < 0.2 < high and result.values[path] == pytest.approx(0.2, rel=0.3)


def test_a_latency_comes_back_although_it_acts_in_whole_steps(pushed: Path) -> None:
    path = "cart::car::imu.latency"
    result = simkit.fit(slider(2.0, 1.5, 0.2, 0.01), pushed, [path], compare="/imu")
    low, high = result.intervals[path]
    assert low <= 0.03 <= high and high - low < 0.02
    assert result.values[path] == pytest.approx(0.03, abs=0.004)  # less than a step of 5 ms


@pytest.mark.slow
def test_a_pendulum_gives_its_damping_and_its_centre_of_mass(tmp_path: Path) -> None:
    bag = record(pendulum(0.08, 0.4), tmp_path / "swing.mcap", swing)
    vary = ["swing::hinge.axis.dynamics.damping", "swing::bob.inertial.com.z"]
    result = simkit.fit(pendulum(), bag, vary)
    assert list(result.values.values()) == pytest.approx([0.08, -0.4], rel=1e-3)


@pytest.mark.slow
def test_gains_of_a_controller_come_back(tmp_path: Path) -> None:
    bag = record(servo(35.0, 3.0), tmp_path / "turn.mcap", turn)
    with open_scenario(RunSpec(servo())) as sim:
        plugin = next(p.name for p in sim.loaded.world.models[0].plugins if "Position" in p.name)
    vary = [f"arm::{plugin}.{name}" for name in ("p_gain", "d_gain")]
    result = simkit.fit(servo(), bag, vary)
    assert list(result.values.values()) == pytest.approx([35.0, 3.0], rel=1e-3)


def test_parameters_that_act_alike_cannot_be_told_apart(tmp_path: Path) -> None:
    def fall(sim: simkit.Simulation) -> None:
        sim.publish("/model/cart/joint/slide/cmd_force", {"data": 0.0})
        sim.run(0.5)

    world = slider().replace('name="w">', 'name="w"><gravity>3 0 0</gravity>')
    bag = record(world.replace("<mass>1.0", "<mass>2.0"), tmp_path / "fall.mcap", fall)
    result = simkit.fit(world, bag, [MASS, DAMPING], compare="/joint_states")
    assert len(result.confusions) == 1
    assert "car.mass and slide.damping cannot be told apart" in result.confusions[0]
    assert "only their ratio is known" in result.confusions[0]
    assert result.values[MASS] / result.values[DAMPING] == pytest.approx(2.0, rel=1e-3)
    assert "SK-FIT-009" in {d.code for d in result.diagnostics}


@pytest.mark.slow
def test_the_same_seed_gives_the_same_result_in_several_processes(pushed: Path) -> None:
    fits = [simkit.fit(slider(), pushed, [MASS], compare="/joint_states", jobs=jobs, seed=4) for jobs in (1, 2)]
    assert fits[0].as_dict() | {"wall_time": 0} == fits[1].as_dict() | {"wall_time": 0}


@pytest.mark.slow
def test_several_recordings_validate_each_other(tmp_path: Path) -> None:
    world = slider(2.0, 1.5)
    bags = [record(world, tmp_path / f"{n}.mcap", partial(push, duration=0.4 + 0.2 * n)) for n in range(3)]
    result = simkit.fit(slider(), bags, [MASS, DAMPING], compare="/joint_states")
    assert [fold.name for fold in result.folds] == [str(bag) for bag in bags]
    for fold in result.folds:
        assert list(fold.values.values()) == pytest.approx([2.0, 1.5], rel=1e-3)


@pytest.mark.slow
def test_the_file_of_a_result_is_a_scenario_with_the_fitted_values(pushed: Path, tmp_path: Path) -> None:
    world = tmp_path / "slider.sdf"
    world.write_text(slider())
    result = simkit.fit(world, pushed, [MASS, DAMPING], compare="/joint_states")
    with open_scenario(read_scenario(result.save(tmp_path / "fitted.yaml"))) as sim:
        assert sim.link("cart::car").scene.inertial.mass == pytest.approx(2.0, rel=1e-5)
    page = result.report(tmp_path / "fit.html").read_text()
    assert MASS in page and "<svg" in page and "src=" not in page
    assert result.plot(tmp_path / "fit.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    "vary, code, text",
    [
        ("cart::car.inertial.mss", "SK-FIT-002", "did you mean 'cart::car.inertial.mass'"),
        ("nobody.mass", "SK-FIT-002", "no such path"),
        ("cart::car.pose", "SK-FIT-001", "not one number"),
        (f"{MASS}=3:1", "SK-FIT-001", "not below"),
        (f"{MASS}=heavy", "SK-FIT-001", "expected PATH"),
        (f"{MASS}=2:2", "SK-FIT-001", "not below"),
        (f"{MASS}=1:inf", "SK-FIT-001", "expected PATH"),
        (f"{MASS}=", "SK-FIT-001", "found no value"),
        ([MASS, MASS], "SK-FIT-001", "given twice"),
        ([], "SK-FIT-001", "no parameter"),
        ("cart::slide.axis.limit.upper=5", "SK-FIT-005", "changes no compared reading"),
    ],
)
def test_a_mistake_in_a_parameter_has_a_message(pushed: Path, vary: object, code: str, text: str) -> None:
    with pytest.raises(InputError, match=text) as error:
        simkit.fit(slider(), pushed, vary, compare="/joint_states")  # type: ignore[arg-type]
    assert error.value.code == code


def test_a_bag_without_commands_for_the_world_is_an_error(tmp_path: Path) -> None:
    bag = record(slider(), tmp_path / "quiet.mcap", push, topics=["/joint_states"])
    with pytest.raises(InputError, match=r"its inputs: /model/cart/joint/slide/cmd_force") as error:
        simkit.fit(slider(), bag, [MASS])
    assert error.value.code == "SK-FIT-003"


@pytest.mark.parametrize(
    "options, code, text",
    [
        ({"compare": "/joint_states.positon"}, "SK-CLI-030", "did you mean 'position"),
        ({"skip": 100.0}, "SK-FIT-010", "found 100 s, and the last reading is at"),
        ({"duration": 0.0}, "SK-FIT-010", "expected seconds above 0$"),
    ],
)
def test_options_that_leave_nothing_to_compare_are_named(
    pushed: Path, options: dict[str, Any], code: str, text: str
) -> None:
    with pytest.raises(InputError, match=text) as error:
        simkit.fit(slider(), pushed, MASS, jobs=1, **{"compare": "/joint_states", **options})
    assert error.value.code == code


def test_a_bag_that_was_cut_off_is_named_as_such(pushed: Path, tmp_path: Path) -> None:
    data = pushed.read_bytes()
    (tmp_path / "begun.mcap").write_bytes(data[:2500])
    with pytest.raises(InputError, match="cut off before the first message"):
        simkit.fit(slider(), tmp_path / "begun.mcap", MASS)


def test_readings_without_a_number_are_neither_compared_nor_counted(pushed: Path) -> None:
    channel = Channel("/imu", (), ("angular_velocity.x",))
    values = np.array([[0.0], [np.nan], [2.0]])
    recording = RepeatedRecording("bag", RunSpec("world"), (Readings(channel, np.arange(3.0), values),))
    residuals = Residuals([recording])
    assert residuals.count == 2
    assert residuals.vector(np.zeros(3)).tolist()[1] == 0.0


def test_a_bag_without_common_topics_is_an_error(tmp_path: Path) -> None:
    bag = record(slider(), tmp_path / "deaf.mcap", push, topics=["/model/*"])
    with pytest.raises(InputError) as error:
        simkit.fit(slider(), bag, [MASS])
    assert error.value.code == "SK-FIT-004"


def test_a_value_at_a_bound_is_a_warning(pushed: Path) -> None:
    result = simkit.fit(slider(), pushed, f"{MASS}=0.5:1.5", compare="/joint_states")
    assert result.values[MASS] == pytest.approx(1.5, rel=1e-3)
    assert "SK-FIT-007" in {d.code for d in result.diagnostics}


@pytest.mark.slow
def test_the_friction_of_wheels_comes_back_from_a_drive_that_slips(tmp_path: Path) -> None:
    friction = "turtlebot3::wheel_*_link::tread.surface.friction.ode.mu"
    bag = tmp_path / "slip.mcap"
    topics = ["/cmd_vel", "/odom", "/joint_states"]
    with (
        simkit.load("turtlebot3_empty", seed=3, overrides=[f"{friction}=0.03"]) as sim,
        Recorder(sim, bag, topics=topics),
    ):
        for forward, turn_rate in ((0.22, 0.0), (-0.22, 0.0), (0.0, 2.8)):
            sim.publish("/cmd_vel", {"linear": {"x": forward}, "angular": {"z": turn_rate}})
            sim.run(0.5)
    result = simkit.fit("turtlebot3_empty", bag, f"{friction}=0.01:0.6", compare="/joint_states", jobs=1)
    assert result.values[friction] == pytest.approx(0.03, rel=0.01)

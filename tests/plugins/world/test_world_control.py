"""Service `/world/<world>/control`: pause, step, reset, seed, run to a time, as in gz's server."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from service_worlds import load, model

import simkit

IMU = """<model name="rover"><pose>3 3 1 0 0 0</pose><link name="l"><sensor name="imu" type="imu">
<update_rate>100</update_rate><topic>/imu</topic><imu>
<linear_acceleration><x><noise type="gaussian"><stddev>0.1</stddev></noise>
</x></linear_acceleration></imu></sensor></link></model>"""


def control(sim: simkit.Simulation, **fields: Any) -> bool:
    """Call the control service and return its success."""
    return bool(sim.call("/world/w/control", {"world_control": fields}).success)


def test_the_world_pauses_and_resumes() -> None:
    with load() as sim:
        assert control(sim, pause=True)
        assert sim.paused
        assert control(sim, pause=False)
        assert not sim.paused


@pytest.mark.parametrize(("fields", "steps"), [({"step": True}, 1), ({"multi_step": 7}, 7)])
def test_steps_are_done_before_the_response_and_the_world_stays_paused(fields: dict[str, Any], steps: int) -> None:
    with load() as sim:
        assert control(sim, pause=True, **fields)
        assert (sim.tick, sim.paused) == (steps, True)
        assert control(sim, **fields)  # without `pause` just the same
        assert (sim.tick, sim.paused) == (2 * steps, True)


def test_the_world_runs_to_a_time_and_pauses() -> None:
    with load() as sim:
        assert control(sim, run_to_sim_time={"sec": 0, "nanosec": 250_000_000})
        assert (sim.time, sim.paused) == (0.25, True)


def test_a_time_in_the_past_is_refused_and_nothing_changes(caplog: pytest.LogCaptureFixture) -> None:
    with load() as sim:
        sim.run(0.5)
        assert not control(sim, run_to_sim_time={"nanosec": 100_000_000})
        assert (sim.time, sim.paused) == (0.5, False)
        assert "run_to_sim_time 0.1 s is in the past; the time is 0.5 s" in caplog.text


def test_in_a_served_world_the_server_does_the_steps() -> None:
    with load() as sim, sim.control.pausing.served():
        assert control(sim, pause=True, multi_step=7)
        assert sim.tick == 0
        sim.control.pausing.advance(1000)
        assert (sim.tick, sim.paused) == (7, True)


@pytest.mark.parametrize("how", ["all", "time_only"])
def test_both_kinds_of_reset_return_to_the_start_as_in_gz(how: str) -> None:
    with load() as sim:
        sim.spawn(model("more", "9 9 9 0 0 0"))
        sim.model("box").set_pose(simkit.Pose((4, 0, 2)))
        sim.run(0.1)
        assert control(sim, pause=True, reset={how: True})
        assert (sim.tick, sim.paused, list(sim.models)) == (0, True, ["ground", "box", "arm"])
        assert sim.model("box").pose.position == pytest.approx((0, 0, 0.5))


def test_a_reset_of_models_keeps_the_time() -> None:
    with load() as sim:
        sim.spawn(model("more", "9 9 9 0 0 0"))
        sim.remove("arm")
        sim.model("box").set_pose(simkit.Pose((4, 0, 2)))
        sim.model("box").set_velocity((1, 2, 3))
        sim.model("ground").set_pose(simkit.Pose((0, 0, -1)))
        sim.run(0.1)
        assert control(sim, reset={"model_only": True})
        assert sim.time == 0.1
        assert sim.model("box").pose.position == pytest.approx((0, 0, 0.5))
        assert sim.model("more").pose.position == pytest.approx((9, 9, 9))  # spawned: to where it came
        assert sim.model("ground").pose.position == pytest.approx((0, 0, 0))
        assert not sim.link("box::body").linear_velocity.any()
        assert "arm" not in sim.models  # removed: stays away


def test_reset_models_repeat_their_first_motion() -> None:
    with load() as sim:
        sim.joint("arm::hinge").set_velocity(1.0)
        sim.run(0.3)
        first = sim.mj_data.qpos.copy()
        sim.control.reset_models()
        assert sim.joint("arm::hinge").velocity == 0.0
        sim.joint("arm::hinge").set_velocity(1.0)
        sim.run(0.3)
        assert sim.mj_data.qpos == pytest.approx(first, abs=1e-12)


def noise(sim: simkit.Simulation) -> list[float]:
    sub = sim.subscribe("/imu")
    sim.run(0.1)
    sub.close()
    return [m.linear_acceleration.x for m in sub.messages]


def test_a_seed_applies_to_all_later_samples() -> None:
    with load(IMU, seed=1) as sim, load(IMU, seed=2) as other:
        one, two = noise(sim), noise(other)
        assert not np.array_equal(one, two)
        assert control(sim, reset={"all": True}, seed=2)
        assert noise(sim) == two
        sim.reset(seed=1)
        assert control(sim, seed=2)
        assert noise(sim) == two


def test_a_hook_may_call_the_control_service() -> None:
    class Stops(simkit.WorldPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            self.after_step_rate = 100.0

        def after_step(self) -> None:
            if self.sim.tick == 20:
                control(self.sim, pause=True, multi_step=5)

    with load(plugins=[Stops()]) as sim:
        sim.control.pausing.advance(1000)
        assert (sim.tick, sim.paused) == (25, True)


def test_the_service_name_has_only_valid_characters() -> None:
    with simkit.load('<sdf version="1.9"><world name="my world"/></sdf>') as sim:
        assert sim.call("/world/my_world/control", {"world_control": {"multi_step": 2}}).success
        assert sim.tick == 2

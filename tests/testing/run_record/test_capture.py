"""Records of scenario runs."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest
from falling import ball

import simkit
from simkit.errors import InputError
from simkit.run_spec import RunSpec
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing.run_record.record import RunRecord
from simkit.testing.run_record.run_recorder import record_run
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> RunRecord:
    scenario = RunSpec(str(ball(tmp_path_factory.mktemp("ball"))), duration=1.0)
    found = record_run(scenario)
    found.simulation.close()
    return found


def test_every_topic_has_its_numbers_times_and_digest(record: RunRecord) -> None:
    imu = next(s for s in record.streams.values() if s.type_name == "sensor_msgs/msg/Imu")
    # at 100 Hz over one second, and the reading after the first step
    assert len(imu.times_ns) == 101
    assert imu.columns["linear_acceleration.x"].values.shape == (101,)
    assert imu.columns["header.stamp"].values.tolist() == imu.times_ns.tolist()
    assert imu.words["header.frame_id"] == ["ball::l::imu"] * 101
    scan = next(s for s in record.streams.values() if s.type_name == "sensor_msgs/msg/LaserScan")
    assert scan.columns["ranges"].values.shape == (11, 36)
    assert len(scan.digest) == 64 and len(scan.chunks) == 2


def test_a_digest_is_that_of_the_messages_that_a_subscriber_gets(tmp_path: Path, record: RunRecord) -> None:
    topic = next(s.topic for s in record.streams.values() if s.type_name == "sensor_msgs/msg/Imu")
    with simkit.load(str(ball(tmp_path))) as sim:
        heard = sim.subscribe(topic)
        sim.run(1.0)
        whole = hashlib.sha256(b"".join(simkit.msgs.serialize(m) for m in heard.messages)).hexdigest()
    assert record.streams[topic].digest == whole


def test_recording_changes_nothing_of_the_run(tmp_path: Path, record: RunRecord) -> None:
    scenario = RunSpec(str(ball(tmp_path)), duration=1.0)
    with open_scenario(scenario) as sim:
        run_scenario(scenario, sim)
        assert state_hash(sim) == record.states.digest


def test_every_tick_has_a_mark_and_some_ticks_have_a_state(record: RunRecord) -> None:
    states = record.states
    assert states.marks.shape == states.inputs.shape == (1000,)
    # a falling ball has another state at each tick; two marks are equal with a probability of 1/256
    falling = states.marks[:150]
    assert (falling[1:] != falling[:-1]).mean() > 0.95
    assert states.ticks[0] == 0 and states.ticks[-1] == 1000 and 32 < len(states.ticks) <= 66
    heights = states.values[:, states.names.index("ball::l position z")]
    assert heights[0] == 0.3
    time = states.ticks[5] * states.timestep
    assert heights[5] == pytest.approx(0.3 - 0.5 * 9.8 * time**2, abs=9.8 * 0.001 * time)  # semi-implicit Euler's lag


def test_a_force_changes_the_inputs_from_its_tick_on(tmp_path: Path) -> None:
    def inputs(push: bool) -> np.ndarray:
        scenario = RunSpec(str(ball(tmp_path)), duration=0.1, plugins=(_Pusher(push),))
        found = record_run(scenario)
        found.simulation.close()
        return found.states.inputs

    calm, pushed = inputs(False), inputs(True)
    assert np.flatnonzero(calm != pushed).tolist() == [50]


class _Pusher(simkit.WorldPlugin):
    def __init__(self, push: bool) -> None:
        super().__init__()
        self._push = push

    def load(self, sim: object, params: object) -> None:
        pass

    def before_step(self) -> None:
        if self.sim.tick == 50 and self._push:
            self.sim.model("ball").link("l").apply_wrench((1.0, 0.0, 0.0))


def test_the_order_of_models_in_a_file_has_no_effect_on_a_record(tmp_path: Path, record: RunRecord) -> None:
    text = ball(tmp_path).read_text()
    start, stop = text.index('<model name="wall">'), text.index("</world>")
    wall = text[start:stop]
    text = text.replace(wall, "").replace('<model name="floor">', wall + '<model name="floor">')
    (tmp_path / "other.sdf").write_text(text)
    other = record_run(RunSpec(str(tmp_path / "other.sdf"), duration=1.0))
    other.simulation.close()
    assert other.leaves == record.leaves
    assert other.states.named_digest == record.states.named_digest
    assert {t: s.digest for t, s in other.streams.items()} == {t: s.digest for t, s in record.streams.items()}
    assert all(np.array_equal(other.fields[name], record.fields[name]) for name in record.fields)


def test_patterns_choose_topics(tmp_path: Path) -> None:
    path = str(ball(tmp_path))
    for scenario, wanted in (
        (RunSpec(path, duration=0.1, topics=("*imu*",)), 1),
        (RunSpec(path, duration=0.1, skip=("*imu*", "/tf*")), 2),
    ):
        found = record_run(scenario)
        found.simulation.close()
        assert len(found.streams) == wanted, list(found.streams)


def test_the_record_of_a_failed_run_has_the_error(tmp_path: Path) -> None:
    class Faulty(simkit.WorldPlugin):
        def load(self, sim: object, params: object) -> None:
            pass

        def after_step(self) -> None:
            if self.sim.tick == 20:
                raise ValueError("the wheel fell off")

    found = record_run(RunSpec(str(ball(tmp_path)), duration=0.1, plugins=(Faulty(),)))
    found.simulation.close()
    assert "the wheel fell off" in found.end
    assert isinstance(found.error, simkit.PluginError)
    assert 19 <= len(found.states.marks) <= 20


def test_a_missing_world_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InputError):
        record_run(RunSpec(str(tmp_path / "none.sdf")))

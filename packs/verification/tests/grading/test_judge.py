"""The judge of a recorded run finds the same results as a watch on the simulation."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import simkit
from simkit import Check, ModelPlugin, RunSpec
from simkit.testing import Watch
from simkit_verification.testing.grading import run_stream
from simkit_verification.testing.grading.judge_process import RunJudge
from simkit_verification.testing.grading.run_recorder import RunRecorder
from simkit_verification.testing.grading.run_stream import CLOCK, NUMBER, DamagedStreamError, FrameReader, FrameWriter

WORLD = """<sdf version="1.9"><world name="yard"><physics type="ode"><max_step_size>0.002</max_step_size></physics>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
</link></model>
<model name="ball"><pose>0 0 0.3 0 0 0</pose><link name="base">
  <inertial><mass>1</mass><inertia><ixx>.025</ixx><iyy>.025</iyy><izz>.025</izz></inertia></inertial>
  <collision name="c"><geometry><sphere><radius>0.25</radius></sphere></geometry></collision>
  <sensor name="imu" type="imu"><update_rate>50</update_rate><topic>/imu</topic></sensor></link></model>
<model name="arm"><pose>0 3 0 0 0 0</pose><link name="foot"/>
  <link name="beam"><pose>0 0 1 0 0 0</pose><inertial><mass>1</mass></inertial></link>
  <joint name="fix" type="fixed"><parent>world</parent><child>foot</child></joint>
  <joint name="hinge" type="revolute"><parent>foot</parent><child>beam</child><axis><xyz>0 1 0</xyz></axis></joint>
</model></world></sdf>"""

EXPRESSIONS = (
    "pose('ball').z < 0.27",
    "distance('ball', 'arm::beam') > 2 and pose('ball', 'arm::beam').x < 1",
    "velocity('ball').z < -0.5",
    "norm(twist('ball', 'arm').angular) < 0.1",
    "joint('arm::hinge').position > 0 and joint('arm::hinge').lower < 0",
    "contact('ball', 'ground')",
    "contacts('ball', 'ground') == 0 or contact_force('ball', 'ground') > 1",
    "topic('/imu').linear_acceleration.z > 5",
    "count('/imu') > 10 and rate('/imu') > 49 and age('/imu') < 0.03",
    "lowest(pose('ball').z) < 0.26",
    "average(topic('/imu').linear_acceleration.z) > 1",
    "highest(topic('/imu').linear_acceleration.z - pose('ball').z) > 3",
    "path_length('ball') > 0.01",
    "first_time(contact('ball', 'ground')) < 0.2 and collisions('ball', 'ground') >= 1",
    "time_true(pose('ball').z < 0.26) > 0.1 and integral(pose('ball').z) > 0",
    "exists('ball') and not exists('block')",
    "topic('/late').data > 2",
    "topic('/never').data > 2",
    "time > 0.1 and tick > 3",
    "pose('ball').y > 1",
)


class Late(ModelPlugin):
    """Plugin that publishes on a topic that does not exist at the beginning."""

    after_step_rate = 20.0

    def load(self, parent: object, params: object) -> None:
        self.count, self.late = 0, None

    def after_step(self) -> None:
        self.count += 1
        if self.count == 3:
            self.late = self.advertise("/late", "std_msgs/msg/Float64")
        if self.late is not None:
            self.late.publish({"data": float(self.count)})


@contextmanager
def stream() -> Iterator[tuple[FrameWriter, Path]]:
    """Yield the writer of a stream to a file."""
    with tempfile.NamedTemporaryFile() as file:
        yield FrameWriter(file.fileno(), b"key"), Path(file.name)


@pytest.mark.parametrize("kind", ["goal", "always", "final"])
def test_the_judge_agrees_with_a_watch_on_the_simulation(kind):
    checks = [Check(kind, expression=expression) for expression in EXPRESSIONS]
    if kind == "always":
        checks += [
            Check("apart", models=("ball",)),
            Check("apart", models=("ball", "arm")),
            Check("rate", topic="/imu"),
        ]
    scenario = RunSpec(WORLD, duration=0.4, checks=tuple(checks))
    with stream() as (writer, file), simkit.load(WORLD, plugins=[("ball", Late())]) as sim:
        with RunRecorder(sim, scenario, writer, []) as recorder, Watch(sim, checks, absent="wait") as watch:
            sim.step(200)
            recorder.finish({"reason": "duration"})
            expected = watch.results("duration")
        judge = RunJudge(scenario)
        for frame in FrameReader(b"key").feed(file.read_bytes()):
            judge.take(*frame)
    results, error = judge.results()
    assert not error and [one.check for one in results] == checks
    for one, other in zip(results, expected, strict=True):
        assert (one.passed, one.message) == (other.passed, other.message)
        assert one.time == other.time


def test_bytes_that_the_writer_did_not_send_damage_the_stream():
    with stream() as (writer, file):
        writer.add(run_stream.BEAT, CLOCK.pack(1, 1, 1.0))
        writer.flush()
        first = file.read_bytes()
        writer.add(run_stream.BEAT, CLOCK.pack(2, 2, 2.0))
        writer.flush()
        second = file.read_bytes()[len(first) :]
    assert len(list(FrameReader(b"key").feed(first + second))) == 2
    for damaged in (second, first + first, first + b"x" * 40 + second, b"\xff" * 60, first[:-1] + b"x"):
        with pytest.raises(DamagedStreamError):
            list(FrameReader(b"key").feed(damaged))
    with pytest.raises(DamagedStreamError):
        list(FrameReader(b"other key").feed(first))


def frames_of_a_run(*changes: tuple[int, bytes]) -> RunJudge:
    """Return a judge that has taken the names of a world and some frames."""
    judge = RunJudge(RunSpec(WORLD, duration=1.0, checks=(Check("goal", expression="pose('ball').z > 9"),)))
    names = {
        "model": ["ball"],
        "link": [],
        "joint": {},
        "collision": [],
        "topics": {},
        "foreign": [],
        "timestep": 0.002,
    }
    judge.take(run_stream.NAMES, json.dumps(names).encode())
    judge.take(run_stream.SOURCE, json.dumps({"number": 0, "key": ["pose", "ball"]}).encode())
    judge.take(run_stream.STEP, CLOCK.pack(0, 0, 0.0))
    for change in changes:
        judge.take(*change)
    return judge


@pytest.mark.parametrize(
    "change",
    [
        (run_stream.STEP, CLOCK.pack(5, 5, 0.01)),
        (run_stream.STEP, b""),
        (run_stream.VALUE, NUMBER.pack(7) + b"="),
        (run_stream.VALUE, b""),
        (run_stream.NAMES, b"[" * 100_000),
        (run_stream.NAMES, b'{"model": [1]}'),
        (run_stream.SOURCE, b'{"key": ["code", "x"]}'),
        (run_stream.SOURCE, b"{}"),
        (run_stream.END, b"\xff"),
    ],
    ids=str,
)
def test_an_invalid_frame_is_a_damaged_stream(change):
    with pytest.raises(DamagedStreamError):
        frames_of_a_run(change)


def test_a_value_of_a_wrong_size_is_a_damaged_stream():
    with pytest.raises(DamagedStreamError):
        frames_of_a_run((run_stream.VALUE, NUMBER.pack(0) + b"=abc"), (run_stream.STEP, CLOCK.pack(1, 1, 0.002)))


def test_an_end_before_the_duration_gets_no_results():
    judge = frames_of_a_run((run_stream.END, b'{"reason": "duration"}'))
    assert judge.results() == ((), "the run ended at t = 0 s, before t = 1 s")

"""Statistics, clock and poses of a world, as in gz: no cost without subscribers, no effect on the state."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from service_worlds import load, model

import simkit
from simkit import msgs
from simkit.recording.bags.recorder import Recorder
from simkit.recording.topic_counts import TopicCounter

WALL = ("real_time", "pause_time", "real_time_factor")
ASIDE = {"/stats", "/world/w/stats", "/world/w/clock", "/world/w/pose/info", "/world/w/dynamic_pose/info"}


def plain(message: Any) -> dict[str, Any]:
    """Return the fields of statistics that do not depend on the wall clock."""
    return {k: v for k, v in vars(message).items() if k not in WALL}


def test_statistics_come_five_times_a_second_of_simulated_time() -> None:
    with load() as sim:
        one, other = sim.subscribe("/stats"), sim.subscribe("/world/w/stats")
        sim.run(1.0)
        assert [msgs.stamp_ns(m.sim_time) for m in one.messages] == [k * 200_000_000 for k in range(1, 6)]
        assert [plain(m) for m in other.messages] == [plain(m) for m in one.messages]
        last = one.latest
        assert msgs.type_name(last) == "ros_gz_interfaces/msg/WorldStatistics"
        assert (last.iterations, last.model_count, last.paused, last.stepping) == (1000, 3, False, False)
        assert msgs.stamp_ns(last.step_size) == 1_000_000


def test_the_real_time_factor_is_simulated_time_over_wall_clock_time() -> None:
    with load() as sim:
        stats = sim.subscribe("/stats")
        sim.run(2.0)
        first, last = stats.messages[0], stats.latest
        real = (msgs.stamp_ns(last.real_time) - msgs.stamp_ns(first.real_time)) * 1e-9
        assert last.real_time_factor == pytest.approx(1.8 / real, rel=1e-6)
        assert 0.0 < real < 60.0


def test_a_pause_is_published_at_once() -> None:
    with load() as sim:
        stats = sim.subscribe("/stats")
        sim.run(0.05)
        sim.paused = True
        assert (stats.latest.paused, msgs.stamp_ns(stats.latest.sim_time)) == (True, 50_000_000)
        assert msgs.stamp_ns(stats.latest.step_size) == 0
        sim.control.pausing.step(10)
        assert (stats.latest.paused, stats.latest.stepping) == (False, True)
        sim.paused = False
        assert (stats.latest.paused, stats.latest.stepping) == (False, False)


def test_nothing_is_scheduled_without_subscribers() -> None:
    with load() as sim:
        before = len(sim.engine.scheduler.after._tasks)
        sub = sim.subscribe("/world/w/pose/info")
        assert len(sim.engine.scheduler.after._tasks) == before + 1
        sub.close()
        assert len(sim.engine.scheduler.after._tasks) == before


def test_subscribers_do_not_change_the_state() -> None:
    with load() as alone, load() as heard:
        alone.model("box").set_velocity((1, 0, 3), (1, 2, 3))
        heard.model("box").set_velocity((1, 0, 3), (1, 2, 3))
        alone.run(1.0)
        heard.run(0.1)
        subs = [heard.subscribe(topic) for topic in ASIDE]
        heard.run(0.4)
        for sub in subs[:2]:
            sub.close()
        heard.run(0.5)
        assert np.array_equal(alone.mj_data.qpos, heard.mj_data.qpos)
        assert np.array_equal(alone.mj_data.qvel, heard.mj_data.qvel)


def test_a_subscriber_in_the_middle_of_a_run_gets_messages_from_then_on() -> None:
    class Late(simkit.WorldPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            self.after_step_rate = 2.0
            self.heard: Any = None

        def after_step(self) -> None:
            if self.heard is None:
                self.heard = self.sim.subscribe("/stats")

    with load(plugins=[late := Late()]) as sim:
        sim.run(1.0)
        assert [msgs.stamp_ns(m.sim_time) for m in late.heard.messages] == [600_000_000, 800_000_000, 1_000_000_000]


def test_the_clock_of_the_world_equals_the_ros_clock() -> None:
    with load() as sim:
        own, ros = sim.subscribe("/world/w/clock"), sim.subscribe("/clock")
        sim.run(0.1)
        assert own.messages == ros.messages
        assert len(own.messages) == 10


def positions_by_frame(message: Any) -> dict[str, tuple[str, tuple[float, ...]]]:
    """Map each child frame to its parent frame and position."""
    found = {}
    for t in message.transforms:
        at = t.transform.translation
        found[t.child_frame_id] = (t.header.frame_id, (at.x, at.y, at.z))
    return found


def test_poses_of_all_entities_are_in_the_frames_of_their_parents() -> None:
    with load() as sim:
        every, moving = sim.subscribe("/world/w/pose/info"), sim.subscribe("/world/w/dynamic_pose/info")
        sim.joint("arm::hinge").set_position(0.5)
        sim.run(0.1)
        assert (len(every.messages), len(moving.messages)) == (6, 6)  # at k/60 s
        found = positions_by_frame(every.latest)
        assert found["box"] == ("w", pytest.approx((0, 0, 0.5), abs=1e-3))
        assert found["box::body"][0] == "box"
        assert found["box::body::skin"] == ("box::body", (0, 0, 0))
        assert found["arm::tip"] == ("arm", pytest.approx((1, 0, 0)))
        assert found["lamp"] == ("w", (2, 0, 3))
        turn = next(t for t in every.latest.transforms if t.child_frame_id == "arm::tip").transform.rotation
        assert 2 * math.atan2(turn.z, turn.w) == pytest.approx(sim.joint("arm::hinge").position, abs=1e-9)
        assert set(positions_by_frame(moving.latest)) == {"box", "box::body", "arm", "arm::base", "arm::tip"}


def test_poses_include_a_spawned_model() -> None:
    with load() as sim:
        moving = sim.subscribe("/world/w/dynamic_pose/info")
        sim.spawn(model("one", "4 0 0.5 0 0 0"))
        sim.run(0.1)
        assert positions_by_frame(moving.latest)["one"] == ("w", pytest.approx((4, 0, 0.5), abs=1e-3))


def recorded(path: Path, **options: Any) -> set[str]:
    """Return the topics of a recording of half a second, and its contents."""
    with load() as sim:
        with Recorder(sim, path, **options):
            sim.run(0.5)
        return set(sim.communication.bus.all_topics())


def topics_of(path: Path) -> set[str]:
    from mcap.reader import make_reader

    with path.open("rb") as stream:
        return {channel.topic for _, channel, _ in make_reader(stream).iter_messages()}


def test_a_recorder_skips_these_topics_unless_they_are_named(tmp_path: Path) -> None:
    assert recorded(tmp_path / "a.mcap") >= ASIDE
    recorded(tmp_path / "b.mcap")
    recorded(tmp_path / "c.mcap", topics=["/world/w/stats", "/clock"])
    assert not topics_of(tmp_path / "a.mcap") & ASIDE
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "b.mcap").read_bytes()
    assert topics_of(tmp_path / "c.mcap") == {"/world/w/stats", "/clock"}


def test_all_topics_except_statistics_are_listed_only_with_subscribers() -> None:
    with load() as sim:
        assert set(sim.topics()) & ASIDE == {"/stats", "/world/w/stats"}
        sub = sim.subscribe("/world/w/pose/info")
        assert sim.topics()["/world/w/pose/info"] == "tf2_msgs/msg/TFMessage"
        sub.close()
        assert "/world/w/pose/info" not in sim.topics()


def test_a_message_counter_does_not_subscribe_to_them() -> None:
    with load() as sim:
        counter = TopicCounter(sim)
        sim.run(0.1)
        assert not {row.topic for row in counter.rows} & ASIDE
        assert not any(sim.communication.bus.wanted(topic) for topic in ASIDE)


def test_wall_clock_time_is_not_part_of_the_state() -> None:
    with load() as sim:
        stats = sim.subscribe("/stats")
        sim.run(0.4)
        before, snapshot = stats.messages, sim.snapshot()
        sim.run(0.4)
        sim.restore(snapshot)
        sim.run(0.4)
        again = stats.messages
        assert [plain(m) for m in again[4:]] == [plain(m) for m in again[2:4]]
        reals = [msgs.stamp_ns(m.real_time) for m in again]
        assert reals == sorted(reals)  # a restored run does not give back the time
        assert len(before) == 2

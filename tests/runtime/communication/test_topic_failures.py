"""Failures on topics: subscribers that raise, type conflicts, too many messages, and snapshots during a step."""

import numpy as np
import pytest

import simkit
from simkit import msgs
from simkit.diagnostics import Diagnostics
from simkit.errors import PluginError, SubscriberError
from simkit.runtime.communication.command_queue import QUEUE_DEPTH
from simkit.runtime.communication.topic_bus import TopicBus

FLOAT = "std_msgs/msg/Float64"

WORLD = """
<sdf version="1.9"><world name="w">
  <physics type="ignored"><max_step_size>0.001</max_step_size></physics>
  <model name="box">
    <pose>0 0 1 0 0 0</pose>
    <link name="base">
      <inertial><mass>1</mass></inertial>
      <sensor name="imu" type="imu"><topic>imu</topic><update_rate>200</update_rate>
        <imu><angular_velocity><x><noise type="gaussian"><stddev>0.01</stddev></noise></x></angular_velocity></imu>
      </sensor>
      <sensor name="altimeter" type="altimeter"><topic>height</topic><update_rate>100</update_rate><altimeter>
        <vertical_position><noise type="gaussian"><stddev>0.01</stddev></noise></vertical_position></altimeter></sensor>
    </link>
  </model>
</world></sdf>
"""


def number(value):
    return msgs.make(FLOAT, data=float(value))


class Talker(simkit.WorldPlugin):
    """Publish the number of its calls plus the sum of the received numbers."""

    after_step_rate = 100.0

    def load(self, parent, params):
        self.calls, self.heard = 0, 0.0
        self.publisher = self.advertise("said", FLOAT)
        self.listen("heard", FLOAT, self.on_heard)

    def on_heard(self, message):
        self.heard += message.data

    def after_step(self):
        self.calls += 1
        self.publisher.publish(number(self.calls + self.heard))
        self.calls += 1


# ---------------------------------------------------------------------- subscribers that raise


def on_imu(message):
    raise KeyError("no such wheel")


def test_a_subscriber_that_raises_stops_the_run_with_its_topic_name_and_line():
    sim = simkit.load(WORLD)
    sim.subscribe("/imu", on_imu)
    reported = r"'on_imu' \(.*test_topic_failures\.py:\d+\) of '/imu' raised at t=0"
    with pytest.raises(SubscriberError, match=reported) as e:
        sim.step(10)
    assert e.value.exit_code == 4
    assert isinstance(e.value.__cause__, KeyError)


def test_an_exception_of_a_subscriber_is_not_attributed_to_the_publishing_plugin():
    sim = simkit.load(WORLD, plugins=[Talker()])
    sim.subscribe("/said", on_imu)
    with pytest.raises(SubscriberError, match="on_imu.*'/said'"):
        sim.run(0.1)


def test_with_on_error_drop_a_subscriber_that_raises_is_closed_and_the_run_continues():
    sim = simkit.load(WORLD)
    faulty, sound = sim.subscribe("/imu", on_imu, on_error="drop"), sim.subscribe("/imu")
    sim.run(0.1)
    assert len(faulty.messages) == 1
    assert len(sound.messages) == 21  # 20 regular samples, and one after the first step
    reported = [d for d in sim.diagnostics if d.code == "SK-TOPIC-003"]
    assert len(reported) == 1
    assert "'/imu'" in reported[0].message
    assert "no such wheel" in reported[0].message


def test_an_unknown_on_error_policy_is_an_error():
    with pytest.raises(ValueError, match="'stop' or 'drop'"):
        simkit.load(WORLD).subscribe("/imu", on_imu, on_error="ignore")


def test_a_plugin_whose_input_raises_is_named():
    class Faulty(Talker):
        def on_heard(self, message):
            raise ValueError("too loud")

    sim = simkit.load(WORLD, plugins=[Faulty()])
    sim.publish("/heard", {"data": 1.0})
    with pytest.raises(PluginError, match=r"'Faulty'.*its callback for '/heard'.*too loud"):
        sim.step()


def test_commands_after_an_input_that_raised_wait_for_the_next_step():
    bus, got = TopicBus(), []

    def take(message):
        if message.data == 2.0:
            raise ValueError("two")
        got.append(message.data)

    bus.listen("/x", (FLOAT,), take)
    for value in (1.0, 2.0, 3.0):
        bus.publish("/x", number(value))
    with pytest.raises(SubscriberError, match="two"):
        bus.deliver_inputs()
    bus.deliver_inputs()
    assert got == [1.0, 3.0]


# ---------------------------------------------------------------------- too many messages


def test_a_full_queue_keeps_the_newest_messages_and_reports_dropped_ones_once():
    reports = Diagnostics()
    bus, got = TopicBus(reports), []
    bus.listen("/x", (FLOAT,), lambda m: got.append(m.data))
    for i in range(20_000):
        bus.publish("/x", number(i))
    assert len(bus.inbox) == QUEUE_DEPTH
    bus.deliver_inputs()
    assert got == list(range(20_000 - QUEUE_DEPTH, 20_000))
    assert bus.dropped == {"/x": 20_000 - QUEUE_DEPTH}
    assert [d.code for d in reports] == ["SK-TOPIC-004"]
    assert f"more than {QUEUE_DEPTH} messages on '/x'" in next(iter(reports)).message


def test_too_many_messages_on_one_topic_do_not_affect_other_topics_or_the_order():
    bus, got = TopicBus(), []
    bus.listen("/flood", (FLOAT,), lambda m: got.append(m.data), depth=2)
    bus.listen("/rare", (FLOAT,), lambda m: got.append(-m.data))
    for i in range(1, 6):
        bus.publish("/flood", number(i))
        if i == 4:
            bus.publish("/rare", number(i))
    bus.enqueue(lambda: got.append(0.0))
    bus.deliver_inputs()
    assert got == [4.0, -4.0, 5.0, 0.0]


def test_a_hundred_messages_in_every_step_are_all_received():
    sim = simkit.load(WORLD, plugins=[talker := Talker()])
    for _ in range(100):
        for _ in range(100):
            sim.publish("/heard", number(1))
        sim.step()
    assert talker.heard == 10_000
    assert not sim.communication.bus.dropped


def test_snapshots_contain_waiting_messages_and_a_reset_drops_them():
    sim = simkit.load(WORLD, plugins=[talker := Talker()])
    sim.publish("/heard", number(3))
    before = sim.snapshot()
    sim.step()
    assert talker.heard == 3
    sim.restore(before)
    assert talker.heard == 0
    sim.step()
    assert talker.heard == 3
    sim.publish("/heard", number(4))
    sim.reset()
    sim.step()
    assert talker.heard == 0


def test_an_input_that_resets_ends_the_delivery():
    sim = simkit.load(WORLD)
    sim.step(5)
    got = []
    sim.communication.bus.listen("/go", (FLOAT,), lambda m: (got.append(m.data), sim.reset()))
    sim.publish("/go", number(1))
    sim.publish("/go", number(2))
    sim.step()
    assert got == [1.0]
    assert sim.tick == 1


# ---------------------------------------------------------------------- subscriptions do not change the run


def test_subscriptions_and_floods_of_messages_change_no_bit():
    def run(listen):
        sim = simkit.load(WORLD, plugins=[Talker()])
        listen(sim)
        sim.run(0.3)
        state = np.concatenate((sim.mj_data.qpos, sim.mj_data.qvel))
        return state.tobytes(), msgs.serialize(sim.sensor("box::base::imu").latest)

    alone = run(lambda sim: None)
    assert run(lambda sim: [sim.subscribe(topic) for topic in sim.topics()]) == alone
    assert run(lambda sim: [sim.subscribe(topic, lambda m: None, keep=1) for topic in sim.topics()]) == alone
    assert run(lambda sim: sim.subscribe("/imu", on_imu, on_error="drop")) == alone

    def flood(sim):
        for _ in range(2000):
            sim.publish("/heard", number(0))

    assert run(flood) == alone


# ---------------------------------------------------------------------- snapshots during a step


@pytest.mark.parametrize("topic", ["/imu", "/height", "/said"])
def test_a_run_restored_to_a_snapshot_taken_in_a_callback_repeats(topic):
    sim = simkit.load(WORLD, plugins=[talker := Talker()])
    taken = []

    def take_snapshot(message):
        if sim.time >= 0.05 and not taken:
            taken.append(sim.snapshot())

    sim.subscribe(topic, take_snapshot)
    heard = {t: sim.subscribe(t) for t in ("/imu", "/height", "/said")}
    sim.run(0.05)
    assert taken[0].tick == 50
    counts = {t: len(s.messages) for t, s in heard.items()}
    calls = talker.calls
    sim.run(0.1)
    first = {t: [msgs.serialize(m) for m in s.messages[counts[t] :]] for t, s in heard.items()}
    sim.restore(taken[0])
    assert sim.tick == 50
    assert talker.calls == calls
    counts = {t: len(s.messages) for t, s in heard.items()}
    sim.run(0.1)
    assert {t: [msgs.serialize(m) for m in s.messages[counts[t] :]] for t, s in heard.items()} == first


def test_a_snapshot_requested_in_a_step_cannot_be_restored_before_the_step_ends():
    sim = simkit.load(WORLD)

    def restore_own_snapshot(message):
        sim.restore(sim.snapshot())

    sim.subscribe("/imu", restore_own_snapshot)
    with pytest.raises(SubscriberError, match="in a step that has not ended"):
        sim.step()


def test_a_snapshot_requested_in_a_step_that_never_ended_cannot_be_restored():
    sim = simkit.load(WORLD)
    sim.step(10)
    before, taken = sim.snapshot(), []

    def restore_earlier(message):
        if not taken:
            taken.append(sim.snapshot())
            sim.restore(before)

    sim.subscribe("/imu", restore_earlier)
    sim.step(10)
    assert not taken[0].is_complete
    with pytest.raises(ValueError, match="not ended"):
        sim.restore(taken[0])


# ---------------------------------------------------------------------- two types on one topic

CLASHING = """
<sdf version="1.9"><world name="w">
  <model name="rover">
    <link name="base"/>
    <link name="a"/><joint name="l" type="revolute"><parent>base</parent><child>a</child><axis/></joint>
    <link name="b"/><joint name="r" type="revolute"><parent>base</parent><child>b</child><axis/></joint>
    <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
      <left_joint>l</left_joint><right_joint>r</right_joint><topic>{drive}</topic><odom_topic>{odometry}</odom_topic>
    </plugin>
    <plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">
      <joint_name>l</joint_name><topic>{joint}</topic>
    </plugin>
  </model>
  <model name="box"><link name="base">
    <sensor name="imu" type="imu"><topic>{imu}</topic><imu/></sensor>
  </link></model>
</world></sdf>
"""
APART = {"drive": "cmd_vel", "odometry": "odom", "joint": "joint", "imu": "imu"}


def clashing(tmp_path, **topics):
    path = tmp_path / "clash.sdf"
    path.write_text(CLASHING.format(**{**APART, **topics}), encoding="utf-8")
    return path


def test_two_plugins_with_different_types_on_one_topic_are_an_error_with_both_lines(tmp_path):
    with pytest.raises(simkit.LoadError) as found:
        simkit.load(clashing(tmp_path, drive="x", joint="x"))
    (error,) = [d for d in found.value.diagnostics if d.severity == "error"]
    assert error.code == "SK-TOPIC-001"
    assert error.line == 10
    assert "'/x'" in error.message
    assert "std_msgs/msg/Float64" in error.message
    assert "geometry_msgs/msg/Twist" in error.message
    assert "clash.sdf:7)" in error.message


def test_a_plugin_cannot_receive_a_topic_with_another_type_than_its_publisher(tmp_path):
    with pytest.raises(simkit.LoadError, match=r"SK-TOPIC-001.*takes .*Float64.*publishes nav_msgs/msg/Odometry"):
        simkit.load(clashing(tmp_path, odometry="x", joint="x"))


def test_a_plugin_and_a_sensor_with_different_types_are_an_error_and_with_one_type_a_warning(tmp_path):
    with pytest.raises(simkit.LoadError, match=r"SK-TOPIC-001.*sensor 'box::base::imu'|SK-TOPIC-001.*DiffDrive"):
        simkit.load(clashing(tmp_path, odometry="x", imu="x"))

    class Second(simkit.WorldPlugin):
        def load(self, parent, params):
            self.imu = self.advertise("imu", "sensor_msgs/msg/Imu")

    with simkit.load(clashing(tmp_path), plugins=[Second()]) as sim:
        (reported,) = [d for d in sim.diagnostics if d.code.startswith("SK-TOPIC")]
    assert (reported.code, reported.severity) == ("SK-TOPIC-006", "warning")
    assert "clash.sdf:15" in reported.message


def test_all_type_conflicts_are_reported_in_one_pass(tmp_path):
    with pytest.raises(simkit.LoadError) as found:
        simkit.load(clashing(tmp_path, drive="x", joint="x", odometry="y", imu="y"))
    assert [d.code for d in found.value.diagnostics if d.severity == "error"] == ["SK-TOPIC-001"] * 2


def test_a_spawned_model_with_a_type_conflict_is_rejected_and_all_changes_are_undone(tmp_path):
    drive = '<plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">'
    arm = (
        '<sdf version="1.9"><model name="arm"><link name="a"/><link name="b"/><joint name="j" type="revolute"><parent>a'
        f"</parent><child>b</child><axis/></joint>{drive}<joint_name>j</joint_name><topic>cmd_vel</topic></plugin>"
        "</model></sdf>"
    )
    with simkit.load(clashing(tmp_path)) as sim:
        topics = sim.topics()
        with pytest.raises(simkit.LoadError, match="SK-TOPIC-001"):
            sim.spawn(arm)
        assert sim.topics() == topics
        assert "arm" not in sim.models
        sim.step()


def test_a_topic_that_a_plugin_opens_later_with_another_type_is_rejected(tmp_path):
    class Late(simkit.WorldPlugin):
        def load(self, parent, params):
            pass

        def after_step(self):
            self.advertise("imu", "std_msgs/msg/Float64")

    reported = "uses std_msgs/msg/Float64 on '/imu'.*Imu"
    with simkit.load(clashing(tmp_path), plugins=[Late()]) as sim, pytest.raises(simkit.SimkitError, match=reported):
        sim.step()


def test_two_plugins_share_a_topic_of_one_type_without_a_report(tmp_path):
    class Two(simkit.WorldPlugin):
        def load(self, parent, params):
            self.listen("cmd_vel", "geometry_msgs/msg/Twist", lambda m: None)

    with simkit.load(clashing(tmp_path), plugins=[Two()]) as sim:
        assert not [d for d in sim.diagnostics if d.code.startswith("SK-TOPIC")]

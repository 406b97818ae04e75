"""What goes wrong on topics: subscribers that raise, two types on one, floods; snapshots in the midst of a step."""

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
    """Says how often it was called, and what it has heard."""

    after_step_rate = 100.0

    def load(self, parent, params):
        self.calls, self.heard = 0, 0.0
        self.says = self.advertise("said", FLOAT)
        self.listen("heard", FLOAT, self.on_heard)

    def on_heard(self, message):
        self.heard += message.data

    def after_step(self):
        self.calls += 1
        self.says.publish(number(self.calls + self.heard))
        self.calls += 1


# ---------------------------------------------------------------------- subscribers that raise


def on_imu(message):
    raise KeyError("no such wheel")


def test_a_subscriber_that_raises_stops_the_run_with_its_topic_its_name_and_its_place():
    sim = simkit.load(WORLD)
    sim.subscribe("/imu", on_imu)
    told = r"'on_imu' \(.*test_topic_failures\.py:\d+\) of '/imu' raised at t=0"
    with pytest.raises(SubscriberError, match=told) as e:
        sim.step(10)
    assert e.value.exit_code == 4
    assert isinstance(e.value.__cause__, KeyError)


def test_a_subscriber_to_a_plugin_is_not_taken_for_the_plugin():
    sim = simkit.load(WORLD, plugins=[Talker()])
    sim.subscribe("/said", on_imu)
    with pytest.raises(SubscriberError, match="on_imu.*'/said'"):
        sim.run(0.1)


def test_a_subscriber_that_raises_is_dropped_where_that_is_chosen_and_the_run_goes_on():
    sim = simkit.load(WORLD)
    faulty, sound = sim.subscribe("/imu", on_imu, on_error="drop"), sim.subscribe("/imu")
    sim.run(0.1)
    assert len(faulty.messages) == 1
    assert len(sound.messages) == 21  # one after the first step as well
    told = [d for d in sim.diagnostics if d.code == "SK-TOPIC-003"]
    assert len(told) == 1
    assert "'/imu'" in told[0].message
    assert "no such wheel" in told[0].message


def test_another_choice_is_refused():
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


def test_what_came_after_an_input_that_raised_waits_for_the_next_step():
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


# ---------------------------------------------------------------------- floods


def test_of_too_many_messages_for_one_step_the_newest_are_kept_counted_and_reported_once():
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


def test_a_flood_on_one_topic_takes_nothing_from_another_nor_from_the_order():
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


def test_a_hundred_thousand_messages_a_second_are_all_heard_where_they_come_step_by_step():
    sim = simkit.load(WORLD, plugins=[talker := Talker()])
    for _ in range(100):
        for _ in range(100):
            sim.publish("/heard", number(1))
        sim.step()
    assert talker.heard == 10_000
    assert not sim.communication.bus.dropped


def test_messages_that_wait_are_in_a_snapshot_and_a_reset_forgets_them():
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


# ---------------------------------------------------------------------- who listens


def test_who_listens_how_and_whether_somebody_floods_changes_no_bit():
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


# ---------------------------------------------------------------------- snapshots in the midst of a step


@pytest.mark.parametrize("topic", ["/imu", "/height", "/said"])
def test_a_run_restored_to_a_snapshot_taken_in_a_callback_repeats(topic):
    sim = simkit.load(WORLD, plugins=[talker := Talker()])
    taken = []

    def snap(message):
        if sim.time >= 0.05 and not taken:
            taken.append(sim.snapshot())

    sim.subscribe(topic, snap)
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


def test_a_snapshot_of_a_step_under_way_cannot_be_restored_before_its_end():
    sim = simkit.load(WORLD)

    def back(message):
        sim.restore(sim.snapshot())

    sim.subscribe("/imu", back)
    with pytest.raises(SubscriberError, match="in a step that has not ended"):
        sim.step()


def test_a_snapshot_of_a_step_that_never_ended_says_so():
    sim = simkit.load(WORLD)
    sim.step(10)
    before, taken = sim.snapshot(), []

    def away(message):
        if not taken:
            taken.append(sim.snapshot())
            sim.restore(before)

    sim.subscribe("/imu", away)
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


def test_two_plugins_on_one_topic_with_different_types_are_an_error_with_both_places(tmp_path):
    with pytest.raises(simkit.LoadError) as found:
        simkit.load(clashing(tmp_path, drive="x", joint="x"))
    (error,) = [d for d in found.value.diagnostics if d.severity == "error"]
    assert error.code == "SK-TOPIC-001"
    assert error.line == 10
    assert "'/x'" in error.message
    assert "std_msgs/msg/Float64" in error.message
    assert "geometry_msgs/msg/Twist" in error.message
    assert "clash.sdf:7)" in error.message


def test_what_one_plugin_publishes_another_cannot_take_as_something_else(tmp_path):
    with pytest.raises(simkit.LoadError, match=r"SK-TOPIC-001.*takes .*Float64.*publishes nav_msgs/msg/Odometry"):
        simkit.load(clashing(tmp_path, odometry="x", joint="x"))


def test_a_plugin_and_a_sensor_with_different_types_are_an_error_and_with_one_type_a_warning(tmp_path):
    with pytest.raises(simkit.LoadError, match=r"SK-TOPIC-001.*sensor 'box::base::imu'|SK-TOPIC-001.*DiffDrive"):
        simkit.load(clashing(tmp_path, odometry="x", imu="x"))

    class Second(simkit.WorldPlugin):
        def load(self, parent, params):
            self.imu = self.advertise("imu", "sensor_msgs/msg/Imu")

    with simkit.load(clashing(tmp_path), plugins=[Second()]) as sim:
        (told,) = [d for d in sim.diagnostics if d.code.startswith("SK-TOPIC")]
    assert (told.code, told.severity) == ("SK-TOPIC-006", "warning")
    assert "clash.sdf:15" in told.message


def test_all_clashes_are_told_in_one_pass(tmp_path):
    with pytest.raises(simkit.LoadError) as found:
        simkit.load(clashing(tmp_path, drive="x", joint="x", odometry="y", imu="y"))
    assert [d.code for d in found.value.diagnostics if d.severity == "error"] == ["SK-TOPIC-001"] * 2


def test_a_spawned_model_that_clashes_is_refused_and_all_is_as_before(tmp_path):
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


def test_a_topic_that_a_plugin_opens_later_is_refused_where_it_has_another_type(tmp_path):
    class Late(simkit.WorldPlugin):
        def load(self, parent, params):
            pass

        def after_step(self):
            self.advertise("imu", "std_msgs/msg/Float64")

    told = "uses std_msgs/msg/Float64 on '/imu'.*Imu"
    with simkit.load(clashing(tmp_path), plugins=[Late()]) as sim, pytest.raises(simkit.SimkitError, match=told):
        sim.step()


def test_two_plugins_of_one_type_share_a_topic_without_a_word(tmp_path):
    class Two(simkit.WorldPlugin):
        def load(self, parent, params):
            self.listen("cmd_vel", "geometry_msgs/msg/Twist", lambda m: None)

    with simkit.load(clashing(tmp_path), plugins=[Two()]) as sim:
        assert not [d for d in sim.diagnostics if d.code.startswith("SK-TOPIC")]

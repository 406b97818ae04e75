"""`simkit run --teleop`: what keys send, when, to whom, and what the driver sees."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.bridges.teleop import Teleop, find_target, find_targets
from simkit.cli.run_parts.keyboard import RunKeys
from simkit.cli.terminal.teleop_display import DriverLine
from simkit.errors import InputError

WORLD = """
<sdf version="1.9"><world name="w"><physics type="ode"><max_step_size>0.002</max_step_size></physics>{}</world></sdf>
"""
SLED = """
<model name="{name}"><pose>{pose}</pose><link name="base">
  <collision name="c"><geometry><box><size>0.2 0.2 0.1</size></box></geometry></collision>
  {more}</link>
  <plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl"/>
</model>"""
LIDAR = """
<sensor name="eye" type="lidar"><pose>0.1 0 0 0 0 0</pose><update_rate>20</update_rate><lidar>
  <scan><horizontal><samples>360</samples><min_angle>-3.14159</min_angle><max_angle>3.14159</max_angle></horizontal></scan>
  <range><min>0.12</min><max>4</max></range></lidar></sensor>"""
WALL = """
<model name="wall"><static>true</static><pose>{pose}</pose><link name="l"><collision name="c"><geometry>
  <box><size>0.1 0.1 2</size></box></geometry></collision></link></model>"""
DRIVE = """
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
  <left_joint>{left}</left_joint><right_joint>{right}</right_joint>
  <wheel_separation>{width}</wheel_separation><wheel_radius>0.033</wheel_radius>{limits}
</plugin>"""


def sled(name: str = "sled", pose: str = "0 0 1 0 0 0", more: str = "") -> str:
    return SLED.format(name=name, pose=pose, more=more)


def rover(name: str, width: float = 0.16, limits: str = "", place: float = 0.0) -> str:
    """Two wheels and a base, named as TurtleBot3 names them."""
    sides = {"left": width / 2, "right": -width / 2}
    links = "".join(
        f'<link name="wheel_{side}_link"><pose>0 {y} 0 -1.5708 0 0</pose></link>'
        f'<joint name="wheel_{side}_joint" type="revolute"><parent>base</parent><child>wheel_{side}_link</child>'
        "<axis><xyz>0 0 1</xyz></axis></joint>"
        for side, y in sides.items()
    )
    drive = DRIVE.format(left="wheel_left_joint", right="wheel_right_joint", width=width, limits=limits)
    return f'<model name="{name}"><pose>{place} 0 0 0 0 0</pose><link name="base"/>{links}{drive}</model>'


def world(*content: str) -> str:
    return WORLD.format("".join(content))


class Hands:
    """Presses keys at ticks: what a keyboard would give."""

    is_lost = False

    def __init__(self, sim: simkit.Simulation, presses: dict[float, str]) -> None:
        self._sim, self._left = sim, dict(presses)

    def read(self) -> list[str]:
        due = [at for at in self._left if at <= self._sim.time + 1e-9]
        return [key for at in due for key in self._left.pop(at)]


def drive(
    sim: simkit.Simulation, presses: dict[float, str], duration: float, **options: Any
) -> tuple[Teleop, list[tuple[float, Any]]]:
    """Runs with keys pressed at their times, looking for keys every 10 ms; the commands that went out, with times."""
    teleop = Teleop(sim, find_target(sim), **options)
    keys = RunKeys(sim, Hands(sim, presses), teleop)
    sent: list[tuple[float, Any]] = []
    sim.subscribe(teleop.target.topic, lambda message: sent.append((sim.time, message)))
    for _ in range(round(duration / 0.01)):
        keys.poll()
        teleop.send_due()
        sim.control.pausing.advance(round(0.01 / sim.timestep))
    return teleop, sent


def speeds(sent: Iterable[tuple[float, Any]]) -> list[tuple[float, float, float]]:
    return [(m.linear.x, m.linear.y, m.angular.z) for _, m in sent]


# ---------------------------------------------------------------------- keys


def test_keys_add_steps_and_commands_go_out_ten_times_a_simulated_second() -> None:
    with simkit.load(world(rover("burger"))) as sim:
        teleop, sent = drive(sim, {0.234: "www", 0.55: "a", 0.75: "x\x1bd"}, 1.0)
        assert [round(time, 6) for time, _ in sent] == [0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]
        assert speeds(sent) == [(0.03, 0, 0)] * 3 + [(0.03, 0, 0.1)] * 2 + [(0.02, 0, 0)] * 2
        assert teleop.speeds == (0.02, 0.0, 0.0)


def test_arrows_and_capital_letters_do_the_same_as_the_letters() -> None:
    with simkit.load(world(rover("burger"))) as sim:
        one, two = Teleop(sim, find_target(sim)), Teleop(sim, find_target(sim))
        for key in ("w", "w", "W", "a", "A", "d", "x"):
            assert one.press(key)
        for key in ("up", "up", "up", "left", "left", "right", "down"):
            assert two.press(key)
        assert one.speeds == two.speeds == (0.02, 0.0, 0.1)
        assert not one.press("k")


def test_s_stops_at_once_and_between_two_commands() -> None:
    with simkit.load(world(sled())) as sim:
        _, sent = drive(sim, {0.0: "wwwww", 0.55: "s"}, 0.8)
        assert [round(time, 6) for time, _ in sent] == [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.55, 0.6, 0.7]
        assert speeds(sent)[6:] == [(0, 0, 0)] * 3
        assert sim.model("sled").pose.position[0] == pytest.approx(0.25 * 0.55, abs=0.002)


def test_no_robot_is_driven_beyond_its_bounds() -> None:
    bounds = "<max_linear_velocity>0.7</max_linear_velocity><min_linear_velocity>-0.1</min_linear_velocity>"
    bounds += "<max_angular_velocity>1</max_angular_velocity>"
    cases = {
        rover("burger"): ((-0.22, 0.22), (-2.84, 2.84)),
        rover("my_turtlebot3", width=0.287): ((-0.26, 0.26), (-1.82, 1.82)),
        rover("burger", limits=bounds): ((-0.1, 0.7), (-math.inf, 1)),
        rover("rover"): ((-math.inf, math.inf), (-math.inf, math.inf)),
    }
    for text, (linear, angular) in cases.items():
        with simkit.load(world(text)) as sim:
            target = find_target(sim)
            assert (target.linear, target.angular) == (linear, angular)
            teleop = Teleop(sim, target)
            for key in "w" * 200 + "a" * 100:
                teleop.press(key)
            expected = [min(most, free) for most, free in ((linear[1], 200 * target.linear_step), (angular[1], 10.0))]
            assert teleop.speeds == pytest.approx((expected[0], 0.0, expected[1]))
            for key in "x" * 500:
                teleop.press(key)
            assert teleop.speeds[0] == pytest.approx(max(linear[0], expected[0] - 500 * target.linear_step))


def test_a_turtlebot3_of_another_name_has_its_limits_because_of_its_file() -> None:
    with simkit.load("empty", spawn=["turtlebot3_burger:0,0,0:first:one", "turtlebot3_waffle:1,0,0:second:two"]) as sim:
        limits = {target.topic: target.linear for target in find_targets(sim)}
    assert limits == {"/one/cmd_vel": (-0.22, 0.22), "/two/cmd_vel": (-0.26, 0.26)}


def test_q_and_z_change_all_speeds_alike_so_that_a_curve_stays_the_same() -> None:
    with simkit.load(world(rover("burger"))) as sim:
        teleop = Teleop(sim, find_target(sim))
        for key in "w" * 10 + "aaaa":
            teleop.press(key)
        for key in "qqqqqqqqqqqqq":
            teleop.press(key)
        linear, _, angular = teleop.speeds
        assert linear == pytest.approx(0.22)  # the bound, at which the other stops growing too
        assert angular / linear == pytest.approx(4.0, rel=1e-4)
        for _ in range(8):
            teleop.press("-")
        assert teleop.speeds[0] == pytest.approx(0.22 / 1.1**8, rel=1e-4)
        teleop.press("s")
        teleop.press("w")
        assert teleop.speeds[0] == pytest.approx(0.022 / 1.1**8, abs=1e-6)  # a step is as much smaller


def test_only_a_holonomic_robot_is_driven_sideways() -> None:
    with simkit.load(world(rover("burger"))) as sim:
        teleop = Teleop(sim, find_target(sim))
        assert not teleop.press("j")
        assert DriverLine(sim, teleop).requested() == "requested 0.00 m/s, 0.00 rad/s"
    with simkit.load(world(sled())) as sim:
        teleop, _ = drive(sim, {0.0: "jjjjwwl"}, 1.0)
        assert sim.model("sled").pose.position == pytest.approx([0.1, 0.15, 1.0], abs=0.002)
        assert DriverLine(sim, teleop).text().startswith("0.10 m/s, 0.15 m/s left, 0.00 rad/s")


# ---------------------------------------------------------------------- time


def test_a_robot_without_a_driver_is_stopped_and_then_left_to_others() -> None:
    with simkit.load(world(sled())) as sim:
        teleop, sent = drive(sim, {0.0: "ww", 1.0: "a", 4.0: "w"}, 5.0, key_timeout=2.0)
        times = [round(time, 6) for time, _ in sent]
        assert times == [k / 10 for k in range(31)] + [k / 10 for k in range(40, 50)]
        assert speeds(sent)[29:31] == [(0.1, 0, 0.1), (0, 0, 0)]
        assert speeds(sent)[31:] == [(0.05, 0, 0)] * 10
        assert not teleop.is_expired
        sim.run(2.0)
        teleop.send_due()
        assert teleop.is_expired
        assert DriverLine(sim, teleop).requested().endswith("stopped after the key timeout")


def test_it_is_silent_until_a_key_comes() -> None:
    with simkit.load(world(sled())) as sim:
        teleop, sent = drive(sim, {}, 1.0)
        assert sent == []
        assert teleop.next_tick is None


@pytest.mark.parametrize("step", [0.001, 0.002, 0.003, 0.0042, 0.03, 0.07])
def test_the_rate_is_kept_whatever_the_step(step: float) -> None:
    text = world(sled()).replace("0.002", str(step))
    with simkit.load(text) as sim:
        teleop, sent = Teleop(sim, find_target(sim), key_timeout=math.inf), []
        sim.subscribe(teleop.target.topic, lambda _: sent.append(sim.tick))
        teleop.press("w")
        while sim.time < 3.0 - 1e-9:
            teleop.send_due()
            assert teleop.next_tick is not None
            sim.step(teleop.next_tick - sim.tick)
        assert sent == [math.ceil(k / 10 / step - 1e-6) for k in range(len(sent))]
        assert len(sent) == 30


def test_after_a_reset_it_goes_on_from_the_new_time() -> None:
    with simkit.load(world(sled())) as sim:
        teleop, sent = drive(sim, {0.0: "ww"}, 0.5)
        sim.reset()
        assert teleop.next_tick == 0
        for _ in range(3):
            teleop.send_due()
            sim.run(0.1)
        assert [round(time, 6) for time, _ in sent][5:] == [0, 0.1, 0.2]


def test_the_same_keys_at_the_same_ticks_give_the_same_bits() -> None:
    def once() -> bytes:
        with simkit.load(world(sled(more=LIDAR), WALL.format(pose="1 0 1 0 0 0"))) as sim:
            teleop, _ = drive(sim, {0.0: "wwww", 0.31: "aaa", 0.92: " ", 1.1: " q"}, 1.5)
            DriverLine(sim, teleop).text()
            return bytes(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())

    assert once() == once()


# ---------------------------------------------------------------------- pausing


def test_space_stops_and_pauses_and_again_goes_on_standing() -> None:
    with simkit.load(world(sled())) as sim:
        _, sent = drive(sim, {0.0: "ww", 0.5: " "}, 1.0)
        assert sim.paused
        assert sim.time == pytest.approx(0.5)
        assert speeds(sent)[-1] == (0, 0, 0)
        keys = RunKeys(sim, Hands(sim, {}))
        keys.press("n")
        assert not sim.paused
        sim.control.pausing.advance(100)
        assert sim.tick == 251
        keys.press(".")
        keys.press("n")
        sim.control.pausing.advance(100)
        assert sim.tick == 253
        keys.press(" ")
        sim.control.pausing.advance(100)
        assert sim.tick == 353
        assert sim.model("sled").pose.position[0] == pytest.approx(0.05, abs=1e-3)


def test_the_key_n_advances_one_step_and_pauses() -> None:
    with simkit.load(world()) as sim:
        RunKeys(sim, Hands(sim, {})).press("n")
        sim.control.pausing.advance(100)
        assert sim.tick == 1
        assert sim.paused


def test_keys_after_a_step_wait_for_its_end(capfd: pytest.CaptureFixture[str]) -> None:
    with simkit.load(world()) as sim:
        sim.paused = True
        keys = RunKeys(sim, Hands(sim, {0.0: "n.n ", 0.006: "x"}))
        ticks = []
        for _ in range(5):
            keys.poll()
            sim.control.pausing.advance(10)
            ticks.append(sim.tick)
        assert ticks == [1, 2, 3, 13, 23]
        assert capfd.readouterr().err.splitlines() == [f"t={step * sim.timestep:g} s" for step in (1, 2, 3)]
        sim.control.pausing.step(1)
        sim.reset()  # takes the step back, and nothing waits for it
        keys.press(" ")
        assert sim.paused


def test_a_terminal_that_is_gone_stops_the_robot(capfd: pytest.CaptureFixture[str]) -> None:
    with simkit.load(world(sled())) as sim:
        teleop = Teleop(sim, find_target(sim))
        hands = Hands(sim, {0.0: "wwww"})
        keys = RunKeys(sim, hands, teleop)
        keys.poll()
        teleop.send_due()
        sim.run(0.5)
        hands.is_lost = True
        keys.poll()
        keys.poll()
        assert teleop.next_tick is None
        sim.run(0.5)
        assert sim.model("sled").pose.position[0] == pytest.approx(0.1, abs=1e-3)
    assert capfd.readouterr().err.count("the terminal has closed") == 1


# ---------------------------------------------------------------------- whom


def test_the_topic_is_the_only_one_or_the_one_that_is_named() -> None:
    two = world(sled("a"), sled("b", "3 0 1 0 0 0"))
    with simkit.load(world(sled("a"))) as sim:
        assert find_target(sim).topic == "/model/a/cmd_vel"
    with simkit.load(two) as sim:
        with pytest.raises(InputError, match=r"SK-CLI-051 .*/model/a/cmd_vel, /model/b/cmd_vel") as raised:
            find_target(sim)
        assert "--teleop /model/a/cmd_vel" in str(raised.value)
        assert find_target(sim, "model/b/cmd_vel").model == "b"
        with pytest.raises(InputError, match=r"SK-CLI-051 .*'/model/c/cmd_vel' has no subscriber of velocities"):
            find_target(sim, "/model/c/cmd_vel")
    with simkit.load(world()) as sim, pytest.raises(InputError, match="SK-CLI-051 .*the world has no velocity topic"):
        find_target(sim)


def test_a_static_model_that_receives_velocities_is_a_program_and_no_robot() -> None:
    class Program(simkit.ModelPlugin):
        def load(self, parent: simkit.Model, params: simkit.Params) -> None:
            self.listen("/cmd_vel_teleop", "geometry_msgs/msg/Twist", print)

    program = '<model name="server"><static>true</static><link name="l"/></model>'
    with simkit.load(world(sled(), program), plugins=[("server", Program())]) as sim:
        assert [target.model for target in find_targets(sim)] == ["sled"]


def test_two_topics_of_one_drive_are_one_robot_with_the_limits_of_its_controller() -> None:
    with simkit.load("tiago") as sim:
        target = find_target(sim)
        assert target.topic.startswith("/mobile_base_controller/cmd_vel")
        assert (target.linear, target.angular) == ((-0.2, 1.0), (-2.09, 2.09))
        assert target.linear_step == 0.05
        assert target.model == "tiago"


def test_a_subscriber_of_twist_stamped_gets_a_stamp() -> None:
    class Stamped(simkit.WorldPlugin):
        def load(self, parent: Any, params: Any) -> None:
            self.got: list[Any] = []
            self.listen("/cmd_vel", ("geometry_msgs/msg/TwistStamped", "geometry_msgs/msg/Twist"), self.got.append)

    plugin = Stamped()
    with simkit.load(world(), plugins=[plugin]) as sim:
        sim.run(1.0)
        teleop, _ = drive(sim, {1.0: "w"}, 0.2)
        message = plugin.got[-1]
        assert message.twist.linear.x == pytest.approx(0.05)
        assert (message.header.stamp.sec, message.header.stamp.nanosec) == (1, 100_000_000)
        line = DriverLine(sim, teleop)  # whose it is nobody knows
        assert (line.text(), line.requested()) == ("driving /cmd_vel", "requested 0.05 m/s, 0.00 rad/s")


def test_a_removed_robot_is_reported_and_driven_again_after_its_return() -> None:
    with simkit.load(world()) as sim:
        robot = f'<sdf version="1.9">{sled()}</sdf>'
        sim.spawn(robot)
        teleop, _ = drive(sim, {0.0: "ww"}, 0.2)
        sim.remove("sled")
        sim.run(0.1)
        teleop.send_due()
        assert "no topic '/model/sled/cmd_vel'" in DriverLine(sim, teleop).requested()
        assert DriverLine(sim, teleop).text() == "driving /model/sled/cmd_vel"
        sim.spawn(robot)
        teleop.press("w")
        sim.run(0.1)
        teleop.send_due()
        sim.run(0.1)
        assert DriverLine(sim, teleop).text().startswith("0.15 m/s, 0.00 m/s left, 0.00 rad/s")


# ---------------------------------------------------------------------- what the driver sees


@pytest.mark.parametrize(
    ("wall", "words"),
    [
        ("1 0 1 0 0 0", "nearest 0.85 m, ahead"),  # 1 m, less half the wall's width, less where the lidar is
        ("0.1 1 1 0 0 0", "nearest 0.95 m, 84° left"),  # as seen from the robot, 0.1 m behind its lidar
        ("-1 0 1 0 0 0", "nearest 1.05 m, behind"),
        ("0.1 -0.5 1 0 0 0", "nearest 0.45 m, 77° right"),
        ("9 0 1 0 0 0", "nothing near"),
    ],
)
def test_the_nearest_obstacle_is_that_of_the_robots_lidar(wall: str, words: str) -> None:
    with simkit.load(world(sled(more=LIDAR), WALL.format(pose=wall))) as sim:
        line = DriverLine(sim, Teleop(sim, find_target(sim)))
        assert "near" not in line.text()  # before the first scan
        sim.run(0.2)
        assert words in line.text()


def test_an_obstacle_below_the_minimum_range_is_reported() -> None:
    lidar = LIDAR.replace('type="lidar"', 'type="gpu_lidar"').replace("<min>0.12", "<min>0.5")
    wall = WALL.format(pose="0.4 0 1 0 0 0").replace("collision", "visual")
    with simkit.load(world(sled(more=lidar), wall)) as sim:
        sim.run(0.2)
        assert "nearest below 0.50 m, ahead" in DriverLine(sim, Teleop(sim, find_target(sim))).text()


def test_speed_is_along_the_robots_heading_and_its_place_is_that_of_the_model() -> None:
    with simkit.load(world(sled(pose="3 -2 1 0 0 1.5708"))) as sim:
        teleop, _ = drive(sim, {0.0: "ww"}, 1.0)
        assert DriverLine(sim, teleop).text() == "0.10 m/s, 0.00 m/s left, 0.00 rad/s   x 3.00  y -1.90  90°"


def test_a_line_changes_no_bits_and_no_readings() -> None:
    def scan(looks: bool) -> Any:
        noisy = LIDAR.replace("</lidar>", '<noise type="gaussian"><stddev>0.01</stddev></noise></lidar>')
        with simkit.load(world(sled(more=noisy), WALL.format(pose="1 0 1 0 0 0")), seed=3) as sim:
            line = DriverLine(sim, Teleop(sim, find_target(sim)))
            for _ in range(10):
                sim.run(0.05)
                if looks:
                    line.text()
            return sim.sensor("sled::base::eye").latest.ranges

    assert np.array_equal(scan(True), scan(False))

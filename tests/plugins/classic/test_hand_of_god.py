"""Plugin that pulls a link to a frame of tf."""

from __future__ import annotations

import math
from typing import Any

import pytest
from plugin_worlds import world

import simkit


def ball(inside: str = "<link_name>body</link_name><frame_id>hog</frame_id>") -> str:
    return f"""<model name="ball"><pose>0 0 5 0 0 0</pose><link name="body"><inertial><mass>2</mass><inertia>
      <ixx>0.5</ixx><iyy>0.5</iyy><izz>0.5</izz></inertia></inertial></link>
      <plugin name="hand" filename="libgazebo_ros_hand_of_god.so">{inside}</plugin></model>"""


def tf_message(frame: str, x: float = 0.0, yaw: float = 0.0, parent: str = "world") -> Any:
    turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    transform = {"translation": {"x": x, "z": 5.0 if parent == "world" else 0.0}, "rotation": turn}
    one = {"header": {"frame_id": parent}, "child_frame_id": frame, "transform": transform}
    return simkit.msgs.make("tf2_msgs/msg/TFMessage", transforms=[one])


def test_the_weight_is_carried_and_the_link_is_pulled_without_overshoot() -> None:
    sim = simkit.load(world(ball()))
    sim.run(1.0)
    assert sim.model("ball").pose.position == pytest.approx((0, 0, 5), abs=1e-9)
    sim.publish("/tf", tf_message("hog_desired", 1.0))
    sim.step()  # it is heard
    start = sim.time
    for _ in range(10):
        sim.run(0.05)
        t, w = sim.time - start, math.sqrt(200 / 2)
        assert sim.model("ball").pose.position[0] == pytest.approx(1 - (1 + w * t) * math.exp(-w * t), abs=0.02)


def test_the_torque_uses_half_the_angle_and_the_pose_is_published() -> None:
    sim = simkit.load(world(ball("<linkName>body</linkName><frameId>hog</frameId><ka>50</ka>")))
    heard = sim.subscribe("/tf")
    sim.publish("/tf", tf_message("hand", 0.5, 0.2))
    sim.publish("/tf", tf_message("hog_desired", 0.0, 0.3, parent="hand"))
    link = sim.model("ball").link("body")
    sim.step()
    before = float(link.angular_velocity[2])
    sim.step()
    wanted = (50 * 0.5 / 2 - 2 * math.sqrt(50 * 0.5) * before) / 0.5  # torque over inertia
    assert (float(link.angular_velocity[2]) - before) / 0.001 == pytest.approx(wanted, rel=1e-3)
    sim.run(4.0)
    assert sim.model("ball").pose.rpy[2] == pytest.approx(0.5, abs=1e-3)
    last = heard.messages[-1].transforms[0]
    assert (last.header.frame_id, last.child_frame_id) == ("world", "hog_actual")
    assert last.transform.translation.x == pytest.approx(0.5, abs=1e-3)


def test_reset_and_restore_repeat_the_motion() -> None:
    sim = simkit.load(world(ball()))
    sim.publish("/tf", tf_message("hog_desired", 1.0))
    sim.run(0.1)
    snapshot = sim.snapshot()
    sim.run(0.1)
    place = sim.model("ball").pose.position.tolist()
    sim.restore(snapshot)
    sim.run(0.1)
    assert sim.model("ball").pose.position.tolist() == place
    sim.reset()
    sim.run(0.2)
    assert sim.model("ball").pose.position == pytest.approx((0, 0, 5), abs=1e-9)


def test_a_cycle_of_frames_and_a_nan_transform_do_not_pull() -> None:
    sim = simkit.load(world(ball()))
    sim.publish("/tf", tf_message("hog_desired", 1.0, parent="a"))
    sim.publish("/tf", tf_message("a", 1.0, parent="hog_desired"))
    sim.publish("/tf", tf_message("hog_desired", math.nan))
    sim.run(0.2)
    assert sim.model("ball").pose.position == pytest.approx((0, 0, 5), abs=1e-9)


def test_a_missing_link_is_an_error() -> None:
    with pytest.raises(simkit.InputError, match="did you mean 'body'"):
        simkit.load(world(ball("<link_name>bdy</link_name><kl>-1</kl>")))


@pytest.mark.parametrize("size", [1e-320, 1e-200, 1e200, 1e308, math.nan])
def test_an_invalid_rotation_is_ignored_and_reported(size: float) -> None:
    sim = simkit.load(world(ball()))
    message = tf_message("hog_desired", 1.0)
    turn = message.transforms[0].transform.rotation
    turn.z, turn.w = size, size
    sim.publish("/tf", message)
    sim.run(0.1)
    assert sim.model("ball").pose.position == pytest.approx((0, 0, 5), abs=1e-9)
    assert [d.code for d in sim.diagnostics] == ["SK-PLUGIN-041"]
    sim.publish("/tf", tf_message("hog_desired", 1.0))
    sim.run(2.0)
    assert sim.model("ball").pose.position[0] == pytest.approx(1.0, abs=0.01)


def test_a_position_out_of_range_is_ignored() -> None:
    sim = simkit.load(world(ball()))
    sim.publish("/tf", tf_message("hog_desired", 1e200))
    sim.run(0.1)
    assert sim.model("ball").pose.position == pytest.approx((0, 0, 5), abs=1e-9)

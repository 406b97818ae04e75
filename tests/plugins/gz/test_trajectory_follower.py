"""Link that is pushed from waypoint to waypoint."""

from __future__ import annotations

import math

import pytest
from plugin_worlds import world

import simkit

PAUSE = "/model/puck/trajectory_follower/pause"


def puck(inside: str, pose: str = "0 0 0 0 0 0", link: str = "body", more: str = "") -> str:
    """Body of 2 kg and 0.5 kg m² without gravity."""
    return f"""<model name="puck"><pose>{pose}</pose><link name="body"><gravity>0</gravity><inertial><mass>2</mass>
      <inertia><ixx>0.5</ixx><iyy>0.5</iyy><izz>0.5</izz></inertia></inertial></link>{more}
      <plugin filename="gz-sim-trajectory-follower-system" name="gz::sim::systems::TrajectoryFollower">
      <link_name>{link}</link_name>{inside}</plugin></model>"""


def ways(*points: str) -> str:
    return f"<waypoints>{''.join(f'<waypoint>{p}</waypoint>' for p in points)}</waypoints>"


def load(*args: str, **options: str) -> simkit.Simulation:
    return simkit.load(world(puck(*args, **options)))


def test_the_force_acts_towards_a_waypoint_ahead() -> None:
    sim = load("<force>4</force>" + ways("9 0"))
    sim.run(1.5)
    x, y, _ = sim.model("puck").pose.position.tolist()
    assert x == pytest.approx(0.5 * (4 / 2) * 1.5**2, rel=2e-3)  # F/m t²/2
    assert y == pytest.approx(0, abs=1e-12)


def test_the_torque_acts_towards_a_waypoint_at_the_side() -> None:
    for side in (1, -1):
        sim = load("<torque>0.2</torque>" + ways(f"0 {9 * side}"))
        sim.run(1.0)
        pose = sim.model("puck").pose
        assert pose.rpy[2] == pytest.approx(side * 0.5 * (0.2 / 0.5), rel=2e-3)  # T/I t²/2
        assert pose.position == pytest.approx((0, 0, 0), abs=1e-12)


def test_the_defaults_are_those_of_gazebo() -> None:
    ahead, aside = load(ways("99 0")), load(ways("0 99"))
    for sim in (ahead, aside):
        sim.run(0.1)
    assert ahead.model("puck").link("body").linear_velocity[0] == pytest.approx(60 / 2 * 0.1, rel=1e-6)
    assert aside.model("puck").link("body").angular_velocity[2] == pytest.approx(50 / 0.5 * 0.1, rel=1e-6)


def test_a_reached_waypoint_is_replaced_by_the_next_and_the_last_one_stays() -> None:
    sim = load("<force>4</force><torque>0</torque><range_tolerance>0.25</range_tolerance>" + ways("1 0", "3 0"))
    link = sim.model("puck").link("body")
    assert sim.run_until(lambda s: s.model("puck").pose.position[0] > 2.8, 5.0)
    speed = float(link.linear_velocity[0])
    # the force acts except in the step in which the first waypoint is reached: v² = 2 (F/m) s
    assert speed == pytest.approx(math.sqrt(2 * 2 * 2.75), rel=3e-3)
    sim.run(0.05)
    assert link.linear_velocity[0] == pytest.approx(speed, rel=1e-9)  # no force within the tolerance
    sim.run(1.0)  # beyond it, the waypoint is behind: only the torque acts, which is zero
    assert link.linear_velocity[0] == pytest.approx(speed, rel=1e-9)
    sim.model("puck").set_pose(simkit.Pose((-5, 0, 0)))
    sim.run(0.5)
    assert link.linear_velocity[0] == pytest.approx(speed + 2 * 0.5, rel=1e-3)


def test_a_loop_repeats_the_waypoints() -> None:
    sim = load("<loop>true</loop><force>0</force><torque>0</torque>" + ways("0 0", "1 0", "2 0"))
    plugin = next(p for p in sim.engine.structure.all_plugins() if type(p).__name__ == "TrajectoryFollower")
    seen = []
    for x in (0, 1, 2, 0, 1):
        sim.model("puck").set_pose(simkit.Pose((x, 0, 0)))
        sim.step(2)
        seen.append(plugin._remaining[0][0])
    assert seen == [1, 2, 0, 1, 2]


def test_lines_and_circles_begin_at_the_pose_of_the_link() -> None:
    line = load("<line><direction>0.5</direction><length>4</length></line>", pose="1 2 7 0 0 1")
    plugin = next(p for p in line.engine.structure.all_plugins() if type(p).__name__ == "TrajectoryFollower")
    (start, end) = plugin._points
    assert start == pytest.approx((1, 2))
    assert end == pytest.approx((1 + 4 * math.cos(1.5), 2 + 4 * math.sin(1.5)))
    circle = load("<circle><radius>2</radius></circle>", pose="1 2 0 0 0 1")
    plugin = next(p for p in circle.engine.structure.all_plugins() if type(p).__name__ == "TrajectoryFollower")
    assert len(plugin._points) == 8
    assert plugin._points[0] == pytest.approx((3, 2))  # in the world's axes
    assert plugin._points[2] == pytest.approx((1, 4))


def test_a_paused_follower_needs_no_callback_and_continues_later() -> None:
    sim = load("<force>4</force>" + ways("9 0"))
    sim.publish(PAUSE, {"data": True})
    sim.run(1.0)
    assert sim.model("puck").pose.position == pytest.approx((0, 0, 0), abs=1e-12)
    plugin = next(p for p in sim.engine.structure.all_plugins() if type(p).__name__ == "TrajectoryFollower")
    assert plugin.before_step_rate == pytest.approx(1e-9)
    sim.publish(PAUSE, {"data": False})
    sim.run(1.0)
    assert sim.model("puck").link("body").linear_velocity[0] == pytest.approx(2, rel=2e-3)


def test_zero_vel_on_bearing_reached_stops_the_rotation() -> None:
    stop = "<zero_vel_on_bearing_reached>true</zero_vel_on_bearing_reached>"
    aim = math.atan2(40, 99)
    for inside, turns in (("", True), (stop, False)):
        sim = load(f"<force>0.1</force><torque>2</torque>{inside}" + ways("99 40"))
        sim.run(math.sqrt(2 * aim / 4) + 0.1)  # at T/I = 4 rad/s²
        turning = abs(float(sim.model("puck").link("body").angular_velocity[2]))
        assert (turning > 0.5) == turns
        assert abs(sim.model("puck").pose.rpy[2] - aim) < 0.002 or turns


def test_a_pause_takes_effect_in_the_next_step() -> None:
    places = []
    for listened in (False, True):
        sim = load("<force>4</force>" + ways("9 0"))
        subscription = sim.subscribe("/world/lab/stats") if listened else None
        sim.publish(PAUSE, {"data": True})
        sim.run(0.0123 + 0.4)
        sim.publish(PAUSE, {"data": False})
        sim.run(0.5)
        places.append(sim.model("puck").pose.position.tolist())
        del subscription
    assert places[0] == places[1]
    assert places[0][0] == pytest.approx(0.5 * 2 * 0.5**2, rel=5e-3)


def test_nested_links_spawned_models_resets_and_restores_work() -> None:
    inner = puck("<force>4</force>" + ways("9 0"), link="inner::core").replace('<link name="body">', '<link name="x">')
    core = '<link name="core"><gravity>0</gravity><inertial><mass>2</mass></inertial></link>'
    nest = f'<model name="inner">{core}</model>'
    text = inner.replace("<plugin", f"{nest}<plugin")
    sim = simkit.load(world())
    sim.spawn(f"<sdf version='1.9'>{text}</sdf>")
    kept = sim.snapshot()
    sim.run(1.0)
    place = sim.model("puck").link("inner::core").pose.position.tolist()
    assert place[0] == pytest.approx(1.0, rel=3e-3)
    sim.restore(kept)
    sim.run(1.0)
    assert sim.model("puck").link("inner::core").pose.position.tolist() == place


def test_all_errors_are_reported_in_one_load() -> None:
    with pytest.raises(simkit.InputError) as caught:
        load("<range_tolerance>-1</range_tolerance><circle/><force>much</force>", link="bdy")
    text = str(caught.value)
    for part in ("did you mean 'body'", "range_tolerance", "<radius>", "much"):
        assert part in text
    codes = [d.code for d in load("").diagnostics] + [d.code for d in load(ways("1 0") + "<line/>").diagnostics]
    assert codes.count("SK-PLUGIN-130") == 2
    with pytest.raises(simkit.InputError, match="<waypoint>"):
        load("<waypoints/>")
    hung = '<joint name="j" type="fixed"><parent>world</parent><child>body</child></joint>'
    held = load("<zero_vel_on_bearing_reached>1</zero_vel_on_bearing_reached>" + ways("1 0"), more=hung)
    assert "SK-PLUGIN-131" in [d.code for d in held.diagnostics]

"""Actor that follows a model."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from skinned import skinned_dae

import simkit
from simkit.errors import LoadError

GROUND = "<include><uri>model://ground_plane</uri></include>"


def target(pose: str = "3 4 0.5 0 0 0", more: str = "<static>true</static>") -> str:
    return f"""<model name="red_box"><pose>{pose}</pose>{more}<link name="l"><inertial><mass>1</mass></inertial>
      <collision name="c"><geometry><box><size>0.5 0.5 1</size></box></geometry></collision></link></model>"""


def walker(parameters: str = "", inside: str = "", name: str = "anna", followed: str = "red_box") -> str:
    return f"""<actor name="{name}"><pose>0 0 0 0 0 0.3</pose>{inside}<plugin filename="gz-sim-follow-actor-system"
      name="gz::sim::systems::FollowActor"><target>{followed}</target><max_distance>8</max_distance>{parameters}</plugin>
      </actor>"""


def load(*parts: str, **options: object) -> simkit.Simulation:
    text = f'<sdf version="1.9"><world name="w">{GROUND}{"".join(parts)}</world></sdf>'
    return simkit.load(text, **options)  # type: ignore[arg-type]


def at(sim: simkit.Simulation, name: str = "anna") -> tuple[float, float]:
    x, y, _ = sim.model(name).pose.position.tolist()
    return x, y


def test_it_walks_straight_to_the_minimum_distance_at_its_speed() -> None:
    sim = load(target(), walker("<velocity>1</velocity><min_distance>1</min_distance>"))
    assert sim.model("anna").pose.rpy[2] == pytest.approx(0.3)
    for seconds in (0.5, 0.713, 1.0):
        sim.run(seconds)
        assert at(sim) == pytest.approx((0.6 * sim.time, 0.8 * sim.time), abs=1e-6 + 0.02)
    assert sim.model("anna").pose.rpy[2] == pytest.approx(math.atan2(4, 3))
    sim.run(4.0)
    assert at(sim) == pytest.approx((0.6 * 4, 0.8 * 4), abs=1e-9)  # 5 m less 1 m


def test_a_target_outside_the_distance_range_is_not_followed() -> None:
    sim = load(target("20 0 0.5 0 0 0"), walker())
    sim.run(1.0)
    assert at(sim) == (0, 0)
    sim = load(target("1.1 0 0.5 0 0 0"), walker())
    sim.run(1.0)
    assert at(sim) == (0, 0)


def test_it_follows_a_moving_target_and_stops_when_the_target_is_removed() -> None:
    sim = load(target("2 0 0.5 0 0 0", ""), walker("<velocity>2</velocity>"))
    box = sim.model("red_box")
    for k in range(40):
        box.set_pose(simkit.Pose((2 + 0.1 * k, 0.05 * k, 0.5)))
        sim.run(0.1)
    x, y, _ = (box.pose.position - sim.model("anna").pose.position).tolist()
    assert math.hypot(x, y) == pytest.approx(1.2, abs=0.12)  # minus the distance of a tenth of a second
    place = at(sim)
    sim.remove("red_box")
    sim.run(1.0)
    assert at(sim) == pytest.approx(place, abs=0.05)
    sim.spawn(f'<sdf version="1.9">{target("-2 0 0.5 0 0 0")}</sdf>')
    sim.run(1.0)
    assert at(sim)[0] < place[0] - 1.0


def test_a_figure_walks_without_sliding_and_stands_with_both_feet_on_the_ground() -> None:
    sim = load(target("7 0 0.5 0 0 0"), walker("<velocity>1.2</velocity>"))
    rests, before = [], None
    for _ in range(60):
        sim.run(0.04)
        ankles = {s: sim.model("anna").link(f"shin_{s}").pose.transform((0, 0, -0.48)) for s in ("left", "right")}
        side = min(ankles, key=lambda s: float(ankles[s][2]))
        if before is not None and before[0] == side:
            rests.append(abs(float(ankles[side][0]) - before[1]) / 0.04)
        before = side, float(ankles[side][0])
    assert np.median(rests) < 0.15
    sim.run(5.0)
    heights = [float(sim.model("anna").link(f"shin_{s}").pose.position[2]) for s in ("left", "right")]
    assert heights[0] == pytest.approx(heights[1], abs=1e-9)


def test_the_animation_of_a_skin_advances_with_the_distance(tmp_path: Path) -> None:
    (tmp_path / "w.dae").write_text(skinned_dae(hip_height=1.0))
    inside = """<skin><filename>w.dae</filename></skin><animation name="walk"><filename>w.dae</filename></animation>"""
    start = f'<sdf version="1.9"><world name="w">{GROUND}{target("7 0 0.5 0 0 0")}'
    text = start + walker("<velocity>1</velocity><animation_x_vel>0.5</animation_x_vel>", inside) + "</world></sdf>"
    (tmp_path / "w.sdf").write_text(text)
    with simkit.load(tmp_path / "w.sdf") as sim:
        sim.run(0.6)
        # 0.6 m are 0.3 s of a swing by a quarter turn in one second
        assert sim.model("anna").link("leg").pose.rpy[1] == pytest.approx(0.3 * math.pi / 2, abs=0.03)
        sim.run(7.0)
        swing = float(sim.model("anna").link("leg").pose.rpy[1])
        sim.run(0.5)
        assert sim.model("anna").link("leg").pose.rpy[1] == pytest.approx(
            swing, abs=1e-12
        )  # the animation stops when the actor stops


def test_sensors_do_not_change_the_walk_and_reset_and_restore_repeat_it() -> None:
    eye = """<model name="post"><static>true</static><pose>2 -3 1 0 0 1.57</pose><link name="link"><sensor name="eye"
      type="lidar"><update_rate>33</update_rate><topic>scan</topic><lidar><scan><horizontal><samples>5</samples>
      <min_angle>-0.5</min_angle><max_angle>0.5</max_angle></horizontal></scan><range><min>0.1</min><max>10</max></range>
      </lidar></sensor></link></model>"""
    plain, seen = load(target(), walker()), load(target(), walker(), eye)
    scans = seen.subscribe("/scan")
    for sim in (plain, seen):
        sim.run(3.0)
    assert at(plain) == at(seen)
    assert any(np.isfinite(r) for m in scans.messages for r in m.ranges)
    end, kept = at(plain), plain.snapshot()
    plain.run(1.0)
    later = at(plain)
    plain.restore(kept)
    plain.run(1.0)
    assert at(plain) == later
    plain.reset()
    assert at(plain) == (0, 0)
    plain.run(3.0)
    assert at(plain) == end


def test_its_script_is_ignored_and_other_actors_follow_theirs() -> None:
    way = """<script><trajectory id="0" type="walk"><waypoint><time>0</time><pose>-9 0 0 0 0 0</pose></waypoint>
      <waypoint><time>4</time><pose>9 0 0 0 0 0</pose></waypoint></trajectory></script>"""
    sim = load(target(), walker(inside=way), f'<actor name="bob">{way}</actor>', walker(name="carl", followed="bob"))
    assert at(sim) == (0, 0)
    assert at(sim, "bob")[0] == pytest.approx(-9)
    sim.run(2.0)
    assert at(sim, "bob")[0] == pytest.approx(0, abs=1e-6)


def test_errors_are_reported() -> None:
    missing = load(walker(followed="red_bx"), target())
    found = {d.code: d for d in missing.diagnostics}
    assert "red_box" in found["SK-PLUGIN-136"].hint
    assert "SK-PLUGIN-135" in [d.code for d in load(target(), walker("<min_distance>9</min_distance>")).diagnostics]
    plugin = walker()[walker().index("<plugin") : walker().index("</actor>")]
    with pytest.raises(simkit.InputError, match="SK-PLUGIN-134"):
        load(target(more=plugin))
    with pytest.raises(simkit.InputError, match="velocity"):
        load(target(), walker("<velocity>-1</velocity>"))


def test_an_empty_target_is_an_error() -> None:
    with pytest.raises(LoadError, match="found <target></target>; expected a name"):
        load(walker(followed=""))

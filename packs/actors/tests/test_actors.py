"""Actors in a running world: they follow the clock, are visible, and exchange no forces."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest
from skinned import skinned_dae

import simkit

WAYS = """<script><trajectory id="0" type="walk">
  <waypoint><time>0</time><pose>-2 0 0 0 0 0</pose></waypoint>
  <waypoint><time>2</time><pose>0 0 0 0 0 0</pose></waypoint>
  <waypoint><time>4</time><pose>2 0 0 0 0 0</pose></waypoint></trajectory></script>"""
ANNA = f'<actor name="anna">{WAYS}</actor>'
BOX = """<model name="box"><pose>0 0 0.5 0 0 0</pose><link name="link"><inertial><mass>1</mass></inertial>
  <collision name="c"><geometry><box><size>0.3 0.3 1</size></box></geometry></collision></link></model>"""


def lidar(kind: str) -> str:
    return f"""<model name="post"><static>true</static><pose>0 -3 1.2 0 0 1.5707963</pose><link name="link">
      <sensor name="eye" type="{kind}"><update_rate>10</update_rate><topic>scan</topic><lidar><scan><horizontal>
      <samples>3</samples><min_angle>-0.01</min_angle><max_angle>0.01</max_angle></horizontal></scan>
      <range><min>0.1</min><max>10</max></range></lidar></sensor></link></model>"""


def world(*content: str) -> str:
    ground = "<include><uri>model://ground_plane</uri></include>"
    body = "".join(content)
    return f'<sdf version="1.9" xmlns:simkit="simkit"><world name="w">{ground}{body}</world></sdf>'


def codes(sim: simkit.Simulation) -> list[str]:
    return [d.code for d in sim.diagnostics if d.code.startswith("SK-ACTOR")]


def test_an_actor_has_the_poses_of_its_script() -> None:
    with simkit.load(world(ANNA)) as sim:
        assert not codes(sim)
        np.testing.assert_allclose(sim.model("anna").pose.position, (-2, 0, 0), atol=1e-12)
        sim.run(2.0)
        np.testing.assert_allclose(sim.model("anna").pose.position, (0, 0, 0), atol=1e-9)
        sim.run(2.0)
        np.testing.assert_allclose(sim.model("anna").pose.position, (-2, 0, 0), atol=1e-9)  # and anew


MOVER = f"""<actor name="mover"><pose>0 1 0 0 0 0</pose><link name="box"><pose>0 0 1 0 0 0</pose><visual name="v">
  <geometry><box><size>0.4 0.6 0.8</size></box></geometry></visual><collision name="c"><geometry><box>
  <size>0.4 0.6 0.8</size></box></geometry></collision></link><link name="ball"><visual name="v">
  <pose>0 0 0.1 0 0 0</pose><geometry><sphere><radius>0.1</radius></sphere></geometry></visual></link>{WAYS}</actor>"""


def test_an_actor_of_links_is_drawn_as_written_and_moves_along_its_script() -> None:
    with simkit.load(world(MOVER, lidar("lidar"))) as sim:
        assert [d.code for d in sim.diagnostics if "mover" in d.message or d.code == "SK-SDF-012"] == ["SK-SDF-012"]
        actor = sim.engine.structure.models["mover"]
        visuals = {visual.name: visual for link in actor.links for visual in link.visuals}
        assert sorted(visuals) == ["ball_v", "box_v"]
        np.testing.assert_allclose(visuals["box_v"].pose_link.position, (0, 0, 1))
        np.testing.assert_allclose(visuals["ball_v"].pose_link.position, (0, 0, 0.1))
        scan = sim.subscribe("/scan")
        sim.run(0.1)
        assert np.isinf(scan.latest.ranges).all()  # the box is 2 m beside the beam
        sim.run(1.9)
        assert scan.latest.ranges[1] == pytest.approx(3 + 1 - 0.3, abs=1e-6)
        np.testing.assert_allclose(sim.model("mover").pose.position, (0, 1, 0), atol=1e-9)


def test_links_of_an_actor_with_a_skin_have_no_effect_and_are_reported() -> None:
    skin = "<skin><filename>nothing.dae</filename></skin><script>"
    with simkit.load(world(MOVER.replace("<script>", skin))) as sim:
        assert any(d.code == "SK-SDF-011" and "<link>" in d.message for d in sim.diagnostics)


def test_one_foot_of_a_walking_person_is_on_the_ground_and_does_not_slide() -> None:
    with simkit.load(world(ANNA)) as sim:
        scale = None
        lowest, rests = [], []
        before = None
        for _ in range(40):
            sim.run(0.05)
            ankles = {}
            for side in ("left", "right"):
                pose = sim.model("anna").link(f"shin_{side}").pose
                links = sim.engine.structure.models["anna"].links
                link = next(li for li in links if li.name == f"shin_{side}")
                shoe = next(v for v in link.visuals if v.name == "shoe")
                scale = -float(shoe.pose_link.position[2]) / 0.448
                ankles[side] = pose.transform((0, 0, -0.5 * scale))
            lowest.append(min(a[2] for a in ankles.values()))
            side = min(ankles, key=lambda s: ankles[s][2])
            if before is not None and before[0] == side:
                rests.append(abs(ankles[side][0] - before[1]) / 0.05)
            before = side, ankles[side][0]
        assert max(abs(z) for z in lowest) < 1e-6
        # its hips go at about 1 m/s: a foot on the ground at much less
        assert np.median(rests) < 0.1


def test_an_actor_pushes_nothing_and_nothing_pushes_it() -> None:
    with simkit.load(world(ANNA, BOX)) as sim:
        sim.run(0.1)
        start = sim.model("box").pose.position.copy()
        sim.run(3.9)
        np.testing.assert_allclose(sim.model("box").pose.position, start, atol=1e-6)


@pytest.mark.parametrize("kind", ["lidar", "gpu_lidar"])
def test_lidars_detect_a_walking_actor(kind: str) -> None:
    with simkit.load(world(ANNA, lidar(kind))) as sim:
        scan = sim.subscribe("/scan")
        sim.run(0.5)
        assert np.isinf(scan.latest.ranges).all()
        sim.run(1.5)  # she is before it
        assert 2.6 < min(scan.latest.ranges) < 2.95


def test_a_reading_shows_the_actor_of_its_own_time() -> None:
    """A due sensor moves the actor first, independently of the actor's own rate."""
    with simkit.load(world(ANNA, lidar("lidar").replace("<update_rate>10", "<update_rate>7"))) as sim:
        sim.subscribe("/scan", keep=1)
        script = sim.engine.structure.models["anna"].moved_by.script
        scan = sim.subscribe("/scan", lambda message: seen.append(float(sim.model("anna").pose.position[0])))
        seen: list[float] = []
        sim.run(1.0)
        assert scan is not None
        expected = [float(script.pose(np.ceil(k / 7 * 1000 - 1e-9) / 1000).position[0]) for k in range(1, 8)]
        np.testing.assert_allclose(seen[-len(expected) :], expected, atol=1e-9)


def test_reset_and_restore_bring_actors_back() -> None:
    with simkit.load(world(ANNA)) as sim:
        sim.run(1.0)
        snapshot, there = sim.snapshot(), sim.model("anna").pose
        sim.run(0.7)
        sim.restore(snapshot)
        assert sim.model("anna").pose == there
        sim.run(1.0)
        np.testing.assert_allclose(sim.model("anna").pose.position, (0, 0, 0), atol=1e-9)
        sim.reset()
        np.testing.assert_allclose(sim.model("anna").pose.position, (-2, 0, 0), atol=1e-9)


def test_an_actor_without_auto_start_is_started_by_its_service() -> None:
    waits = ANNA.replace("<script>", "<script><auto_start>false</auto_start>")
    with simkit.load(world(waits)) as sim:
        assert codes(sim) == ["SK-ACTOR-004"]
        sim.run(1.0)
        np.testing.assert_allclose(sim.model("anna").pose.position, (-2, 0, 0), atol=1e-9)
        assert sim.call("/anna/play", {"data": True}).success
        sim.run(2.0)
        np.testing.assert_allclose(sim.model("anna").pose.position, (0, 0, 0), atol=1e-9)
        sim.call("/anna/play", {"data": False})
        sim.run(1.0)
        np.testing.assert_allclose(sim.model("anna").pose.position, (0, 0, 0), atol=1e-9)


def test_a_person_has_the_colours_and_the_height_of_the_file() -> None:
    look = "<simkit:person><height>1.9</height><shirt>1 0 0</shirt></simkit:person>"
    with simkit.load(world(f'<actor name="bob">{look}</actor>')) as sim:
        (link,) = sim.engine.structure.models["bob"].links
        chest = next(v for v in link.visuals if v.name == "torso_chest")
        assert chest.material is not None
        assert chest.material.diffuse == (1, 0, 0, 1)
        assert chest.pose_link.position[2] == pytest.approx(1.305 * 1.9 / 1.75, abs=0.05)
        assert not [d for d in sim.diagnostics if d.severity != "note"]


def test_feet_touch_the_ground_for_a_trajectory_at_hip_height() -> None:
    with simkit.load(world('<actor name="bob"><pose>0 0 1 0 0 0</pose></actor>')) as sim:
        (link,) = sim.engine.structure.models["bob"].links
        shoe = next(v for v in link.visuals if v.name.endswith("left_shoe"))
        assert -1.0 < shoe.pose_link.position[2] < -0.9


def test_a_sitting_person_is_lower() -> None:
    sitting = '<script><trajectory id="0" type="sitting"/></script>'
    with simkit.load(world(f'<actor name="bob">{sitting}</actor><actor name="cai"/>')) as sim:
        heads = [
            next(
                v for v in sim.engine.structure.models[n].links[0].visuals if v.name == "torso_head"
            ).pose_link.position[2]
            for n in ("bob", "cai")
        ]
        assert heads[0] < heads[1] - 0.2


# ------------------------------------------------------------------ skins


def skinned(folder: Path, actor: str, **files: str) -> Path:
    for name, text in files.items():
        (folder / f"{name}.dae").write_text(text)
    path = folder / "w.sdf"
    path.write_text(world(actor))
    return path


SWING = '<skin><filename>leg.dae</filename></skin><animation name="swing"><filename>leg.dae</filename></animation>'


@pytest.mark.parametrize("unit", [1.0, 0.01])
def test_an_actor_has_its_skin_and_plays_its_animation(tmp_path: Path, unit: float) -> None:
    path = skinned(tmp_path, f'<actor name="a">{SWING}</actor>', leg=skinned_dae(unit=unit))
    with simkit.load(path) as sim:
        assert not codes(sim)
        assert list(sim.model("a").links) == ["link", "hip", "leg"]
        sim.run(0.5)
        leg = sim.model("a").link("leg").pose
        np.testing.assert_allclose(leg.position, (0, 0, 0.5), atol=1e-6)
        assert leg.rpy[1] == pytest.approx(np.pi / 4, abs=1e-3)
        sim.run(1.0)  # its animation of a second goes on and on
        assert sim.model("a").link("leg").pose.rpy[1] == pytest.approx(np.pi / 4, abs=1e-3)


def test_with_interpolate_x_the_animation_follows_the_distance(tmp_path: Path) -> None:
    follows = SWING.replace("</animation>", "<interpolate_x>true</interpolate_x></animation>")
    text = f'<actor name="a">{follows}{WAYS.replace("walk", "swing")}</actor>'
    with simkit.load(skinned(tmp_path, text, leg=skinned_dae(way=1.0))) as sim:
        sim.run(1.0)
        behind = float(sim.model("a").pose.position[0]) + 2.0
        hip, leg = sim.model("a").link("hip").pose, sim.model("a").link("leg").pose
        assert hip.position[0] == pytest.approx(behind - 2.0, abs=1e-6)  # its own x is left out
        assert leg.rpy[1] == pytest.approx(behind % 1.0 * np.pi / 2, abs=2e-3)


def test_a_trajectory_at_hip_height_ignores_the_roots_own_height(tmp_path: Path) -> None:
    high = WAYS.replace(" 0 0 0 0 0</pose>", " 0 1 0 0 0</pose>").replace("walk", "swing")
    with simkit.load(skinned(tmp_path, f'<actor name="a">{SWING}{high}</actor>', leg=skinned_dae())) as sim:
        sim.run(0.1)
        assert sim.model("a").link("hip").pose.position[2] == pytest.approx(1.0)


def test_an_animation_of_another_file_moves_the_skin(tmp_path: Path) -> None:
    text = SWING.replace("<animation", "<!-- --><animation").replace('swing"><filename>leg', 'swing"><filename>other')
    files = {"leg": skinned_dae(), "other": skinned_dae(name="pelvis")}
    with simkit.load(skinned(tmp_path, f'<actor name="a">{text}</actor>', **files)) as sim:
        assert not codes(sim)
        sim.run(0.5)
        assert sim.model("a").link("leg").pose.rpy[1] == pytest.approx(np.pi / 4, abs=1e-3)


@pytest.mark.parametrize("content", [None, "not XML", "<COLLADA/>", skinned_dae().replace("hip leg<", "hip arm<")])
def test_a_built_in_person_replaces_an_unreadable_skin(tmp_path: Path, content: str | None) -> None:
    files = {} if content is None else {"leg": content}
    with simkit.load(skinned(tmp_path, f'<actor name="a">{SWING}</actor>', **files)) as sim:
        assert "SK-ACTOR-001" in codes(sim)
        assert list(sim.model("a").links) == ["link"]


def test_the_skins_own_animation_replaces_an_unreadable_one(tmp_path: Path) -> None:
    text = SWING.replace('swing"><filename>leg.dae', 'swing"><filename>swing.bvh')
    with simkit.load(skinned(tmp_path, f'<actor name="a">{text}</actor>', leg=skinned_dae())) as sim:
        assert codes(sim) == ["SK-ACTOR-001"]
        sim.run(0.5)
        assert sim.model("a").link("leg").pose.rpy[1] == pytest.approx(np.pi / 4, abs=1e-3)


def test_a_bone_without_matrices_is_reported_once(tmp_path: Path) -> None:
    turns = skinned_dae().replace('#leg-out-array" count="11" stride="16"', '#leg-out-array" count="44" stride="4"')
    with simkit.load(skinned(tmp_path, f'<actor name="a">{SWING}</actor>', leg=turns)) as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-ACTOR-001"]
        assert "leg.dae animates 'leg/transform' without matrices" in found.message


# ------------------------------------------------------------------ bad input


def test_an_actor_with_the_name_of_a_model_is_ignored() -> None:
    model = '<model name="anna"><static>true</static><link name="l"/></model>'
    with simkit.load(world(model, ANNA)) as sim:
        assert codes(sim) == ["SK-ACTOR-002"]
        sim.run(0.1)


@pytest.mark.parametrize(("time", "is_allowed"), [("1e15", True), ("1e16", False), ("-1e308", False)])
def test_the_time_of_a_waypoint_has_a_limit(time: str, is_allowed: bool) -> None:
    ways = f'<trajectory id="0" type="walk"><waypoint><time>{time}</time></waypoint></trajectory>'
    with nullcontext() if is_allowed else pytest.raises(simkit.LoadError, match="SK-PARAM-002: found <time>"):
        simkit.load(world(f'<actor name="a"><script>{ways}</script></actor>')).close()


def test_a_misspelt_animation_is_reported() -> None:
    text = '<animation name="walking"><filename>x.dae</filename></animation>' + WAYS.replace("walk", "wlaking")
    with simkit.load(world(f'<actor name="a">{text}</actor>')) as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-ACTOR-003"]
        assert "'walking'" in found.hint

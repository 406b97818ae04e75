"""Models in MuJoCo's own format in a running simulation: alone, as a world, and among models of other formats."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from typer.testing import CliRunner

import simkit
from simkit.cli import app

ARM = """<mujoco model="arm">
  <compiler angle="degree"/>
  <option timestep="0.002"/>
  <default><default class="a"><joint damping="3"/></default></default>
  <asset><material name="paint" rgba="0 1 0 1"/></asset>
  <worldbody>
    <light name="top" pos="0 0 3"/>
    <body name="base" pos="0 0 1" childclass="a">
      <freejoint/>
      <geom name="hull" type="box" size=".1 .1 .1" material="paint"/>
      <body name="upper" pos="0 0 .2" euler="0 90 0">
        <joint name="elbow" axis="0 1 0" range="-90 90"/>
        <geom type="capsule" fromto="0 0 0 0 0 .3" size=".04"/>
        <light name="lamp" pos="0 0 .1"/>
        <site name="tip" pos="0 0 .3"/>
      </body>
    </body>
  </worldbody>
  <tendon><fixed name="t"><joint joint="elbow" coef="1"/></fixed></tendon>
  <actuator><motor name="drive" joint="elbow" gear="10"/></actuator>
  <sensor><gyro name="gyro" site="tip"/></sensor>
  <contact><exclude body1="base" body2="upper"/></contact>
  <keyframe><key name="home" qpos="0 0 1 1 0 0 0 .5"/></keyframe>
</mujoco>
"""
YARD = """<mujoco model="yard">
  <include file="arm.xml"/>
  <option integrator="{integrator}" cone="{cone}"/>
  <worldbody>
    <geom name="floor" size="0 0 0.05" type="plane"/>
    <body name="crate" pos="1 0 .5"><freejoint/><geom type="box" size=".1 .1 .1"/></body>
  </worldbody>
</mujoco>
"""
WORLD = """<sdf version="1.9"><world name="w">
  <physics type="ode"><max_step_size>0.001</max_step_size></physics>
  <include><uri>model://ground_plane</uri></include>
  {content}
</world></sdf>
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "arm.xml").write_text(ARM)
    (tmp_path / "yard.xml").write_text(YARD.format(integrator="Euler", cone="pyramidal"))
    return tmp_path


def world(folder: Path, content: str) -> simkit.Simulation:
    (folder / "world.sdf").write_text(WORLD.format(content=content))
    return simkit.load(folder / "world.sdf")


def names(sim: simkit.Simulation, kind: str, count: int) -> list[str]:
    what = getattr(mujoco.mjtObj, f"mjOBJ_{kind}")
    return [mujoco.mj_id2name(sim.mj_model, what, i) for i in range(count)]


def codes(sim: simkit.Simulation) -> dict[str, str]:
    return {d.code: d.severity for d in sim.diagnostics if d.code.startswith("SK-MJCF")}


# ---------------------------------------------------------------------- as a world


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4"])
@pytest.mark.parametrize("cone", ["pyramidal", "elliptic"])
def test_a_world_that_asks_for_it_runs_to_the_last_bit_as_in_the_engine_alone(
    folder: Path, integrator: str, cone: str
) -> None:
    path, ask = folder / "yard.xml", '<custom><text name="simkit:contact_law" data="mujoco"/></custom></mujoco>'
    path.write_text(YARD.format(integrator=integrator, cone=cone).replace("</mujoco>", ask))
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    with simkit.load(path) as sim:
        for k in range(100):
            data.ctrl[0] = sim.mj_data.ctrl[0] = math.sin(0.3 * k)
            mujoco.mj_step(model, data, 5)
            sim.step(5)
            assert sim.link("arm::upper").pose.position[2] > 0.0  # reads in between change nothing
        assert np.array_equal(sim.mj_data.qpos, data.qpos)
        assert names(sim, "BODY", 4) == ["world", "base", "upper", "crate"]


def test_a_world_keeps_what_only_the_engine_knows(folder: Path) -> None:
    with simkit.load(folder / "yard.xml") as sim:
        m = sim.mj_model
        assert (m.nu, m.ntendon, m.nsensor, m.nexclude, m.nkey) == (1, 1, 1, 1, 1)
        assert codes(sim) == {"SK-MJCF-010": "note"}
        sim.run(0.01)
        assert sim.mj_data.sensor("gyro").data.shape == (3,)


def test_a_model_of_a_world_can_be_removed_and_a_reset_brings_it_back(folder: Path) -> None:
    with simkit.load(folder / "yard.xml") as sim:
        sim.remove("arm")
        sim.run(0.5)
        assert (sim.mj_model.nu, sim.mj_model.ntendon, sim.mj_model.nbody) == (0, 0, 2)
        assert sim.link("crate::crate").pose.position[2] == pytest.approx(0.1, abs=2e-3)
        sim.reset()
        assert sim.joint("arm::elbow").position == 0.0


def test_what_stands_in_the_world_can_be_moved(folder: Path) -> None:
    with simkit.load(folder / "yard.xml") as sim:
        sim.model("worldbody").set_pose(simkit.Pose((0.0, 0.0, -1.0)))
        sim.run(1.5)
        assert sim.link("crate::crate").pose.position[2] == pytest.approx(-0.9, abs=2e-3)


# ---------------------------------------------------------------------- in a world of another format


def test_a_model_is_attached_under_its_name_with_all_that_it_has(folder: Path) -> None:
    with world(folder, "<include><uri>arm.xml</uri><name>left</name><pose>1 2 0 0 0 1.57</pose></include>") as sim:
        m = sim.mj_model
        assert names(sim, "ACTUATOR", m.nu) == ["left::drive"]
        assert names(sim, "TENDON", m.ntendon) == ["left::t"]
        assert names(sim, "SENSOR", m.nsensor) == ["left::gyro"]
        assert names(sim, "KEY", m.nkey) == ["left::home"]
        assert m.nexclude == 1
        assert sim.model("left").pose.position == pytest.approx((1, 2, 0))
        assert sim.link("left::upper").pose.position == pytest.approx((1, 2, 1.2))
        assert sim.joint("left::elbow").upper == pytest.approx(math.pi / 2)
        assert codes(sim) == {"SK-MJCF-009": "note", "SK-MJCF-010": "note", "SK-MJCF-011": "note"}


def test_every_body_has_the_mass_and_inertia_that_it_has_alone(folder: Path) -> None:
    alone = mujoco.MjModel.from_xml_path(str(folder / "arm.xml"))
    with world(folder, "<include><uri>arm.xml</uri><name>a</name></include>") as sim:
        for name in ("base", "upper"):
            here, there = sim.mj_model.body(f"a::{name}"), alone.body(name)
            for field in ("mass", "ipos", "iquat", "inertia", "pos", "quat"):
                assert np.array_equal(getattr(here, field), getattr(there, field)), field


def test_a_control_written_to_the_engine_drives_the_next_step(folder: Path) -> None:
    with world(folder, "<include><uri>arm.xml</uri><name>a</name></include>") as sim:
        sim.run(0.2)
        at_rest = sim.joint("a::elbow").velocity
        sim.mj_data.actuator("a::drive").ctrl = 1.0
        assert sim.joint("a::elbow").effort == pytest.approx(10.0)
        sim.step()
        assert sim.joint("a::elbow").velocity > at_rest + 0.01  # type: ignore[operator]


def test_the_world_s_settings_stand_and_what_matters_is_a_warning(folder: Path) -> None:
    text = ARM.replace('timestep="0.002"', 'timestep="0.002" gravity="0 0 -1" density="1000"')
    (folder / "arm.xml").write_text(text)
    with world(folder, "<include><uri>arm.xml</uri><name>a</name></include>") as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-MJCF-009" and d.severity == "warning"]
        assert "gravity 0 0 -1 (here 0 0 -9.8), density 1000 (here 0)" in found.message
        assert found.line == 3
        assert sim.timestep == 0.001


def test_two_of_one_file_do_not_know_each_other(folder: Path) -> None:
    two = "".join(
        f"<include><uri>arm.xml</uri><name>{n}</name><pose>{x} 0 0 0 0 0</pose></include>"
        for n, x in (("a", 0), ("b", 2))
    )
    with world(folder, two) as sim:
        sim.mj_data.actuator("b::drive").ctrl = 1.0
        sim.run(0.1)
        assert sim.joint("b::elbow").position > 0.05  # type: ignore[operator]
        assert abs(sim.joint("a::elbow").position) < 0.02  # type: ignore[arg-type]


def test_a_static_model_stands_still_and_can_be_set_elsewhere(folder: Path) -> None:
    with world(folder, "<include><uri>arm.xml</uri><name>a</name><static>true</static></include>") as sim:
        assert sim.mj_model.nv == 0
        sim.run(0.1)
        assert sim.link("a::base").pose.position == pytest.approx((0, 0, 1))
        sim.model("a").set_pose(simkit.Pose((5.0, 0.0, 0.0)))
        sim.step()
        assert sim.link("a::upper").pose.position == pytest.approx((5, 0, 1.2))
        assert codes(sim)["SK-MJCF-012"] == "note"


def test_spawn_remove_snapshot_and_reset(folder: Path) -> None:
    with world(folder, "<include><uri>arm.xml</uri><name>a</name></include>") as sim:
        sim.run(0.3)
        before = sim.snapshot()
        sim.run(0.2)
        wanted = sim.mj_data.qpos.copy()
        sim.restore(before)
        spawned = sim.spawn(folder / "arm.xml", name="b", pose=simkit.Pose((3.0, 0.0, 1.0)))
        assert spawned.link("base").pose.position == pytest.approx((3, 0, 2))
        sim.run(0.2)
        assert sim.link("b::base").pose.position[2] == pytest.approx(2 - 9.8 * 0.02, abs=2e-3)
        assert sim.joint("a::elbow").position == pytest.approx(wanted[-1], abs=1e-9)
        sim.remove("a")
        m = sim.mj_model
        left = [
            n
            for kind, count in (("BODY", m.nbody), ("MATERIAL", m.nmat), ("KEY", m.nkey))
            for n in names(sim, kind, count)
        ]
        assert not [n for n in left if n.startswith("a::")]
        sim.restore(before)
        sim.run(0.2)
        assert np.array_equal(sim.mj_data.qpos, wanted)
        sim.reset()
        assert list(sim.models) == ["ground_plane", "a"]
        assert sim.link("a::base").pose.position == pytest.approx((0, 0, 1))


@pytest.mark.parametrize(("slope", "box"), [(1.0, 0.2), (0.2, 1.0), (0.5, 0.5)])
def test_of_two_surfaces_the_smaller_friction_counts_across_the_formats(folder: Path, slope: float, box: float) -> None:
    """Down a slope of 30 degrees a box gains g (sin − μ cos) t; where μ is above tan 30° it stays."""
    (folder / "box.xml").write_text(
        f'<mujoco><worldbody><body name="b"><freejoint/><geom type="box" size=".2 .2 .1" friction="{box}"/></body>'
        "</worldbody></mujoco>"
    )
    x, z = 0.1 * math.sin(math.pi / 6), 20 + 0.1 * math.cos(math.pi / 6)
    content = f"""<model name="slope"><static>true</static><pose>0 0 20 0 0.523598775598 0</pose><link name="l">
      <collision name="c"><geometry><plane><normal>0 0 1</normal></plane></geometry>
      <surface><friction><ode><mu>{slope}</mu><mu2>{slope}</mu2></ode></friction></surface></collision></link></model>
      <include><uri>box.xml</uri><name>box</name><pose>{x} 0 {z} 0 0.523598775598 0</pose></include>"""
    with world(folder, content) as sim:
        sim.run(0.2)
        before = float(np.linalg.norm(sim.link("box::b").linear_velocity))
        sim.run(0.5)
        gained = float(np.linalg.norm(sim.link("box::b").linear_velocity)) - before
        mu = min(slope, box)
        wanted = 9.8 * (math.sin(math.pi / 6) - mu * math.cos(math.pi / 6)) * 0.5
        assert gained == pytest.approx(max(0.0, wanted), abs=0.03)  # 0.6 % of g sin t: contacts are soft


def test_a_geom_with_a_priority_of_its_own_has_the_last_word(folder: Path) -> None:
    (folder / "box.xml").write_text(
        '<mujoco><worldbody><body name="b"><freejoint/><geom type="box" size=".2 .2 .1" friction="1.5" priority="1"/>'
        "</body></worldbody></mujoco>"
    )
    with world(folder, "<include><uri>box.xml</uri><name>box</name><pose>0 0 0.1 0 0 0</pose></include>") as sim:
        sim.run(0.1)
        assert {float(c.friction[0]) for c in sim.mj_data.contact} == {1.5}
        assert codes(sim)["SK-MJCF-013"] == "note"


# ---------------------------------------------------------------------- joined to what other files bring


def test_a_fixed_joint_attaches_the_model_to_a_link(folder: Path) -> None:
    content = """<model name="cell"><static>false</static><link name="table"><pose>0 0 .5 0 0 0</pose>
        <inertial><mass>50</mass></inertial>
        <collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link>
      <include><uri>arm.xml</uri><name>arm</name><pose>0 0 .2 0 0 0</pose></include>
      <joint name="mount" type="fixed"><parent>table</parent><child>arm::base</child></joint></model>"""
    with world(folder, content) as sim:
        body = sim.mj_model.body("cell::arm::base")
        assert int(body.parentid[0]) == sim.mj_model.body("cell::table").id
        assert "mount" in sim.model("cell").joints
        assert sim.joint("cell::mount").dof == 0
        sim.run(0.5)
        assert sim.link("cell::arm::base").pose.position == pytest.approx((0, 0, 1.2), abs=1e-3)
        sim.remove("cell")
        assert sim.mj_model.nu == 0


def test_a_link_of_another_format_can_hang_on_the_model(folder: Path) -> None:
    inertia = "<mass>0.1</mass><inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia>"
    content = f"""<model name="cell">
      <include><uri>arm.xml</uri><name>arm</name></include>
      <link name="mast"><pose relative_to="arm::tip">0 0 .1 0 0 0</pose><inertial>{inertia}</inertial></link>
      <link name="vane"><pose relative_to="arm::tip">0 0 .2 0 0 0</pose><inertial>{inertia}</inertial></link>
      <joint name="fix" type="fixed"><parent>arm::upper</parent><child>mast</child></joint>
      <joint name="turn" type="revolute"><parent>arm::upper</parent><child>vane</child>
        <axis><xyz>0 0 1</xyz></axis></joint></model>"""
    with world(folder, content) as sim:
        upper, mast = sim.link("cell::arm::upper"), sim.link("cell::mast")
        wanted = upper.pose.inverse() @ mast.pose
        sim.run(1.0)
        now = upper.pose.inverse() @ mast.pose
        assert now.position == pytest.approx(wanted.position, abs=1e-4)
        assert sim.joint("cell::turn").dof == 1


def test_a_joint_of_the_world_holds_a_model_on_a_post(folder: Path) -> None:
    content = """<include><uri>arm.xml</uri><name>arm</name></include>
      <model name="post"><static>true</static><link name="l"/></model>
      <joint name="hold" type="fixed"><parent>post::l</parent><child>arm::base</child></joint>"""
    with world(folder, content) as sim:
        sim.run(1.0)
        assert sim.link("arm::base").pose.position == pytest.approx((0, 0, 1), abs=1e-4)


# ---------------------------------------------------------------------- who sees it


def test_cameras_and_rays_see_a_geom_by_what_it_does(folder: Path) -> None:
    (folder / "m.xml").write_text("""<mujoco><worldbody><body name="b"><freejoint/>
      <geom name="both" size=".1"/><geom name="seen" size=".1" contype="0" conaffinity="0"/>
      <geom name="felt" size=".1" group="3"/><geom name="weight" size=".1" contype="0" conaffinity="0" group="4"/>
      </body></worldbody></mujoco>""")
    with simkit.load(folder / "m.xml") as sim:
        link = sim.engine.names.link("m::b")
        name = {g: mujoco.mj_id2name(sim.mj_model, mujoco.mjtObj.mjOBJ_GEOM, g).split("::")[-1] for g in range(4)}
        assert {name[g] for g in link.visuals} == {"both", "seen"}
        assert {name[g] for g in link.geoms} == {name[g] for g in link.ray_geoms} == {"both", "felt"}


# ---------------------------------------------------------------------- out again


def resting(sim: simkit.Simulation) -> dict[str, Any]:
    return {
        name: link.pose.as_list()
        for m in sim.models.values()
        for name, link in ((li.scoped, li) for li in m.links.values())
    }


def test_what_is_converted_and_read_again_is_the_same(folder: Path, tmp_path: Path) -> None:
    content = """<include><uri>arm.xml</uri><name>arm</name><pose>1 0 0 0 0 0.5</pose></include>
      <model name="cart"><pose>0 3 1 0 0 0</pose><link name="body"><inertial><mass>2</mass></inertial></link>
      <link name="wheel"><pose>0 0 -.2 0 0 0</pose><inertial><mass>.5</mass></inertial></link>
      <joint name="axle" type="revolute"><parent>body</parent><child>wheel</child><axis><xyz>0 1 0</xyz></axis></joint>
      </model>"""
    with world(folder, content) as sim:
        wanted = resting(sim)
        masses = {n: sim.link(n).mass for n in wanted}
    done = CliRunner().invoke(app, ["convert", str(folder / "world.sdf"), "-o", str(tmp_path / "out.xml")])
    assert done.exit_code == 0, done.output
    with simkit.load(tmp_path / "out.xml") as again:
        for name, pose in resting(again).items():
            if name in wanted:
                assert pose == pytest.approx(wanted[name], abs=1e-6), name
                assert again.link(name).mass == pytest.approx(masses[name], rel=1e-6)
        assert {"arm::base", "arm::upper", "cart::body", "cart::wheel"} <= set(resting(again))
        assert again.joint("cart::axle").dof == 1


def test_meshes_of_an_attached_file_go_into_the_converted_folder(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    tetra = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "parts" / "tetra.obj").write_text(tetra)
    (tmp_path / "arm.xml").write_text("""<mujoco model="m"><compiler meshdir="parts"/>
      <asset><mesh file="tetra.obj"/></asset>
      <worldbody><body name="b" pos="0 0 1"><freejoint/><geom type="mesh" mesh="tetra"/></body></worldbody></mujoco>""")
    (tmp_path / "world.sdf").write_text(WORLD.format(content="<include><uri>arm.xml</uri><name>a</name></include>"))
    out = tmp_path / "elsewhere" / "out.xml"
    out.parent.mkdir()
    done = CliRunner().invoke(app, ["convert", str(tmp_path / "world.sdf"), "-o", str(out)])
    assert done.exit_code == 0, done.output
    assert mujoco.MjModel.from_xml_path(str(out)).body("a::b").mass[0] == pytest.approx(1000 / 6)

"""Overrides change models in MuJoCo's own format like all others, as a world and as a model in another world."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit
from simkit.errors import LoadError

MJCF = """
<mujoco><worldbody><light name="lamp" pos="0 0 3" dir="0 0 -1"/><geom name="floor" type="plane" size="5 5 .1"/>
  <body name="arm" pos="0 0 1"><joint name="hinge" axis="0 1 0" damping="0.1" range="-90 90" limited="true"/>
    <geom name="rod" type="capsule" fromto="0 0 0 0.5 0 0" size="0.02" mass="1"/>
    <body name="tip" pos="0.5 0 0"><joint name="wrist" axis="0 1 0"/>
      <geom name="box" type="box" size=".1 .1 .1" mass="0.5"/>
  </body></body></worldbody></mujoco>
"""


@pytest.fixture(params=["world", "model"])
def loaded(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[str, str]:
    """Return a source, and the path of its model."""
    if request.param == "world":
        return MJCF, "arm"
    (tmp_path / "arm.xml").write_text(MJCF)
    include = f"<include><uri>{tmp_path}/arm.xml</uri><name>robot</name><pose>1 2 0 0 0 0</pose></include>"
    world = tmp_path / "w.sdf"
    world.write_text(f'<sdf version="1.9"><world name="w">{include}</world></sdf>')
    return str(world), "robot"


def test_masses_joints_sizes_and_poses_are_set(loaded: tuple[str, str]) -> None:
    source, name = loaded
    overrides = [
        f"{name}::tip.mass=2", f"{name}::hinge.damping=0.7", f"{name}::hinge.limit.upper=0.5", "**::rod.radius=0.05",
        "**::box.mu=0.2", f"{name}::arm.pose.x=3",
    ]  # fmt: skip
    with simkit.load(source) as base, simkit.load(source, overrides=overrides) as sim:
        model, arm, tip = sim.mj_model, f"{name}::arm", f"{name}::tip"
        start = base.model(name).pose
        assert (start.inverse() @ sim.link(arm).pose).position[0] == pytest.approx(3.0)
        moved = base.link(arm).pose.inverse() @ base.link(tip).pose
        assert (sim.link(arm).pose.inverse() @ sim.link(tip).pose).position == pytest.approx(moved.position)
        body = sim.engine.names.link(tip).body
        assert model.body_mass[body] == 2.0
        assert model.body_inertia[body] == pytest.approx(4.0 * base.mj_model.body_inertia[body])
        assert model.dof_damping.tolist() == [0.7, 0.0]
        assert sim.joint(f"{name}::hinge").upper == pytest.approx(0.5)
        assert sorted(model.geom_size[:, 0]) == pytest.approx([0.05, 0.1, 5.0])
        assert sorted(model.geom_friction[:, 0]) == [0.2, 1.0, 1.0]


def test_the_light_of_a_world_is_set() -> None:
    with simkit.load(MJCF, overrides=["lamp.diffuse=0.1 0.2 0.3"]) as sim:
        assert sim.mj_model.light_diffuse[0] == pytest.approx([0.1, 0.2, 0.3])


def test_a_value_that_the_format_lacks_is_an_error() -> None:
    with pytest.raises(LoadError, match=r"SK-CLI-014: effort|velocity of joint arm::hinge cannot be set"):
        simkit.load(MJCF, overrides=["arm::hinge.axis.limit.velocity=2"]).close()

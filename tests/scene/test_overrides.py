"""`--set PATH=VALUE`: the value is applied, and an error about an unknown path names the closest one."""

from __future__ import annotations

import numpy as np
import pytest

from simkit.build import load
from simkit.errors import InputError

WORLD = """
<sdf version="1.9"><world name="w">
  <physics name="p" type="ignored"><max_step_size>0.001</max_step_size></physics>
  <light name="sun" type="directional"><direction>0 0 -1</direction></light>
  <model name="arm"><link name="base"><inertial><mass>2</mass></inertial></link>
    <link name="tip"><pose>1 0 0 0 0 0</pose>
      <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
      <sensor name="imu" type="imu"><update_rate>50</update_rate><topic>imu</topic>
        <imu><angular_velocity><x><noise type="gaussian"><stddev>0.1</stddev></noise></x></angular_velocity></imu>
      </sensor>
    </link>
    <joint name="hinge" type="revolute"><parent>base</parent><child>tip</child><axis><xyz>0 1 0</xyz></axis></joint>
    <plugin name="gz::sim::systems::JointStatePublisher" filename="gz-sim-joint-state-publisher-system"/>
  </model>
</world></sdf>
"""


def test_the_physics_step_can_be_set() -> None:
    with load(WORLD, overrides=["physics.max_step_size=0.004"]) as sim:
        assert sim.timestep == 0.004
        assert sim.mj_model.opt.timestep == 0.004


def test_gravity_is_set() -> None:
    with load(WORLD, overrides=["world.gravity=0 0 -1.62"]) as sim:
        assert sim.mj_model.opt.gravity.tolist() == [0.0, 0.0, -1.62]


def test_the_rate_and_topic_of_a_sensor_are_set() -> None:
    with load(WORLD, overrides=["arm::tip::imu.update_rate=20", "arm::tip::imu.topic=imu/data"]) as sim:
        assert sim.sensor("arm::tip::imu").update_rate == 20.0
        messages = sim.subscribe("/imu/data")
        sim.run(1.0)
        assert len(messages.messages) == 21


def test_a_value_deep_in_a_sensor_is_set() -> None:
    with load(WORLD, overrides=["arm::tip::imu.imu.angular_velocity.x.noise.stddev=0"]) as sim:
        sensor = sim.sensor("arm::tip::imu")
        sim.run(0.5)
        assert sensor.latest.angular_velocity.x == sensor.truth.angular_velocity.x


def test_values_of_links_joints_and_collisions_are_set() -> None:
    overrides = [
        "arm::tip.inertial.mass=3",
        "arm::hinge.axis.limit.upper=0.5",
        "arm::hinge.axis.dynamics.damping=0.25",
        "arm::tip::c.surface.friction.ode.mu=0.3",
    ]
    with load(WORLD, overrides=overrides) as sim:
        assert sim.link("arm::tip").mass == pytest.approx(3.0)
        assert sim.joint("arm::hinge").upper == 0.5
        assert sim.mj_model.dof_damping[sim.joint("arm::hinge").mj_dofs[0]] == 0.25


def test_a_later_override_replaces_an_earlier_one() -> None:
    with load(WORLD, overrides=["physics.max_step_size=0.004", "physics.max_step_size=0.002"]) as sim:
        assert sim.timestep == 0.002


@pytest.mark.parametrize(
    ("override", "reason"),
    [
        ("physics.max_step_sise=0.004", "did you mean 'max_step_size'?"),
        ("physics.max_step_size=0", "expected a positive number"),
        ("physics.max_step_size=nan", "expected a positive number"),
        ("world.gravity=0 0", "expected 3 numbers"),
        ("arm::tip::imv.update_rate=3", "did you mean 'arm::tip::imu'?"),
        ("arm::tip::imu.update_rate=often", "found 'often'"),
        ("arm::hinge.axis.limit.uper=1", "did you mean 'axis.limit.upper'?"),
        ("arm::hinge.axis2.limit.upper=1", "has 1 axis"),
        ("arm::tip::imu.imu=3", "holds elements; name one of them: angular_velocity"),
        ("arm.static=maybe", "true, false, 1 or 0"),
        ("nonsense", "write PATH=VALUE"),
        ("=3", "write PATH=VALUE"),
    ],
)
def test_an_invalid_override_is_an_error(override: str, reason: str) -> None:
    with pytest.raises(InputError) as error:
        load(WORLD, overrides=[override]).close()
    assert reason in str(error.value)
    assert error.value.exit_code == 2


def test_a_pattern_changes_only_entities_that_have_the_element() -> None:
    with load(WORLD, overrides=["**.mu=0.3", "arm::**.update_rate=20"]) as sim:
        assert sim.link("arm::tip").scene.collisions[0].surface.mu == 0.3
        assert sim.sensor("arm::tip::imu").update_rate == 20.0


def test_all_wrong_overrides_are_reported_together() -> None:
    with pytest.raises(InputError) as error:
        load(WORLD, overrides=["arm.statik=1", "arm::tip.mas=2", "arm.static=1", "amr.pose.x=1", "nonsense"]).close()
    lines = str(error.value).splitlines()
    assert len(lines) == 4
    assert "did you mean 'mass'?" in "".join(lines)


def test_an_override_of_an_unknown_sensor_element_is_an_error() -> None:
    with pytest.raises(InputError, match="visualise_it"):
        load(WORLD, overrides=["arm::tip::imu.visualise_it=1"]).close()


@pytest.mark.parametrize("text", [WORLD, '<sdf version="1.9"><model name="m"><link name="l"/></model></sdf>'])
def test_rendering_settings_can_be_set_for_worlds_and_bare_models(text: str) -> None:
    overrides = ["scene.quality=gazebo", "scene.shadows=false", "scene.ambient=0.1 0.2 0.3", "scene.sky=1"]
    with load(text, overrides=overrides) as sim:
        surroundings = sim.world.surroundings
        assert (sim.world.quality, surroundings.shadows, surroundings.sky) == ("gazebo", False, True)
        assert surroundings.ambient == (0.1, 0.2, 0.3, 1.0)
        assert sim.mj_model.vis.headlight.ambient.tolist() == pytest.approx([0.1, 0.2, 0.3])


@pytest.mark.parametrize("text", ["scene.quality=fine", "scene.qualty=fast", "scene.ambient=2 0 0", "scene=1"])
def test_an_invalid_rendering_setting_is_an_error(text: str) -> None:
    with pytest.raises(InputError, match="SK-CLI-014"):
        load(WORLD, overrides=[text])


def test_poses_and_sizes_and_lights_are_set() -> None:
    overrides = ["arm.pose.x=2", "arm::tip.pose=1 0 0.5 0 0 0", "arm::tip::c.radius=0.2", "sun.intensity=0.5"]
    with load(WORLD, overrides=overrides) as sim:
        assert sim.model("arm").pose.position.tolist() == [2.0, 0.0, 0.0]
        assert sim.link("arm::tip").pose.position.tolist() == [3.0, 0.0, 0.5]
        assert sim.mj_model.geom_size.max() == 0.2
        assert sim.world.lights[0].intensity == 0.5


def test_python_accepts_values_by_path() -> None:
    with load(WORLD, overrides={"world.gravity": (0, 0, -2.5), "arm.static": True, "arm.pose.x": np.float64(2)}) as sim:
        assert sim.gravity.tolist() == [0.0, 0.0, -2.5]
        assert sim.model("arm").static
        assert sim.model("arm").pose.position[0] == 2.0
        assert sim.run_spec is not None
        assert sim.run_spec.overrides[0] == "world.gravity=0 0 -2.5"


def test_a_mass_scales_the_inertia_unless_the_inertia_is_given_too() -> None:
    with load(WORLD, overrides=["arm::tip.mass=3"]) as sim:
        assert sim.link("arm::tip").scene.inertial.inertia == (3.0, 3.0, 3.0, 0.0, 0.0, 0.0)
    with load(WORLD, overrides=["arm::tip.mass=3", "arm::tip.inertial.inertia=2 2 2 0 0 0"]) as sim:
        assert sim.link("arm::tip").scene.inertial.inertia == (2.0, 2.0, 2.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("overrides", "friction"),
    [
        (["arm::tip::c.mu=0.3"], (0.3, 0.3)),
        (["arm::tip::c.mu=0.3", "arm::tip::c.mu2=0.6"], (0.3, 0.6)),
        (["arm::tip::c.surface.friction.ode.mu2=0.6", "arm::tip::c.mu=0.3"], (0.3, 0.6)),
    ],
)
def test_mu_sets_mu2_unless_an_override_sets_mu2(overrides: list[str], friction: tuple[float, float]) -> None:
    with load(WORLD, overrides=overrides) as sim:
        surface = sim.link("arm::tip").scene.collisions[0].surface
        assert (surface.mu, surface.mu2) == friction


BOXES = """
<sdf version="1.9"><world name="w"><model name="box"><pose>0 0 1 0 0 0</pose><link name="l">
  <collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision></link></model></world></sdf>
"""


def test_a_count_makes_copies_in_a_grid_which_patterns_select() -> None:
    with load(BOXES, overrides=["box.count=5", "box_*::l.mass=2", "**::c.mu=0.5", "box_4.pose.z=3"]) as sim:
        assert list(sim.models) == [f"box_{i}" for i in range(5)]
        places = np.array([model.pose.position for model in sim.models.values()])
        step = places[1, 0]
        assert step > 0.2
        assert places[:, 0] == pytest.approx([0, step, 2 * step, 0, step])
        assert places[:, 1] == pytest.approx([0, 0, 0, step, step])
        assert places[:, 2].tolist() == [1.0, 1.0, 1.0, 1.0, 3.0]
        assert [sim.link(f"box_{i}::l").mass for i in range(5)] == [2.0] * 5
        assert {link.collisions[0].surface.mu for m in sim.world.models for link in m.links} == {0.5}


@pytest.mark.parametrize("written", ["ray", "lidar"])
@pytest.mark.parametrize("named", ["ray", "lidar", "gpu_ray"])
def test_an_element_is_found_in_any_of_its_spellings(written: str, named: str) -> None:
    sensor = f'<sensor name="s" type="{written}"><{written}><range><max>5</max></range></{written}></sensor>'
    text = f'<sdf version="1.9"><model name="m"><static>1</static><link name="l">{sensor}</link></model></sdf>'
    with load(text, overrides=[f"m::l::s.{named}.range.max=7"]) as sim:
        assert sim.sensor("m::l::s").options.range_max == 7.0


XACRO = """
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="size" default="0.5"/>
  <link name="base"><inertial><mass value="$(arg size)"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
  </inertial></link></robot>
"""


def test_an_override_sets_an_argument_of_a_xacro_file() -> None:
    with load(XACRO, overrides=["xacro.size=2"]) as sim:
        assert sim.link("r::base").mass == 2.0
    with pytest.raises(InputError, match="no xacro argument 'sise'; did you mean 'size'"):
        load(XACRO, overrides=["xacro.sise=2"]).close()

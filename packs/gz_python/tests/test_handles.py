"""What gz-sim's handles tell of a world: the cases of its own Python tests, in worlds of our own."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from datetime import timedelta
from typing import Any

import pytest

from simkit_gz_python import sdformat
from simkit_gz_python.math import Angle, Color, Matrix3d, Pose3d, SphericalCoordinates, Vector3d
from simkit_gz_python.sim import (
    K_NULL_ENTITY,
    Actor,
    EntityComponentManager,
    Joint,
    Light,
    Link,
    Model,
    Sensor,
    World,
    world_entity,
    world_pose,
)
from simkit_gz_python.sim.fixture import TestFixture

ROBOT = """
<sdf version="1.9"><world name="yard">
  <gravity>0 0 -10</gravity><magnetic_field>1 2 3</magnetic_field>
  <atmosphere type="adiabatic"><temperature>300</temperature><pressure>90000</pressure>
    <temperature_gradient>-0.005</temperature_gradient></atmosphere>
  <spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>10</latitude_deg>
    <longitude_deg>15</longitude_deg><elevation>20</elevation><heading_deg>25</heading_deg></spherical_coordinates>
  <model name="arm">
    <self_collide>true</self_collide>
    <pose>1 0 2 0 0 1.5707963267948966</pose>
    <link name="base">
      <inertial><mass>2</mass><pose>0.1 0 0 0 0 0</pose>
        <inertia><ixx>1</ixx><iyy>2</iyy><izz>2.5</izz></inertia></inertial>
      <enable_wind>true</enable_wind>
      <visual name="shell"><geometry><box><size>1 1 1</size></box></geometry></visual>
      <collision name="hull"><pose>0 0 0.5 0 0 0</pose><geometry><box><size>1 1 1</size></box></geometry></collision>
      <sensor name="feel" type="imu"><pose>0 0 0.2 0 0 0</pose><update_rate>100</update_rate></sensor>
    </link>
    <link name="hand"><pose>0 1 0 0 0 0</pose></link>
    <joint name="elbow" type="revolute">
      <parent>base</parent><child>hand</child><pose>0 -0.5 0 0 0 0</pose>
      <axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>2</upper><effort>50</effort></limit></axis>
      <sensor name="strain" type="force_torque"><pose>0 0.1 0 0 0 0</pose><update_rate>10</update_rate></sensor>
    </joint>
    <model name="tool"><pose>0 2 0 0 0 0</pose><link name="tip"/></model>
  </model>
  <model name="rock"><static>true</static><link name="stone"/></model>
  <actor name="walker"><pose>1 1 0 0 0 0</pose></actor>
  <light name="lamp" type="point"><pose>0 2 2 0 0 0</pose><diffuse>1 0 0 1</diffuse><specular>0.2 0 0 1</specular>
    <intensity>2</intensity><cast_shadows>true</cast_shadows>
    <attenuation><range>20</range><constant>0.8</constant><linear>0.2</linear><quadratic>0.01</quadratic></attenuation>
  </light>
  <light name="torch" type="spot"><direction>0 0 -1</direction>
    <spot><inner_angle>0.1</inner_angle><outer_angle>0.5</outer_angle><falloff>0.8</falloff></spot></light>
</world></sdf>
"""


@pytest.fixture
def fixture() -> Iterator[TestFixture]:
    made = TestFixture(ROBOT)
    yield made
    made.server().simulation.close()


@pytest.fixture
def ecm(fixture: TestFixture) -> EntityComponentManager:
    with fixture.server().ecm() as found:
        return found


@pytest.fixture
def arm(ecm: EntityComponentManager) -> Model:
    return Model(World(world_entity(ecm)).model_by_name(ecm, "arm"))


# ---------------------------------------------------------------------- the world


def test_the_world_is_entity_one_and_has_its_environment(ecm: EntityComponentManager) -> None:
    world = World(world_entity(ecm))
    assert world.entity() == 1 and world.valid(ecm) and world.name(ecm) == "yard"
    assert world.gravity(ecm) == Vector3d(0, 0, -10)
    assert world.magnetic_field(ecm) == Vector3d(1, 2, 3)
    air = world.atmosphere(ecm)
    assert air is not None
    assert (air.temperature(), air.pressure(), air.temperature_gradient()) == (300, 90000, -0.005)


def test_the_place_on_earth_can_be_read_and_set(fixture: TestFixture, ecm: EntityComponentManager) -> None:
    world = World(world_entity(ecm))
    place = world.spherical_coordinates(ecm)
    assert place is not None and place.surface() == SphericalCoordinates.SurfaceType.EARTH_WGS84
    found = [place.latitude_reference().degree(), place.longitude_reference().degree(), place.elevation_reference()]
    assert [*found, place.heading_offset().degree()] == pytest.approx([10, 15, 20, 25])
    world.set_spherical_coordinates(ecm, SphericalCoordinates())
    changed = world.spherical_coordinates(ecm)
    assert changed is not None and changed.elevation_reference() == 0
    fixture.server().reset_all()
    again = world.spherical_coordinates(ecm)
    assert again is not None and again.elevation_reference() == 20


def test_the_world_counts_what_is_in_it(ecm: EntityComponentManager) -> None:
    world = World(world_entity(ecm))
    assert (world.model_count(ecm), world.light_count(ecm), world.actor_count(ecm)) == (2, 2, 1)
    assert world.model_by_name(ecm, "nobody") == world.light_by_name(ecm, "nobody") == K_NULL_ENTITY
    assert [Model(e).name(ecm) for e in world.models(ecm)] == ["arm", "rock"]


# ---------------------------------------------------------------------- models, links, joints


def test_a_model_has_its_properties(ecm: EntityComponentManager, arm: Model) -> None:
    assert arm.valid(ecm) and not arm.static(ecm) and arm.self_collide(ecm)
    assert (arm.link_count(ecm), arm.joint_count(ecm), len(arm.models(ecm))) == (2, 1, 1)
    assert Link(arm.canonical_link(ecm)).name(ecm) == "base"
    rock = Model(World(1).model_by_name(ecm, "rock"))
    assert rock.static(ecm) and not rock.wind_mode(ecm)


def test_entities_are_numbered_as_gz_sim_numbers_them(ecm: EntityComponentManager, arm: Model) -> None:
    assert arm.entity() == 4  # after the world, its wind and its level
    base = Link(arm.link_by_name(ecm, "base"))
    assert (base.entity(), *base.visuals(ecm), *base.collisions(ecm), *base.sensors(ecm)) == (5, 6, 7, 8)


def test_a_handle_of_no_entity_is_invalid_and_returns_none(ecm: EntityComponentManager) -> None:
    for handle in (Model(), Link(99), Joint(1), Sensor(4), Light(5), Actor(4)):
        assert not handle.valid(ecm)
    assert Link(99).world_pose(ecm) is None and Link(99).name(ecm) is None
    Joint(99).set_velocity(ecm, [1.0])
    assert ecm.commands.is_empty


def test_a_link_has_its_pose_and_its_mass(ecm: EntityComponentManager, arm: Model) -> None:
    base = Link(arm.link_by_name(ecm, "base"))
    assert base.parent_model(ecm) == arm and base.is_canonical(ecm) and base.wind_mode(ecm)
    assert base.world_pose(ecm) == Pose3d(1, 0, 2, 0, 0, Angle.HALF_PI.radian())
    assert base.world_inertial_pose(ecm) == Pose3d(1, 0.1, 2, 0, 0, Angle.HALF_PI.radian())
    inertial = base.world_inertial(ecm)
    assert inertial is not None and inertial.mass_matrix().mass() == 2
    assert base.world_inertia_matrix(ecm) == Matrix3d(2, 0, 0, 0, 1, 0, 0, 0, 2.5)  # turned a quarter
    assert base.collision_by_name(ecm, "hull") and base.visual_by_name(ecm, "shell") and base.sensor_count(ecm) == 1


def test_a_joint_has_its_links_axis_and_type(ecm: EntityComponentManager, arm: Model) -> None:
    elbow = Joint(arm.joint_by_name(ecm, "elbow"))
    assert (elbow.parent_link_name(ecm), elbow.child_link_name(ecm)) == ("base", "hand")
    assert elbow.pose(ecm) == Pose3d(0, -0.5, 0, 0, 0, 0)
    axes = elbow.axis(ecm)
    assert axes is not None and axes[0].xyz() == sdformat.JointAxis().xyz()
    assert (axes[0].lower(), axes[0].upper(), axes[0].effort()) == (-1, 2, 50)
    assert elbow.type(ecm) == sdformat.JointType.REVOLUTE and elbow.sensor_count(ecm) == 1


def test_a_sensor_has_its_pose_in_its_parent_and_its_topic(ecm: EntityComponentManager, arm: Model) -> None:
    feel = Sensor(Link(arm.link_by_name(ecm, "base")).sensor_by_name(ecm, "feel"))
    assert feel.pose(ecm) == Pose3d(0, 0, 0.2, 0, 0, 0)
    assert feel.topic(ecm) == "/world/yard/model/arm/link/base/sensor/feel/imu"
    elbow = arm.joint_by_name(ecm, "elbow")
    strain = Sensor(Joint(elbow).sensor_by_name(ecm, "strain"))
    assert strain.parent(ecm) == elbow and strain.pose(ecm) == Pose3d(0, 0.1, 0, 0, 0, 0)


def test_any_entity_has_a_pose_in_the_world(ecm: EntityComponentManager, arm: Model) -> None:
    base = Link(arm.link_by_name(ecm, "base"))
    assert world_pose(arm.entity(), ecm).pos() == Vector3d(1, 0, 2)
    assert world_pose(base.collision_by_name(ecm, "hull"), ecm).pos() == Vector3d(1, 0, 2.5)
    strain = Joint(arm.joint_by_name(ecm, "elbow")).sensor_by_name(ecm, "strain")
    assert world_pose(strain, ecm).pos() == Vector3d(1 - 0.6, 0, 2)
    assert world_pose(1, ecm) == Pose3d.ZERO


def test_handles_can_be_copied_compared_and_put_into_sets(arm: Model) -> None:
    import copy

    assert copy.deepcopy(arm) == arm == Model(arm) and len({arm, Model(arm)}) == 1 and arm != Link(arm.entity())


# ---------------------------------------------------------------------- lights and actors


def lamp_and_torch(ecm: EntityComponentManager) -> tuple[Light, Light]:
    world = World(world_entity(ecm))
    return Light(world.light_by_name(ecm, "lamp")), Light(world.light_by_name(ecm, "torch"))


def test_a_light_has_its_properties(ecm: EntityComponentManager) -> None:
    lamp, torch = lamp_and_torch(ecm)
    assert lamp.type(ecm) == "point" and torch.type(ecm) == "spot" and lamp.parent(ecm) == 1
    assert lamp.pose(ecm) == Pose3d(0, 2, 2, 0, 0, 0)
    assert lamp.diffuse_color(ecm) == Color(1, 0, 0, 1) and lamp.specular_color(ecm) == Color(0.2, 0, 0, 1)
    assert lamp.cast_shadows(ecm) is True and lamp.intensity(ecm) == 2
    fading = (lamp.attenuation_range, lamp.attenuation_constant, lamp.attenuation_linear, lamp.attenuation_quadratic)
    assert [read(ecm) for read in fading] == [20, 0.8, 0.2, 0.01]
    assert torch.direction(ecm) == Vector3d(0, 0, -1)
    assert (torch.spot_inner_angle(ecm), torch.spot_outer_angle(ecm)) == (Angle(0.1), Angle(0.5))
    assert torch.spot_falloff(ecm) == 0.8


def test_changes_of_a_light_take_effect_at_once(fixture: TestFixture, ecm: EntityComponentManager) -> None:
    lamp, torch = lamp_and_torch(ecm)
    lamp.set_pose(ecm, Pose3d(4, 2, 2, 0, 0, 0))
    lamp.set_diffuse_color(ecm, Color(1, 1, 0, 1))
    lamp.set_intensity(ecm, 5)
    lamp.set_attenuation_linear(ecm, 0.5)
    lamp.set_cast_shadows(ecm, False)
    torch.set_direction(ecm, Vector3d(2, 0, -2))
    torch.set_spot_outer_angle(ecm, Angle(0.7))
    assert lamp.pose(ecm) == Pose3d(4, 2, 2, 0, 0, 0) and lamp.diffuse_color(ecm) == Color(1, 1, 0, 1)
    assert (lamp.intensity(ecm), lamp.attenuation_linear(ecm), lamp.cast_shadows(ecm)) == (5, 0.5, False)
    assert torch.direction(ecm) == Vector3d(0.5**0.5, 0, -(0.5**0.5)) and torch.spot_outer_angle(ecm) == Angle(0.7)
    assert fixture.server().simulation.light("lamp").pose.position.tolist() == [4, 2, 2]
    fixture.server().reset_all()
    assert lamp.diffuse_color(ecm) == Color(1, 0, 0, 1) and lamp.pose(ecm) == Pose3d(0, 2, 2, 0, 0, 0)


def test_values_set_for_an_actor_are_stored(ecm: EntityComponentManager) -> None:
    walker = Actor(World(1).actor_by_name(ecm, "walker"))
    assert walker.pose(ecm) == walker.world_pose(ecm) == Pose3d(1, 1, 0, 0, 0, 0)
    assert walker.trajectory_pose(ecm) is walker.animation_name(ecm) is walker.animation_time(ecm) is None
    walker.set_trajectory_pose(ecm, Pose3d(2, 2, 0, 0, 0, 0))
    walker.set_animation_name(ecm, "walk")
    walker.set_bone_transforms(ecm, {"Hips": Pose3d(0, 0, 1, 0, 0, 0)})
    assert walker.trajectory_pose(ecm) == Pose3d(2, 2, 0, 0, 0, 0) and walker.animation_name(ecm) == "walk"
    for given in (100, timedelta(milliseconds=100)):
        walker.set_animation_time(ecm, given)
        assert walker.animation_time(ecm) == timedelta(milliseconds=100)
    assert walker.bone_transforms(ecm) == {"Hips": Pose3d(0, 0, 1, 0, 0, 0)}


# ---------------------------------------------------------------------- running


def counter(counts: dict[str, int], name: str) -> Callable[..., None]:
    def count(*_: Any) -> None:
        counts[name] = counts.get(name, 0) + 1

    return count


@pytest.mark.parametrize("blocking", [True, False])
def test_every_callback_is_called_once_an_iteration(fixture: TestFixture, blocking: bool) -> None:
    counts: dict[str, int] = {}
    fixture.on_pre_update(counter(counts, "pre")).on_update(counter(counts, "update"))
    fixture.on_post_update(counter(counts, "post")).on_configure(counter(counts, "configure"))
    fixture.finalize()
    server = fixture.server()
    server.run(blocking, 100, False)
    while server.is_running():
        pytest.fail("a run of so many iterations is done when run returns")
    assert counts == {"pre": 100, "update": 100, "post": 100, "configure": 1}
    assert server.iteration_count() == 100


def test_nothing_is_called_before_finalize(fixture: TestFixture) -> None:
    counts: dict[str, int] = {}
    fixture.on_pre_update(counter(counts, "pre"))
    fixture.server().run(True, 5, False)
    assert counts == {}


def test_the_times_are_those_of_gz_sim(fixture: TestFixture) -> None:
    told: list[tuple[str, int, timedelta, timedelta, bool]] = []
    for hook in ("pre_update", "post_update"):
        note = lambda info, ecm, h=hook: told.append((h, info.iterations, info.sim_time, info.dt, info.paused))  # noqa: E731
        getattr(fixture, f"on_{hook}")(note)
    fixture.finalize().server().run(True, 2, False)
    step = timedelta(milliseconds=1)
    assert told == [
        ("pre_update", 1, step, step, False),
        ("post_update", 1, step, step, False),
        ("pre_update", 2, 2 * step, step, False),
        ("post_update", 2, 2 * step, step, False),
    ]


def test_hooks_run_while_paused_and_the_time_is_constant(fixture: TestFixture) -> None:
    told: list[tuple[int, bool, timedelta]] = []
    fixture.on_pre_update(lambda info, ecm: told.append((info.iterations, info.paused, info.dt)))
    server = fixture.finalize().server()
    server.run(True, 3, True)
    assert told == [(0, True, timedelta(0))] * 3 and server.iteration_count() == 0


def test_an_endless_run_has_a_thread_until_it_is_stopped(fixture: TestFixture) -> None:
    server = fixture.server()
    assert server.run(False, 0, False) and server.is_running() and not server.run(True, 1, False)
    server.stop()
    assert not server.is_running()


def test_a_server_describes_its_world(fixture: TestFixture) -> None:
    server = fixture.server()
    assert server.has_entity("elbow") and not server.has_entity("knee") and server.entity_by_name("arm") == 4
    info = server.current_info()
    assert info is not None and info.iterations == 0 and info.sim_time == timedelta(0) and info.paused
    assert server.current_info(1) is None
    with pytest.raises(ValueError, match="there is no world 1; the only world has number 0"), server.ecm(1):
        pass

"""What systems ask of the physics: forces, velocities, poses, limits, each against what mechanics says."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from simkit_gz_python.math import Pose3d, Vector2d, Vector3d
from simkit_gz_python.sim import EntityComponentManager, Joint, Link, Model, UpdateInfo, World
from simkit_gz_python.sim.fixture import TestFixture

STEP = 0.001
INERTIAL = (
    "<inertial><mass>2</mass><pose>{com}</pose><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
)

Hook = Callable[[UpdateInfo, EntityComponentManager], None]


def body(com: str = "0 0 0 0 0 0", pose: str = "0 0 5 0 0 0", gravity: str = "0 0 0") -> str:
    return f"""<sdf version="1.9"><world name="w"><gravity>{gravity}</gravity><model name="body"><pose>{pose}</pose>
      <link name="link">{INERTIAL.format(com=com)}</link></model></world></sdf>"""


def wheel(limit: str = "", gravity: str = "0 0 -9.8", damping: float = 0.0) -> str:
    """A wheel of 1 kg m² on a stand, about z."""
    return f"""<sdf version="1.9"><world name="w"><gravity>{gravity}</gravity><model name="stand">
      <link name="foot"/><link name="rim">{INERTIAL.format(com="0 0 0 0 0 0")}</link>
      <joint name="fix" type="fixed"><parent>world</parent><child>foot</child></joint>
      <joint name="axle" type="revolute"><parent>foot</parent><child>rim</child><axis><xyz>0 0 1</xyz>
        <dynamics><damping>{damping}</damping></dynamics>{limit}</axis></joint></model></world></sdf>"""


def run(world: str, steps: int, pre: Hook, post: Hook | None = None) -> Any:
    fixture = TestFixture(world)
    fixture.on_pre_update(pre)
    if post is not None:
        fixture.on_post_update(post)
    fixture.finalize().server().run(True, steps, False)
    return fixture.server().simulation


def the_link(ecm: EntityComponentManager, model: str = "body", link: str = "link") -> Link:
    return Link(Model(World(1).model_by_name(ecm, model)).link_by_name(ecm, link))


def the_axle(ecm: EntityComponentManager) -> Joint:
    return Joint(Model(World(1).model_by_name(ecm, "stand")).joint_by_name(ecm, "axle"))


def only_first(call: Callable[[EntityComponentManager], None]) -> Hook:
    def hook(info: UpdateInfo, ecm: EntityComponentManager) -> None:
        if info.iterations == 1:
            call(ecm)

    return hook


# ---------------------------------------------------------------------- forces


def test_a_force_acts_for_one_step() -> None:
    sim = run(body(), 5, only_first(lambda ecm: the_link(ecm).add_world_force(ecm, Vector3d(4, 0, 0))))
    assert sim.link("body::link").linear_velocity == pytest.approx([4 / 2 * STEP, 0, 0])


def test_a_force_is_at_the_centre_of_mass_and_turns_nothing() -> None:
    sim = run(body("0.3 0 0 0 0 0"), 1, lambda _, ecm: the_link(ecm).add_world_force(ecm, Vector3d(0, 4, 0)))
    assert sim.link("body::link").angular_velocity == pytest.approx([0, 0, 0], abs=1e-12)


def test_a_force_at_an_offset_has_the_torque_of_its_arm_in_link_axes() -> None:
    # turned a quarter about z, the arm along the link's x lies along the world's y
    world = body("0.3 0 0 0 0 0", "0 0 5 0 0 1.5707963267948966")
    push = lambda _, ecm: the_link(ecm).add_world_force(ecm, Vector3d(4, 0, 0), Vector3d(0.5, 0, 0))  # noqa: E731
    sim = run(world, 1, push)
    assert sim.link("body::link").angular_velocity == pytest.approx([0, 0, -4 * 0.5 * STEP])


def test_a_wrench_acts_at_the_links_origin_and_several_add_up() -> None:
    def push(_: UpdateInfo, ecm: EntityComponentManager) -> None:
        the_link(ecm).add_world_wrench(ecm, Vector3d(0, 3, 0), Vector3d(0, 0, 1))
        the_link(ecm).add_world_wrench(ecm, Vector3d(0, 1, 0), Vector3d())

    sim = run(body("0.5 0 0 0 0 0"), 1, push)
    assert sim.link("body::link").angular_velocity == pytest.approx([0, 0, (1 - 0.5 * 4) * STEP])


def test_a_link_force_is_in_the_links_axes() -> None:
    world = body(pose="0 0 5 0 0 1.5707963267948966")
    sim = run(world, 1, lambda _, ecm: the_link(ecm).add_link_force(ecm, Vector3d(4, 0, 0)))
    assert sim.link("body::link").linear_velocity == pytest.approx([0, 4 / 2 * STEP, 0])


# ---------------------------------------------------------------------- velocities and poses of bodies


def test_a_velocity_command_is_in_link_axes_and_lasts_one_step() -> None:
    speeds: list[float] = []

    def note(_: UpdateInfo, ecm: EntityComponentManager) -> None:
        speeds.append(float(run_of(ecm).link("body::link").linear_velocity[1]))

    world = body("0.2 0 0 0 0 0", "0 0 5 0 0 1.5707963267948966")
    run(world, 3, only_first(lambda ecm: the_link(ecm).set_linear_velocity(ecm, Vector3d(3, 0, 0))), note)
    assert speeds == pytest.approx([3, 0, 0])  # gz-sim empties the command and does not take it back


def run_of(ecm: EntityComponentManager) -> Any:
    return ecm.simulation


def test_linear_and_angular_velocity_are_those_of_the_links_origin() -> None:
    def push(_: UpdateInfo, ecm: EntityComponentManager) -> None:
        the_link(ecm).set_linear_velocity(ecm, Vector3d(1, 2, 3))
        the_link(ecm).set_angular_velocity(ecm, Vector3d(0, 0, 4))

    sim = run(body("0.4 0 0 0 0 0"), 1, push)
    link = sim.link("body::link")
    assert link.angular_velocity == pytest.approx([0, 0, 4], abs=1e-6)
    # the centre of mass goes straight on for the step, the origin about it
    assert link.linear_velocity == pytest.approx([1, 2, 3], abs=4 * 4 * 0.4 * STEP)


def test_gravity_acts_within_the_step_after_a_velocity() -> None:
    sim = run(body(gravity="0 0 -10"), 4, lambda _, ecm: the_link(ecm).set_linear_velocity(ecm, Vector3d(1, 0, 0)))
    assert sim.link("body::link").linear_velocity == pytest.approx([1, 0, -10 * STEP])


def test_a_pose_is_there_after_the_step() -> None:
    poses: list[Pose3d | None] = []

    def move(info: UpdateInfo, ecm: EntityComponentManager) -> None:
        model = Model(World(1).model_by_name(ecm, "body"))
        if info.iterations == 1:
            model.set_world_pose_cmd(ecm, Pose3d(1, 2, 3, 0, 0, 0.5))
            poses.append(the_link(ecm).world_pose(ecm))

    sim = run(body(), 2, move)
    assert poses[0] is not None and poses[0].z() == 5  # the command waits for the physics
    assert sim.model("body").pose.position == pytest.approx([1, 2, 3])
    assert sim.model("body").pose.rpy == pytest.approx([0, 0, 0.5])


def test_a_static_model_can_be_moved_too() -> None:
    world = """<sdf version="1.9"><world name="w"><model name="wall"><static>true</static><link name="l"/></model>
      </world></sdf>"""
    move = lambda ecm: Model(World(1).model_by_name(ecm, "wall")).set_world_pose_cmd(ecm, Pose3d(0, 3, 0, 0, 0, 0))  # noqa: E731
    sim = run(world, 2, only_first(move))
    assert sim.model("wall").pose.position == pytest.approx([0, 3, 0])


def test_a_nested_model_does_not_move_and_is_a_warning_once() -> None:
    world = """<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="out"><link name="l"/>
      <model name="in"><link name="m"/></model></model></world></sdf>"""

    def move(_: UpdateInfo, ecm: EntityComponentManager) -> None:
        outer = Model(World(1).model_by_name(ecm, "out"))
        Model(outer.model_by_name(ecm, "in")).set_world_pose_cmd(ecm, Pose3d(0, 3, 0, 0, 0, 0))

    sim = run(world, 3, move)
    assert sim.model("out::in").pose.position == pytest.approx([0, 0, 0])
    assert [d.code for d in sim.diagnostics].count("SK-PLUGIN-085") == 1


# ---------------------------------------------------------------------- joints


def test_a_joint_turns_at_the_commanded_velocity_from_the_first_step() -> None:
    sim = run(wheel(damping=0.7), 3, lambda _, ecm: the_axle(ecm).set_velocity(ecm, [10.0]))
    assert sim.joint("stand::axle").velocity == pytest.approx(10, rel=1e-9)


def test_the_effort_limit_holds_a_velocity_command_back() -> None:
    limit = "<limit><effort>5</effort></limit>"
    sim = run(wheel(limit), 4, lambda _, ecm: the_axle(ecm).set_velocity(ecm, [10.0]))
    assert sim.joint("stand::axle").velocity == pytest.approx(5 / 1 * 4 * STEP, rel=1e-6)


def test_after_a_velocity_command_the_joint_is_held_at_rest() -> None:
    sim = run(wheel(), 2, only_first(lambda ecm: the_axle(ecm).set_velocity(ecm, [10.0])))
    assert sim.joint("stand::axle").velocity == pytest.approx(0, abs=1e-9)


def test_a_force_lasts_one_step_and_disables_velocity_commands() -> None:
    def act(info: UpdateInfo, ecm: EntityComponentManager) -> None:
        if info.iterations == 1:
            the_axle(ecm).set_force(ecm, [8.0])
        the_axle(ecm).set_velocity(ecm, [10.0])

    sim = run(wheel(), 5, act)
    assert sim.joint("stand::axle").velocity == pytest.approx(8 * STEP, rel=1e-6)


def test_positions_and_velocities_are_reset_once() -> None:
    def put(ecm: EntityComponentManager) -> None:
        the_axle(ecm).reset_position(ecm, [0.5])
        the_axle(ecm).reset_velocity(ecm, [2.0])

    sim = run(wheel(), 10, only_first(put))
    assert sim.joint("stand::axle").velocity == pytest.approx(2.0)
    assert sim.joint("stand::axle").position == pytest.approx(0.5 + 10 * 2 * STEP)


def test_limits_can_be_set() -> None:
    def limit(ecm: EntityComponentManager) -> None:
        the_axle(ecm).set_position_limits(ecm, [Vector2d(-0.1, 0.2)])
        the_axle(ecm).set_velocity_limits(ecm, [Vector2d(-3, 3)])
        the_axle(ecm).set_effort_limits(ecm, [Vector2d(-7, 7)])

    joint = run(wheel(), 1, only_first(limit)).joint("stand::axle")
    assert (joint.lower, joint.upper, joint.velocity_limit, joint.effort_limit) == (-0.1, 0.2, 3, 7)


def test_nan_in_a_command_names_the_hook_and_the_line() -> None:
    import simkit

    fixture = TestFixture(wheel())
    fixture.on_pre_update(lambda _, ecm: the_axle(ecm).set_force(ecm, [float("nan")]))
    with pytest.raises(simkit.PluginError, match=r"raised in pre_update at .*test_commands\.py:\d+ .*finite numbers"):
        fixture.finalize().server().run(True, 1, False)


# ---------------------------------------------------------------------- readings


def test_a_reading_is_none_until_enabled_and_zero_until_a_step_has_passed() -> None:
    told: list[Any] = []

    def look(info: UpdateInfo, ecm: EntityComponentManager) -> None:
        link, axle = the_link(ecm, "stand", "rim"), the_axle(ecm)
        if info.iterations == 1:
            told.append((link.world_linear_velocity(ecm), axle.position(ecm), axle.velocity(ecm)))
            link.enable_velocity_checks(ecm)
            axle.enable_position_check(ecm)
            axle.enable_velocity_check(ecm)
            axle.reset_velocity(ecm, [3.0])
        told.append((link.world_angular_velocity(ecm), axle.position(ecm), axle.velocity(ecm)))

    run(wheel(), 2, look)
    assert told[0] == (None, None, None)
    assert told[1] == (Vector3d(), [], [])
    assert told[2][0] == Vector3d(0, 0, 3)
    assert told[2][1] == pytest.approx([3 * STEP]) and told[2][2] == pytest.approx([3.0])


def test_a_falling_body_accelerates_by_gravity_and_gains_energy() -> None:
    told: list[Any] = []

    def look(info: UpdateInfo, ecm: EntityComponentManager) -> None:
        link = the_link(ecm)
        link.enable_acceleration_checks(ecm)
        link.enable_velocity_checks(ecm)
        told.append((link.world_linear_acceleration(ecm), link.world_kinetic_energy(ecm)))

    run(body(gravity="0 0 -10"), 101, look)
    acceleration, energy = told[-1]
    assert acceleration == Vector3d(0, 0, -10)
    assert energy == pytest.approx(0.5 * 2 * (10 * 100 * STEP) ** 2)


def test_a_point_of_a_turning_body_has_the_velocity_of_its_arm() -> None:
    told: list[Any] = []

    def look(info: UpdateInfo, ecm: EntityComponentManager) -> None:
        link = the_link(ecm)
        link.enable_velocity_checks(ecm)
        link.set_angular_velocity(ecm, Vector3d(0, 0, 2))
        told.append(link.world_linear_velocity(ecm, Vector3d(0.5, 0, 0)))

    run(body(), 2, look)
    assert list(told[-1]) == pytest.approx([0, 1, 0], abs=2.1 * STEP)  # it has turned on for a step


def test_a_torque_shows_as_angular_acceleration() -> None:
    told: list[Any] = []

    def look(info: UpdateInfo, ecm: EntityComponentManager) -> None:
        link = the_link(ecm)
        link.enable_acceleration_checks(ecm)
        told.append(link.world_angular_acceleration(ecm))
        link.add_world_wrench(ecm, Vector3d(), Vector3d(0, 0, 3))

    run(body(), 3, look, lambda info, ecm: told.append(the_link(ecm).world_angular_acceleration(ecm)))
    assert told[-1] == Vector3d(0, 0, 3)


def test_the_transmitted_wrench_carries_the_weight() -> None:
    told: list[Any] = []

    def look(info: UpdateInfo, ecm: EntityComponentManager) -> None:
        the_axle(ecm).enable_transmitted_wrench_check(ecm)
        told.append(the_axle(ecm).transmitted_wrench(ecm))

    run(wheel(), 3, look)
    force = told[-1][0].force
    assert told[0] == [] and np.array([force.x, force.y, force.z]) == pytest.approx([0, 0, 2 * 9.8], abs=1e-6)

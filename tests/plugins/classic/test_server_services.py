"""Services of Gazebo Classic for ROS 2, and for worlds in ROS 1's spelling."""

from __future__ import annotations

import math
from typing import Any

import pytest
from service_worlds import load, model

import simkit

ROS_1 = """<plugin name="d" filename="libgazebo_ros_p3d.so"><bodyName>box::body</bodyName><topicName>truth</topicName>
</plugin>"""
API = '<plugin name="api" filename="libgazebo_ros_api_plugin.so"/>'
RANGE = """<sdf version="1.9"><model name="eye"><pose>3 3 1 0 0 0</pose><link name="l"><sensor name="s" type="ray"><ray>
<scan><horizontal><samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan>
<range><min>0.1</min><max>5</max></range></ray>
<plugin name="eye_plugin" filename="libgazebo_ros_ray_sensor.so">{}<output_type>sensor_msgs/LaserScan</output_type>
</plugin></sensor></link></model></sdf>"""


def xyz(vector: Any) -> tuple[float, float, float]:
    return vector.x, vector.y, vector.z


# ---------------------------------------------------------------------- spawning, listing, deleting


def test_a_model_is_spawned_listed_and_deleted() -> None:
    with load() as sim:
        response = sim.call(
            "/spawn_entity", {"xml": model("one", "0 0 2 0 0 0"), "initial_pose": {"position": {"x": 5}}}
        )
        assert (response.success, response.status_message) == (True, "SpawnEntity: Successfully spawned entity [one]")
        # its own pose counts in the initial one, as in Classic
        assert sim.model("one").pose.position == pytest.approx((5, 0, 2))
        listed = sim.call("/get_model_list")
        assert (listed.success, listed.model_names) == (True, ["ground", "box", "arm", "one"])
        response = sim.call("/delete_entity", {"name": "one"})
        assert (response.success, response.status_message) == (True, "Successfully deleted entity [one]")
        assert "one" not in sim.models


def test_an_initial_pose_turns_the_models_own() -> None:
    quarter = {"z": math.sin(math.pi / 4), "w": math.cos(math.pi / 4)}
    with load() as sim:
        sim.call("/spawn_entity", {"xml": model("one", "2 0 0 0 0 0"), "initial_pose": {"orientation": quarter}})
        assert sim.model("one").pose.position == pytest.approx((0, 2, 0))
        frame = {"name": "two", "xml": model("two"), "reference_frame": "one", "initial_pose": {"position": {"x": 1}}}
        assert sim.call("/spawn_entity", frame).success
        assert sim.model("two").pose.position == pytest.approx((0, 3, 0))


def test_without_a_name_a_number_is_added_and_with_one_it_is_refused() -> None:
    with load() as sim:
        assert sim.call("/spawn_entity", {"xml": model("box", "5 0 0 0 0 0")}).success
        assert list(sim.models)[-1] == "box_0"
        response = sim.call("/spawn_entity", {"xml": model("one"), "name": "box"})
        assert (response.success, response.status_message) == (False, "Entity [box] already exists.")


def test_a_robot_from_urdf_is_spawned() -> None:
    with load() as sim:
        urdf = '<robot name="r"><link name="base"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" '
        urdf += 'iyz="0" izz="1"/></inertial></link></robot>'
        assert sim.call("/spawn_entity", {"xml": urdf, "name": "robot", "initial_pose": {"position": {"z": 3}}}).success
        assert sim.model("robot").pose.position == pytest.approx((0, 0, 3))


@pytest.mark.parametrize(
    ("own", "topic"),
    [
        ("", "/left/eye_plugin/out"),
        ("<ros/>", "/left/eye_plugin/out"),
        ("<ros><namespace>old</namespace><remapping>~/out:=scan</remapping></ros>", "/left/scan"),
        ("<ros><remapping>~/out:=scan</remapping></ros>", "/left/scan"),
    ],
)
def test_plugins_of_a_spawned_robot_are_in_its_namespace(own: str, topic: str) -> None:
    with load() as sim:
        response = sim.call("/spawn_entity", {"xml": RANGE.format(own), "robot_namespace": "left"})
        assert response.success, response.status_message
        assert topic in sim.topics()


def test_a_namespace_is_escaped_in_the_xml() -> None:
    with load() as sim:
        response = sim.call("/spawn_entity", {"xml": RANGE.format(""), "robot_namespace": "left</namespace><a>&"})
        assert response.success, response.status_message
        assert sum(topic.startswith("/left") for topic in sim.topics()) == 1


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        ({"xml": ""}, "the XML of the entity is empty"),
        ({"xml": "<sdf version='1.9'><mdel name='a'/></sdf>"}, "did you mean 'model'?"),
        ({"xml": "<sdf"}, "SK-"),
        ({"xml": model("a"), "reference_frame": "bax"}, "there is no reference frame 'bax'; did you mean 'box'?"),
        ({"xml": model("a"), "initial_pose": {"position": {"x": math.inf}}}, "found initial_pose.position.x inf"),
    ],
)
def test_a_failed_spawn_is_reported_and_does_not_change_the_world(request_: dict[str, Any], why: str) -> None:
    with load() as sim:
        response = sim.call("/spawn_entity", request_)
        assert not response.success
        assert why in response.status_message
        assert list(sim.models) == ["ground", "box", "arm"]


def test_a_missing_entity_cannot_be_deleted() -> None:
    with load() as sim:
        assert "did you mean 'box'?" in sim.call("/delete_entity", {"name": "bux"}).status_message
        assert (
            "is part of the model 'box'; delete the model"
            in sim.call("/delete_entity", {"name": "box::body"}).status_message
        )
        assert "'sun' cannot be removed" in sim.call("/delete_entity", {"name": "sun"}).status_message


# ---------------------------------------------------------------------- pausing, resetting


def test_physics_are_paused_and_resumed() -> None:
    with load() as sim:
        sim.call("/pause_physics")
        assert sim.paused
        sim.call("/unpause_physics")
        assert not sim.paused


def test_a_reset_of_the_simulation_resets_the_time_and_stays_paused() -> None:
    with load() as sim:
        sim.model("box").set_pose(simkit.Pose((3, 3, 3)))
        sim.run(0.1)
        sim.call("/pause_physics")
        sim.call("/reset_simulation")
        assert (sim.time, sim.paused) == (0.0, True)
        assert sim.model("box").pose.position == pytest.approx((0, 0, 0.5))


def test_a_reset_of_the_world_keeps_the_time() -> None:
    with load() as sim:
        sim.model("box").set_pose(simkit.Pose((3, 3, 3)))
        sim.joint("arm::hinge").set_position(0.5)
        sim.run(0.1)
        sim.call("/reset_world")
        assert sim.time == 0.1
        assert sim.model("box").pose.position == pytest.approx((0, 0, 0.5))
        assert (sim.joint("arm::hinge").position, sim.joint("arm::hinge").velocity) == (0.0, 0.0)


# ---------------------------------------------------------------------- states


def test_a_state_is_set_and_read() -> None:
    with load() as sim:
        twist = {"linear": {"x": 1.0}, "angular": {"z": 2.0}}
        state = {"name": "box", "pose": {"position": {"z": 9.0}}, "twist": twist}
        assert sim.call("/set_entity_state", {"state": state}).success
        found = sim.call("/get_entity_state", {"name": "box::body"})
        assert found.success
        assert xyz(found.state.pose.position) == pytest.approx((0, 0, 9))
        assert xyz(found.state.twist.linear) == pytest.approx((1, 0, 0))
        assert xyz(found.state.twist.angular) == pytest.approx((0, 0, 2))
        sim.run(0.5)
        found = sim.call("/get_entity_state", {"name": "box"})
        assert (found.header.stamp.nanosec, xyz(found.state.pose.position)[0]) == (500_000_000, pytest.approx(0.5))


def test_a_state_relative_to_a_moving_entity_subtracts_its_motion() -> None:
    with load() as sim:
        sim.spawn(model("one", "0 0 20 0 0 1.5707963267948966"))
        sim.model("one").set_velocity((0, 3, 0))
        sim.model("box").set_pose(simkit.Pose((1, 2, 20)))
        sim.model("box").set_velocity((0, 5, 0))
        found = sim.call("/get_entity_state", {"name": "box", "reference_frame": "one"})
        assert found.header.frame_id == "one"
        assert xyz(found.state.pose.position) == pytest.approx((2, -1, 0))  # x of `one` is y of the world
        assert xyz(found.state.twist.linear) == pytest.approx((2, 0, 0))
        state = {"name": "box", "reference_frame": "one", "pose": {"position": {"x": 4}}, "twist": {"linear": {"x": 1}}}
        assert sim.call("/set_entity_state", {"state": state}).success
        assert sim.model("box").pose.position == pytest.approx((0, 4, 20))
        assert sim.link("box::body").linear_velocity == pytest.approx((0, 1, 0), abs=1e-12)


def test_a_free_link_is_moved_and_a_joined_link_is_refused(caplog: pytest.LogCaptureFixture) -> None:
    with load() as sim:
        state = {"name": "box::body", "pose": {"position": {"x": 4, "z": 4}}, "twist": {"angular": {"z": 1}}}
        assert sim.call("/set_entity_state", {"state": state}).success
        assert sim.model("box").pose.position == pytest.approx((4, 0, 4))
        assert sim.link("box::body").angular_velocity == pytest.approx((0, 0, 1))
        assert not sim.call("/set_entity_state", {"state": {**state, "name": "arm::tip"}}).success
        assert "link 'arm::tip' is held by joints or the world; move the model 'arm'" in caplog.text


def test_joint_positions_are_set() -> None:
    with load() as sim:
        request = {"model_name": "arm", "joint_names": ["hinge"], "joint_positions": [0.25]}
        assert sim.call("/set_joint_positions", request).success
        assert sim.joint("arm::hinge").position == 0.25
        response = sim.call("/set_joint_positions", {**request, "joint_positions": []})
        assert response.status_message == "joint name and position list have different lengths"
        response = sim.call("/set_joint_positions", {**request, "joint_names": ["hing"]})
        assert "did you mean 'hinge'?" in response.status_message


STATE = """<plugin name="state" filename="libgazebo_ros_state.so"><ros><namespace>/demo</namespace><remapping>
link_states:=links</remapping></ros><update_rate>20</update_rate></plugin>"""


def test_a_state_plugin_publishes_states_in_its_namespace() -> None:
    with load(STATE) as sim:
        models, links, root = (sim.subscribe(t) for t in ("/demo/model_states", "/demo/links", "/model_states"))
        sim.model("box").set_velocity((0, 0, 7))
        sim.run(0.1)
        assert (len(models.messages), len(links.messages), len(root.messages)) == (2, 2, 10)
        assert models.latest.name == ["ground", "box", "arm"]
        assert models.latest.twist[1].linear.z == pytest.approx(7 - 10 * 0.1)
        assert links.latest.name == ["ground::plane", "box::body", "arm::base", "arm::tip"]
        assert links.latest.pose[3].position.x == pytest.approx(1.0)
        assert sim.call("/demo/get_entity_state", {"name": "box"}).success


def test_a_state_plugin_without_a_namespace_replaces_the_default_topics() -> None:
    with load('<plugin name="state" filename="libgazebo_ros_state.so"/>') as sim:
        models = sim.subscribe("/model_states")
        sim.run(0.1)
        assert len(models.messages) == 10  # 100 Hz, and not twice
        assert sim.call("/get_entity_state", {"name": "box"}).success


# ---------------------------------------------------------------------- properties


def test_properties_are_those_of_the_file() -> None:
    with load() as sim:
        found = sim.call("/get_model_properties", {"model_name": "arm"})
        assert (found.canonical_body_name, found.joint_names) == ("arm::base", ["fix", "hinge"])
        assert (found.body_names, found.is_static, found.success) == (["arm::base", "arm::tip"], False, True)
        sim.joint("arm::hinge").set_position(0.5)
        found = sim.call("/get_joint_properties", {"joint_name": "hinge"})
        assert (found.type, found.damping, found.position, found.rate) == (0, [0.25], [0.5], [0.0])
        found = sim.call("/get_link_properties", {"link_name": "box::body"})
        assert (found.mass, found.ixx, found.ixy, found.gravity_mode) == (2.0, 0.5, 0.0, True)
        found = sim.call("/get_world_properties")
        assert (found.sim_time, found.model_names) == (0.0, ["ground", "box", "arm"])
        found = sim.call("/get_light_properties", {"light_name": "lamp"})
        assert (found.attenuation_constant, found.attenuation_linear) == (0.5, pytest.approx(0.01))
        assert "did you mean 'hinge'?" in sim.call("/get_joint_properties", {"joint_name": "hingy"}).status_message


def test_damping_and_limits_of_a_joint_are_set_and_survive_a_spawn() -> None:
    with load() as sim:
        config = {"damping": [4.0], "hi_stop": [0.5], "cfm": [0.1]}
        response = sim.call("/set_joint_properties", {"joint_name": "arm::hinge", "ode_joint_config": config})
        assert response.status_message == "SetJointProperties: properties set; not used: cfm"
        sim.spawn(model("one", "5 0 0 0 0 0"))
        hinge = sim.joint("arm::hinge")
        assert list(sim.call("/get_joint_properties", {"joint_name": "hinge"}).damping) == [4.0]
        assert (hinge.lower, hinge.upper) == (-1.0, 0.5)
        # 1 kg m² about the axis, so the speed falls by e in I/damping = 0.25 s
        hinge.set_velocity(0.2)
        sim.run(0.5)
        assert hinge.velocity == pytest.approx(0.2 * math.exp(-2), rel=5e-3)
        sim.reset()
        assert list(sim.call("/get_joint_properties", {"joint_name": "hinge"}).damping) == [0.25]
        assert (hinge.lower, hinge.upper) == (-1.0, 1.0)


def test_physics_are_read_and_set() -> None:
    with load() as sim:
        found = sim.call("/get_physics_properties")
        assert (found.time_step, found.max_update_rate, found.gravity.z) == (0.001, 0.0, -10.0)
        again = {"time_step": 0.001, "gravity": {"z": -3.0}, "ode_config": found.ode_config}
        response = sim.call("/set_physics_properties", again)
        assert (response.success, response.status_message) == (True, "physics engine updated")
        assert sim.gravity[2] == -3.0
        assert sim.call("/set_physics_properties").success
        assert not sim.gravity.any()  # all fields count in Classic


def test_a_light_is_set() -> None:
    with load() as sim:
        request = {"light_name": "lamp", "diffuse": {"r": 0.5, "a": 1.0}, "attenuation_constant": 2.0}
        assert sim.call("/set_light_properties", request).success
        scene = sim.light("lamp").scene
        assert (scene.diffuse, scene.attenuation) == ((0.5, 0, 0, 1), (20, 2, 0, 0))


# ---------------------------------------------------------------------- wrenches and efforts


def flying(**options: Any) -> simkit.Simulation:
    """The box without gravity, a metre above the ground."""
    sim = load("", **options)
    sim.gravity = (0, 0, 0)
    sim.model("box").set_pose(simkit.Pose((0, 0, 9)))
    return sim


def push(sim: simkit.Simulation, **fields: Any) -> Any:
    return sim.call("/apply_link_wrench", {"link_name": "box::body", **fields})


def test_a_wrench_has_the_requested_duration() -> None:
    with flying() as sim:
        assert push(sim, wrench={"force": {"x": 4.0}, "torque": {"z": 1.0}}, duration={"nanosec": 100_000_000}).success
        sim.run(0.5)
        # 0.1 s of 4 N on 2 kg and of 1 N m on 0.5 kg m²
        assert sim.link("box::body").linear_velocity == pytest.approx((0.2, 0, 0), abs=1e-9)
        assert sim.link("box::body").angular_velocity == pytest.approx((0, 0, 0.2), abs=1e-9)


def test_a_duration_of_zero_has_no_effect_and_a_shorter_one_than_a_step_is_a_step() -> None:
    with flying() as sim:
        push(sim, wrench={"force": {"x": 4.0}})
        sim.run(0.1)
        assert not sim.link("box::body").linear_velocity.any()
        push(sim, wrench={"force": {"x": 4.0}}, duration={"nanosec": 10})
        sim.run(0.1)
        assert sim.link("box::body").linear_velocity == pytest.approx((0.002, 0, 0), abs=1e-12)


def test_a_wrench_starts_at_its_time_and_lasts_until_cleared(caplog: pytest.LogCaptureFixture) -> None:
    with flying() as sim:
        push(sim, wrench={"force": {"x": 4.0}}, start_time={"nanosec": 100_000_000}, duration={"sec": -1})
        sim.run(0.1)
        assert not sim.link("box::body").linear_velocity.any()
        sim.run(0.1)
        assert sim.link("box::body").linear_velocity[0] == pytest.approx(0.2)
        sim.call("/clear_link_wrenches", {"link_name": "box::body"})
        sim.run(0.1)
        assert sim.link("box::body").linear_velocity[0] == pytest.approx(0.2)
        sim.call("/clear_link_wrenches", {"link_name": "box::body"})
        assert "no applied wrenches on 'box::body'" in caplog.text


def test_a_wrench_in_the_frame_of_an_entity_turns_with_it_and_has_a_lever() -> None:
    with flying() as sim:
        sim.model("box").set_pose(simkit.Pose.from_rpy(0, 0, 9, 0, 0, math.pi / 2))
        frame = {"reference_frame": "box::body", "reference_point": {"y": 0.5}}
        push(sim, wrench={"force": {"x": 4.0}}, duration={"nanosec": 1}, **frame)
        sim.step()
        # forward of the box is y of the world; half a metre to its left the force turns it to the right
        assert sim.link("box::body").linear_velocity == pytest.approx((0, 0.002, 0), abs=1e-12)
        assert sim.link("box::body").angular_velocity == pytest.approx((0, 0, -0.5 * 4 / 0.5 * 0.001), abs=1e-9)


def test_an_effort_drives_a_joint_and_adds_to_a_plugins_effort() -> None:
    class Motor(simkit.WorldPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            self.joint = self.sim.joint("arm::hinge")

        def before_step(self) -> None:
            self.joint.set_effort(0.5)

    for plugins, effort in (([], 1.0), ([Motor()], 1.5)):
        with load(plugins=plugins) as sim:
            sim.call("/set_joint_properties", {"joint_name": "hinge", "ode_joint_config": {"damping": [0.0]}})
            response = sim.call("/apply_joint_effort", {"joint_name": "hinge", "effort": 1.0, "duration": {"sec": 1}})
            assert response.status_message == "Effort on joint [hinge] set"
            sim.run(0.2)
            assert sim.joint("arm::hinge").velocity == pytest.approx(effort * 0.2, rel=1e-6)
            sim.call("/clear_joint_efforts", {"joint_name": "hinge"})


def test_snapshots_and_reset_include_active_wrenches() -> None:
    with flying() as sim:
        push(sim, wrench={"force": {"x": 4.0}}, duration={"nanosec": 200_000_000})
        sim.run(0.1)
        snapshot = sim.snapshot()
        sim.run(0.3)
        first = sim.mj_data.qpos.copy()
        sim.restore(snapshot)
        sim.run(0.3)
        assert (sim.mj_data.qpos == first).all()
        sim.restore(snapshot)
        sim.reset()
        sim.gravity = (0, 0, 0)
        sim.run(0.1)
        assert abs(sim.link("box::body").linear_velocity[0]) < 1e-9


def test_no_callback_runs_at_every_step_without_active_wrenches() -> None:
    with flying() as sim:
        push(sim, wrench={"force": {"x": 4.0}}, duration={"nanosec": 2_000_000})
        assert len(sim.engine.scheduler.before.every) == 1
        sim.run(0.1)
        assert not sim.engine.scheduler.before.every


def test_a_missing_entity_is_reported() -> None:
    with load() as sim:
        response = sim.call("/apply_link_wrench", {"link_name": "box::boddy"})
        assert "did you mean 'box::body'?" in response.status_message
        response = push(sim, reference_frame="bux")
        assert "there is no reference frame 'bux'" in response.status_message
        response = sim.call("/apply_joint_effort", {"joint_name": "fix", "effort": 1.0})
        assert "has 0 degrees of freedom" in response.status_message


# ---------------------------------------------------------------------- ROS 1


@pytest.mark.parametrize(("more", "is_listed"), [("", False), (STATE, False), (ROS_1, True), (API, True)])
def test_the_names_of_ros_1_always_answer_and_are_listed_in_worlds_with_its_spelling(
    more: str, is_listed: bool
) -> None:
    with load(more) as sim:
        names = sim.communication.services.names()
        assert ("/gazebo/set_model_state" in names) == is_listed
        assert "/spawn_entity" in names
        assert sim.call("/gazebo/get_model_state", {"model_name": "box"}).success
        latest = sim.subscribe("/gazebo/model_states")
        sim.run(0.02)
        assert "box" in latest.latest.name


def test_models_and_links_of_ros_1_are_spawned_set_and_read() -> None:
    with load(API) as sim:
        spawned = sim.call("/gazebo/spawn_sdf_model", {"model_name": "one", "model_xml": model("x", "4 0 0.5 0 0 0")})
        assert (spawned.success, spawned.status_message) == (True, "SpawnModel: Successfully spawned entity")
        state = {"model_name": "one", "pose": {"position": {"z": 9}}, "twist": {"linear": {"y": 2}}}
        assert sim.call("/gazebo/set_model_state", {"model_state": state}).success
        found = sim.call("/gazebo/get_model_state", {"model_name": "one", "relative_entity_name": "box"})
        assert xyz(found.pose.position) == pytest.approx((0, 0, 8.5))
        assert (xyz(found.twist.linear), found.success) == (pytest.approx((0, 2, 0)), True)
        found = sim.call("/gazebo/get_link_state", {"link_name": "one::body"}).link_state
        assert (found.link_name, xyz(found.pose.position)) == ("one::body", pytest.approx((0, 0, 9)))
        link = {"link_name": "one::body", "pose": {"position": {"x": 1, "z": 9}}}
        assert sim.call("/gazebo/set_link_state", {"link_state": link}).success
        assert sim.model("one").pose.position == pytest.approx((1, 0, 9))
        assert sim.call("/gazebo/delete_model", {"model_name": "one"}).success
        assert not sim.call("/gazebo/get_model_state", {"model_name": "one"}).success


def test_states_of_ros_1_are_set_and_published_by_topic() -> None:
    with load(ROS_1) as sim:
        states = sim.subscribe("/gazebo/model_states")
        sim.publish("/gazebo/set_model_state", {"model_name": "box", "pose": {"position": {"x": 6, "z": 3}}})
        sim.run(0.01)
        assert xyz(states.latest.pose[states.latest.name.index("box")].position) == pytest.approx((6, 0, 3), abs=1e-3)


def test_wrenches_and_efforts_have_the_names_of_ros_1() -> None:
    with load(API) as sim:
        sim.gravity = (0, 0, 0)
        sim.model("box").set_pose(simkit.Pose((0, 0, 9)))
        wrench = {"body_name": "box::body", "wrench": {"force": {"x": 2}}, "duration": {"sec": -1}}
        assert sim.call("/gazebo/apply_body_wrench", wrench).success
        sim.run(0.1)
        sim.call("/gazebo/clear_body_wrenches", {"body_name": "box::body"})
        sim.run(0.1)
        assert sim.link("box::body").linear_velocity == pytest.approx((0.1, 0, 0), abs=1e-9)
        request = {"model_name": "arm", "joint_names": ["hinge"], "joint_positions": [0.25]}
        assert sim.call("/gazebo/set_model_configuration", request).success
        sim.call("/gazebo/reset_world")
        assert sim.joint("arm::hinge").position == 0.0


def test_a_model_of_ros_1_is_spawned_into_its_namespace() -> None:
    own = "<robotNamespace>/old</robotNamespace>"
    with load(API) as sim:
        request = {"model_name": "eye", "model_xml": RANGE.format(own), "robot_namespace": "right"}
        assert sim.call("/gazebo/spawn_sdf_model", request).success
        assert "/right/eye_plugin/out" in sim.topics()

"""Services and action of ROS 2's `simulation_interfaces`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from service_worlds import BOX_LINK, load, model

import simkit
from simkit import msgs

OPTION = "<simkit:entity_services>{}</simkit:entity_services>"
PLUGIN = '<plugin name="p" filename="libgazebo_ros_state.so"/>'
UNSUPPORTED, OK, NOT_FOUND, INCORRECT_STATE, FAILED = range(5)


def result_of(sim: simkit.Simulation, service: str, request: Any = None) -> int:
    return int(sim.call(service, request).result.result)


def spawning(name: str = "one", **fields: Any) -> dict[str, Any]:
    return {"name": name, "entity_resource": {"resource_string": model("one", "0 0 7 0 0 0")}, **fields}


# ---------------------------------------------------------------------- which type a world serves


@pytest.mark.parametrize(
    ("more", "package"),
    [
        ("", "simulation_interfaces"),
        (PLUGIN, "gazebo_msgs"),
        (OPTION.format("classic"), "gazebo_msgs"),
        (OPTION.format("standard") + PLUGIN, "simulation_interfaces"),
    ],
)
def test_the_world_says_which_services_have_the_names_of_both(more: str, package: str) -> None:
    with load(more) as sim:
        types = sim.communication.services.names()
        assert types["/spawn_entity"] == f"{package}/srv/SpawnEntity"
        assert types["/get_entities"] == "simulation_interfaces/srv/GetEntities"
        features = list(sim.call("/get_simulator_features").features.features)
        assert (0 in features) == (1 in features) == (package == "simulation_interfaces") and 33 in features
        # a request that fits only the other type goes to the other service
        assert sim.call("/spawn_entity", {"xml": model("two"), "name": "two"}).success
        assert result_of(sim, "/spawn_entity", spawning()) == OK
        assert {"one", "two"} <= set(sim.models)


def test_an_unknown_value_of_the_option_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="<entity_services>classik</entity_services>; expected one of auto"):
        load(OPTION.format("classik"))


# ---------------------------------------------------------------------- entities


def test_a_model_is_spawned_at_the_pose_renamed_and_deleted() -> None:
    with load() as sim:
        pose = {"header": {"frame_id": "arm"}, "pose": {"position": {"x": 2.0}}}
        assert sim.call("/spawn_entity", spawning(initial_pose=pose)).entity_name == "one"
        assert sim.model("one").pose.position.tolist() == [2.0, 5.0, 1.0]
        assert result_of(sim, "/spawn_entity", spawning()) == 101
        assert sim.call("/spawn_entity", spawning(allow_renaming=True)).entity_name == "one_1"
        assert sim.call("/spawn_entity", spawning("")).result.result == 101  # the name in the text is taken
        assert result_of(sim, "/delete_entity", {"entity": "one"}) == OK
        assert result_of(sim, "/delete_entity", {"entity": "one"}) == NOT_FOUND
        assert result_of(sim, "/delete_entity", {"entity": "sun"}) == FAILED
        assert "one" not in sim.models and "one_1" in sim.models


@pytest.mark.parametrize(
    ("fields", "code"),
    [
        ({"name": "a::b"}, 102),
        ({"entity_resource": {"uri": "box.usd"}}, 103),
        ({"entity_resource": {"resource_string": "box.sdf"}}, 103),
        ({"entity_resource": {}}, 104),
        ({"entity_resource": {"uri": "missing.sdf"}}, 104),
        ({"entity_resource": {"uri": "model://missing"}}, 104),
        ({"entity_resource": {"uri": "file:///missing.sdf"}}, 104),
        ({"entity_namespace": "a b"}, 105),
        ({"entity_resource": {"resource_string": "<sdf"}}, 106),
        ({"initial_pose": {"header": {"frame_id": "nowhere"}}}, 109),
        ({"initial_pose": {"pose": {"position": {"x": float("nan")}}}}, 109),
        ({"initial_pose": {"pose": {"position": {"x": -2e10}}}}, 109),
        ({"initial_pose": {"pose": {"orientation": {"w": float("inf")}}}}, 109),
        ({"initial_pose": {"pose": {"orientation": {"z": 0.2}}}}, 109),
        ({"initial_pose": {"pose": {"orientation": {"w": 0.0}}}}, 109),
    ],
)
def test_a_model_that_cannot_be_spawned_has_the_published_code(fields: dict[str, Any], code: int) -> None:
    with load() as sim:
        before = list(sim.models)
        answer = sim.call("/spawn_entity", {**spawning(), **fields})
        assert answer.result.result == code and answer.result.error_message and list(sim.models) == before


def test_states_are_set_and_read_in_the_frame_of_the_header() -> None:
    with load() as sim:
        state = {"header": {"frame_id": "arm"}, "pose": {"position": {"z": 3.0}}, "twist": {"linear": {"x": 2.0}}}
        request = {"entity": "box", "state": state, "set_pose": True, "set_twist": True}
        assert result_of(sim, "/set_entity_state", request) == OK
        found = sim.call("/get_entity_state", {"entity": "box"}).state
        assert (found.pose.position.y, found.pose.position.z, found.twist.linear.x) == (5.0, 4.0, 2.0)
        assert found.header.frame_id == "world"
        pose_only = {"entity": "box", "state": {}, "set_pose": True}
        assert result_of(sim, "/set_entity_state", pose_only) == OK
        assert sim.model("box").pose.position.tolist() == [0.0, 0.0, 0.0]
        assert result_of(sim, "/set_entity_state", {"entity": "box", "set_acceleration": True}) == UNSUPPORTED
        still = {"entity": "ground", "set_twist": True}
        assert result_of(sim, "/set_entity_state", still) == OK
        moving = {"state": {"twist": {"linear": {"x": 1.0}}}}
        assert result_of(sim, "/set_entity_state", {**still, **moving}) == FAILED
        assert result_of(sim, "/get_entity_state", {"entity": "bax"}) == NOT_FOUND


def test_entities_are_selected_by_name_category_and_bounds() -> None:
    with load() as sim:

        def names(**filters: Any) -> list[str]:
            return list(sim.call("/get_entities", {"filters": filters}).entities)

        assert names() == ["ground", "box", "arm"] and names(filter="^.o") == ["box"]
        assert names(categories=[{"category": 5}]) == ["ground"]
        assert names(categories=[{"category": 4}, {"category": 2}]) == ["box", "arm"] and not names(categories=[{}])
        corners = [{"x": 0.4, "y": 0.0, "z": 0.9}, {"x": 3.0, "y": 1.0, "z": 2.0}]
        assert names(bounds={"type": 1, "points": corners}) == ["ground", "box"]
        sphere = [{"x": 2.0, "z": 0.5}, {"x": 1.4}]
        assert names(filter="b", bounds={"type": 3, "points": sphere}) == []
        sphere[1] = {"x": 1.6}
        assert names(filter="b", bounds={"type": 3, "points": sphere}) == ["box"]
        assert result_of(sim, "/get_entities", {"filters": {"filter": "("}}) == FAILED
        assert result_of(sim, "/get_entities", {"filters": {"tags": {"tags": ["a"]}}}) == UNSUPPORTED
        states = sim.call("/get_entities_states", {"filters": {"filter": "box"}})
        assert states.entities == ["box"] and states.states[0].pose.position.z == 0.5


@pytest.mark.parametrize(
    "state",
    [
        {"header": {"frame_id": "nowhere"}},
        {"pose": {"position": {"y": float("nan")}}},
        {"pose": {"position": {"y": 1e300}}},
        {"pose": {"orientation": {"x": 1.0}}},
        {"pose": {"orientation": {"w": 0.0}}},
    ],
)
def test_an_invalid_pose_of_a_state_has_its_code_and_is_ignored_if_it_is_not_set(state: dict[str, Any]) -> None:
    with load() as sim:
        request = {"entity": "box", "state": state, "set_pose": True, "set_twist": True}
        invalid = msgs.simulation_interfaces__srv__SetEntityState_Response.INVALID_POSE
        assert result_of(sim, "/set_entity_state", request) == invalid == 101
        assert sim.model("box").pose.position[2] == 0.5
        if "pose" in state:
            assert result_of(sim, "/set_entity_state", {**request, "set_pose": False}) == OK


@pytest.mark.needs_packs
def test_a_robot_a_person_and_objects_have_their_published_categories() -> None:
    person = """<actor name="person"><pose>0 3 0 0 0 0</pose><skin><filename>walk.dae</filename></skin></actor>"""
    robot = f'<model name="robot"><pose>0 -5 1 0 0 0</pose>{BOX_LINK}{PLUGIN}</model>'
    with load(person + robot) as sim:
        found = {
            name: sim.call("/get_entity_info", {"entity": name}).info.category.category
            for name in ("robot", "person", "box", "ground")
        }
    category = msgs.EntityCategory
    assert found == {
        "robot": category.CATEGORY_ROBOT,
        "person": category.CATEGORY_HUMAN,
        "box": category.CATEGORY_DYNAMIC_OBJECT,
        "ground": category.CATEGORY_STATIC_OBJECT,
    }
    assert found["robot"] == 1 and found["person"] == 2


# ---------------------------------------------------------------------- several entities


def placed(name: str, x: float = 0.0, frame: str = "", **fields: Any) -> dict[str, Any]:
    pose = {"header": {"frame_id": frame}, "pose": {"position": {"x": x, "z": 7.0}}}
    return spawning(name, initial_pose=pose, **fields)


def test_several_models_are_spawned_with_one_compilation_of_the_world(monkeypatch: pytest.MonkeyPatch) -> None:
    with load() as sim:
        assert msgs.SimulatorFeatures.SPAWNING_ENTITIES == 50
        assert 50 in sim.call("/get_simulator_features").features.features
        groups: list[int] = []
        spawn = sim.contents.spawner.spawn
        monkeypatch.setattr(sim.contents.spawner, "spawn", lambda wanted: groups.append(len(wanted)) or spawn(wanted))
        requests = [placed("a", 1.0), placed("b", 2.0, "arm"), placed("a", 3.0, allow_renaming=True), placed("", 4.0)]
        answer = sim.call("/spawn_entities", {"spawn_requests": requests})
        assert answer.result.result == OK and groups == [4]
        assert [found.entity_name for found in answer.results] == ["a", "b", "a_1", "one"]
        assert {found.result.result for found in answer.results} == {OK}
        assert [sim.model(name).pose.position[0] for name in ("a", "b", "a_1", "one")] == [1.0, 2.0, 3.0, 4.0]
        assert sim.call("/spawn_entities").result.result == OK


def test_models_are_spawned_beside_requests_that_fail() -> None:
    with load() as sim:
        requests = [
            placed("a"),
            placed("a"),  # its name is taken by the request before
            {**placed("b"), "entity_resource": {"resource_string": "<sdf"}},
            placed("c", 1.0, "a"),  # relative to the first model
            placed("d", 1.0, "b"),  # relative to a model that was not spawned
            {**placed("e"), "entity_resource": {"resource_string": model("e").replace("<size>1", "<size>x", 1)}},
            placed("f"),
        ]
        answer = sim.call("/spawn_entities", {"spawn_requests": requests})
        assert (
            answer.result.result == msgs.simulation_interfaces__srv__SpawnEntities_Response.ENTITIES_SPAWN_FAILED == 150
        )
        assert answer.result.error_message == "4 of 7 requests failed: 1, 2, 4, 5"
        assert [found.result.result for found in answer.results] == [OK, 101, 106, OK, 109, 106, OK]
        assert [found.entity_name for found in answer.results] == ["a", "", "", "c", "", "", "f"]
        assert all(found.result.error_message for found in answer.results if found.result.result != OK)
        assert sim.model("c").pose.position.tolist() == [1.0, 0.0, 14.0]
        assert list(sim.models)[-3:] == ["a", "c", "f"]


def test_a_plugin_that_fails_refuses_only_its_own_model_of_a_list() -> None:
    broken = model("broken").replace("</model>", '<plugin name="p" filename="libgazebo_ros_diff_drive.so"/></model>')
    with load() as sim:
        requests = [placed("a"), {**placed("broken"), "entity_resource": {"resource_string": broken}}, placed("b")]
        answer = sim.call("/spawn_entities", {"spawn_requests": requests})
        assert answer.result.result == 150 and answer.results[1].result.error_message
        assert [found.result.result == OK for found in answer.results] == [True, False, True]
        assert {"a", "b"} <= set(sim.models) and "broken" not in sim.models


def test_bounds_are_in_the_frame_of_the_entity() -> None:
    with load() as sim:
        sim.model("box").set_pose(simkit.Pose.from_rpy(3, 4, 5, 0, 0, 1))
        bounds = sim.call("/get_entity_bounds", {"entity": "box"}).bounds
        assert bounds.type == 1
        upper, lower = ([p.x, p.y, p.z] for p in bounds.points)
        assert upper == pytest.approx([0.5] * 3) and lower == pytest.approx([-0.5] * 3)
        assert sim.call("/get_entity_bounds", {"entity": "arm"}).bounds.type == 0
        assert result_of(sim, "/get_entity_bounds", {"entity": "ground"}) == FAILED


# ---------------------------------------------------------------------- time


def test_states_of_the_simulation_and_steps() -> None:
    with load() as sim:

        def change(state: int) -> int:
            return result_of(sim, "/set_simulation_state", {"state": {"state": state}})

        def state() -> int:
            return int(sim.call("/get_simulation_state").state.state)

        assert state() == 1 and change(1) == 101 and result_of(sim, "/step_simulation", {"steps": 1}) == INCORRECT_STATE
        assert change(2) == OK and state() == 2
        assert result_of(sim, "/step_simulation", {"steps": 4}) == OK and sim.tick == 4
        assert result_of(sim, "/step_simulation", {"steps": 0}) == FAILED
        assert result_of(sim, "/step_simulation") == OK and sim.tick == 5  # the published default is one step
        assert result_of(sim, "/step_simulation", {"steps": 2**63}) == FAILED and sim.tick == 5
        assert change(0) == OK and state() == 0 and sim.tick == 0 and sim.paused
        assert change(3) == 103 and change(1) == OK and state() == 1


def test_steps_of_the_action_are_reported_and_need_a_pause() -> None:
    with load() as sim:
        refused = sim.send_goal("/simulate_steps", {"steps": 3})
        assert refused.status.name == "ABORTED" and refused.result.result.result == INCORRECT_STATE
        sim.paused = True
        seen: list[tuple[int, int]] = []
        goal = sim.send_goal(
            "/simulate_steps", {"steps": 250}, lambda m: seen.append((m.completed_steps, m.remaining_steps))
        )
        assert goal.status.name == "SUCCEEDED" and goal.result.result.result == OK
        assert sim.tick == 250 and sim.paused and seen[0] == (2, 248) and seen[-1] == (250, 0) and len(seen) == 125


def test_a_pause_or_a_cancellation_ends_the_steps_of_a_served_run() -> None:
    with load() as sim, sim.control.pausing.served():
        sim.paused = True
        first = sim.send_goal("/simulate_steps", {"steps": 100})
        sim.control.pausing.advance(10)
        sim.paused = True
        assert first.status.name == "ABORTED" and "paused" in first.reason and sim.tick == 10
        second = sim.send_goal("/simulate_steps", {"steps": 100})
        sim.control.pausing.advance(10)
        second.cancel()
        sim.control.pausing.advance(10)
        assert second.status.name == "CANCELED" and sim.paused and 20 <= sim.tick <= 21


def test_a_second_goal_does_not_disturb_the_steps_of_the_first() -> None:
    with load() as sim, sim.control.pausing.served():
        sim.paused = True
        first = sim.send_goal("/simulate_steps", {"steps": 30})
        sim.control.pausing.advance(10)
        second = sim.send_goal("/simulate_steps", {"steps": 50})
        sim.control.pausing.advance(100)
        assert second.status.name == "ABORTED" and second.result.result.result == INCORRECT_STATE
        assert first.status.name == "SUCCEEDED" and sim.tick == 30


@pytest.mark.parametrize("pattern", ["(a+)+b", "a*a*a*a*b", "(?:a|a)*b", "(?:a|aa)" * 24 + "b", "[" * 100_000])
def test_a_filter_that_may_take_minutes_is_refused(pattern: str) -> None:
    with load() as sim:
        assert result_of(sim, "/get_entities", {"filters": {"filter": pattern}}) == FAILED
        assert result_of(sim, "/get_entities", {"filters": {"filter": r"^(?:box|a[+*()]|ar\+m)[a-z]*$"}}) == OK


def test_a_reset_has_scopes() -> None:
    with load() as sim:

        def reset(scope: int) -> int:
            return result_of(sim, "/reset_simulation", {"scope": scope})

        sim.call("/spawn_entity", spawning())
        sim.model("box").set_pose(simkit.Pose((9, 9, 9)))
        sim.step(5)
        assert reset(4) == OK and "one" not in sim.models and sim.model("box").pose.position[0] == 9
        assert reset(2) == OK and sim.model("box").pose.position[0] == 0 and sim.tick == 5
        assert reset(1) == reset(8) == UNSUPPORTED and sim.tick == 5
        assert reset(0) == OK and sim.tick == 0


def test_a_listed_model_can_be_spawned() -> None:
    with load() as sim:
        listed = {found.description: found.entity_resource.uri for found in sim.call("/get_spawnables").spawnables}
        assert "tiago" in listed
        request = {"name": "robot", "entity_resource": {"uri": listed["tiago"]}}
        assert result_of(sim, "/spawn_entity", request) == OK and "robot" in sim.models
        other = sim.call("/get_spawnables", {"sources": ["https://example.org"]})
        assert other.result.result == OK and "https://example.org" in other.result.error_message
        assert len(other.spawnables) == len(listed)


def test_a_model_is_spawned_from_a_uri(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # the folder of a world that is text
    file = tmp_path / "a box.sdf"
    file.write_text(model("one"), encoding="utf-8")
    with load() as sim:
        for uri in ("model://turtlebot3_world", "model://ground_plane", file.as_uri()):
            request = {"name": "new", "entity_resource": {"uri": uri}}
            assert result_of(sim, "/spawn_entity", request) == OK and "new" in sim.models
            assert result_of(sim, "/delete_entity", {"entity": "new"}) == OK


@pytest.mark.parametrize("service", ["get_named_poses", "load_world", "get_available_worlds"])
def test_a_service_without_a_function_says_so(service: str) -> None:
    with load() as sim:
        answer = sim.call(f"/{service}")
        assert answer.result.result == UNSUPPORTED and answer.result.error_message

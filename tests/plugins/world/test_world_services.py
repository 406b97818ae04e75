"""Services that every world offers for its entities, as gz's UserCommands does."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from service_worlds import load, model

import simkit
from simkit import msgs
from simkit.plugins.world.service_entities import entity_id

HALF = {"z": math.sin(math.pi / 4), "w": math.cos(math.pi / 4)}  # a quarter turn about z
NAVSAT = """<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>47</latitude_deg>
<longitude_deg>8</longitude_deg><elevation>400</elevation></spherical_coordinates>
<model name="rover"><pose>30 0 0.5 0 0 0</pose><static>1</static><link name="l"><sensor name="gps" type="navsat">
<topic>/gps</topic></sensor></link></model>"""


def ask(sim: simkit.Simulation, name: str, **fields: Any) -> Any:
    return sim.call(f"/world/w/{name}", fields)


def create(sim: simkit.Simulation, **fields: Any) -> bool:
    return bool(ask(sim, "create", entity_factory=fields).success)


# ---------------------------------------------------------------------- create


def test_a_model_is_spawned_at_the_pose_of_the_request_or_else_of_its_file() -> None:
    with load() as sim:
        assert create(sim, sdf=model("one", "1 2 3 0 0 0"))
        assert create(sim, sdf=model("one"), name="two", pose={"position": {"x": 7}, "orientation": HALF})
        assert sim.model("one").pose.position == pytest.approx((1, 2, 3))
        assert sim.model("two").pose.position == pytest.approx((7, 0, 0))
        assert sim.model("two").pose.rpy == pytest.approx((0, 0, math.pi / 2))


def test_a_pose_may_be_relative_to_an_entity() -> None:
    with load() as sim:
        sim.model("box").set_pose(simkit.Pose.from_rpy(1, 0, 0.5, 0, 0, math.pi / 2))
        assert create(sim, sdf=model("one"), relative_to="box", pose={"position": {"x": 2}})
        assert sim.model("one").pose.position == pytest.approx((1, 2, 0.5))
        assert sim.model("one").pose.rpy == pytest.approx((0, 0, math.pi / 2))


def test_a_name_in_use_is_refused_unless_allow_renaming_is_set(caplog: pytest.LogCaptureFixture) -> None:
    with load() as sim:
        assert not create(sim, sdf=model("box"))
        assert not create(sim, sdf=model("one"), name="box")
        assert "a model 'box' already exists, and allow_renaming is false" in caplog.text
        assert create(sim, sdf=model("box", "5 0 0 0 0 0"), allow_renaming=True)
        assert create(sim, sdf=model("box", "8 0 0 0 0 0"), allow_renaming=True)
        assert list(sim.models)[-2:] == ["box_0", "box_1"]  # gz's numbers


def test_a_file_is_spawned_by_its_file_name(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # the folder of a world that is text
    (tmp_path / "one.sdf").write_text(model("one", "0 0 4 0 0 0"))
    with load() as sim:
        assert create(sim, sdf_filename=str(tmp_path / "one.sdf"))
        assert sim.model("one").pose.position[2] == 4.0
        assert not create(sim, sdf_filename=str(tmp_path / "none.sdf"))


def test_a_clone_has_the_entities_and_the_motion_of_the_original() -> None:
    with load() as sim:
        assert create(sim, clone_name="arm", name="other", pose={"position": {"x": 9, "z": 1}, "orientation": HALF})
        other, arm = sim.model("other"), sim.model("arm")
        assert list(other.joints) == ["fix", "hinge"]
        assert other.pose.position == pytest.approx((9, 0, 1))
        assert sim.link("other::tip").pose.position == pytest.approx((9, 1, 1))  # 1 m along its own x, which is y
        assert sim.joint("other::hinge").upper == 1.0
        for joint in (sim.joint("arm::hinge"), sim.joint("other::hinge")):
            joint.set_velocity(2.0)
        sim.run(0.2)
        assert sim.joint("other::hinge").position == pytest.approx(sim.joint("arm::hinge").position, abs=1e-9)
        assert arm.pose.position == pytest.approx((0, 5, 1))
        sim.remove("other")
        sim.reset()
        assert "other" not in sim.models


def test_a_clone_of_an_unknown_model_suggests_the_closest_name(caplog: pytest.LogCaptureFixture) -> None:
    with load() as sim:
        assert not create(sim, clone_name="bux")
        assert "there is no model 'bux'; did you mean 'box'?" in caplog.text


def test_a_request_must_have_exactly_one_source(caplog: pytest.LogCaptureFixture) -> None:
    with load() as sim:
        assert not create(sim, name="one")
        assert not create(sim, sdf=model("one"), clone_name="box")
        assert "found none of sdf, sdf_filename and clone_name; expected one" in caplog.text
        assert "found sdf and clone_name of" in caplog.text


def test_several_models_are_spawned_or_none() -> None:
    with load() as sim:
        both = [{"sdf": model("one", "4 0 0 0 0 0")}, {"sdf": model("two", "8 0 0 0 0 0")}]
        assert ask(sim, "create_multiple", entity_factories=both).success
        assert list(sim.models)[-2:] == ["one", "two"]
        some = [{"sdf": model("three", "4 4 0 0 0 0")}, {"sdf": "<sdf version='1.9'><modle/></sdf>"}]
        response = ask(sim, "create_multiple", entity_factories=some)
        assert not response.success
        assert "did you mean 'model'?" in response.status_message
        assert "three" not in sim.models


# ---------------------------------------------------------------------- remove, set_pose


def test_a_model_is_removed_by_its_name_or_its_id(caplog: pytest.LogCaptureFixture) -> None:
    with load() as sim:
        assert ask(sim, "remove", entity={"name": "box", "type": 2}).success
        assert ask(sim, "remove", entity={"id": entity_id("model", "arm")}).success
        assert list(sim.models) == ["ground"]
        assert not ask(sim, "remove", entity={"name": "grund"}).success
        assert "did you mean 'ground'?" in caplog.text


@pytest.mark.parametrize(
    ("entity", "why"),
    [
        ({"name": "sun"}, "the light 'sun' cannot be removed"),
        ({"name": "box::body", "type": 3}, "found an entity of type link; expected model or light"),
        ({}, "neither a name nor an id"),
        ({"id": 5}, "no model or light with the id 5"),
    ],
)
def test_an_entity_that_cannot_be_removed_is_refused(
    entity: dict[str, Any], why: str, caplog: pytest.LogCaptureFixture
) -> None:
    with load() as sim:
        assert not ask(sim, "remove", entity=entity).success
        assert why in caplog.text


def test_poses_of_models_static_models_and_lights_are_set() -> None:
    with load() as sim:
        for name in ("box", "ground", "lamp"):
            assert ask(sim, "set_pose", entity={"name": name}, pose={"position": {"x": 3, "z": 2}}).success
        assert sim.model("box").pose.position == pytest.approx((3, 0, 2))
        assert sim.model("ground").pose.position == pytest.approx((3, 0, 2))
        assert sim.light("lamp").pose.position == pytest.approx((3, 0, 2))


def test_a_rotation_is_normalised_and_zeros_are_the_identity() -> None:
    with load() as sim:
        ask(sim, "set_pose", entity={"name": "box"}, pose={"orientation": {"z": 3.0, "w": 3.0}})
        assert sim.model("box").pose.rpy == pytest.approx((0, 0, math.pi / 2))
        ask(sim, "set_pose", entity={"name": "box"}, pose={"orientation": {"w": 0.0}})
        assert sim.model("box").pose.rpy == pytest.approx((0, 0, 0))


def test_nan_and_infinite_numbers_are_refused(caplog: pytest.LogCaptureFixture) -> None:
    with load() as sim:
        assert not ask(sim, "set_pose", entity={"name": "box"}, pose={"position": {"x": math.nan}}).success
        assert "found pose.position.x nan; expected a finite number" in caplog.text
        assert sim.model("box").pose.position == pytest.approx((0, 0, 0.5))


def test_several_poses_are_set_or_none() -> None:
    with load() as sim:
        entities, poses = [{"name": "box"}, {"name": "arm"}], [{"position": {"z": 4}}, {"position": {"z": 5}}]
        assert ask(sim, "set_pose_vector", entities=entities, poses=poses).success
        assert (sim.model("box").pose.position[2], sim.model("arm").pose.position[2]) == (4, 5)
        response = ask(sim, "set_pose_vector", entities=[{"name": "box"}, {"name": "arn"}], poses=poses[::-1])
        assert "did you mean 'arm'?" in response.status_message
        assert sim.model("box").pose.position[2] == 4
        response = ask(sim, "set_pose_vector", entities=entities, poses=poses[:1])
        assert response.status_message == "found 2 entities and 1 pose; expected one pose per entity"


def test_every_service_except_control_has_a_blocking_variant() -> None:
    with load() as sim:
        assert ask(sim, "set_pose/blocking", entity={"name": "box"}, pose={"position": {"z": 2}}).success
        assert sim.model("box").pose.position[2] == 2


# ---------------------------------------------------------------------- physics


def test_gravity_and_pace_are_set() -> None:
    with load() as sim:
        assert ask(sim, "set_physics", time_step=0.001, gravity={"z": -1.6}, max_update_rate=500.0).success
        sim.model("box").set_pose(simkit.Pose((0, 0, 50)))
        sim.run(1.0)
        assert sim.link("box::body").linear_velocity[2] == pytest.approx(-1.6, rel=1e-6)
        assert sim.control.pausing.pace == 0.5  # 500 steps of 1 ms in a second
        assert ask(sim, "set_physics").success  # says nothing of gravity
        assert sim.gravity[2] == -1.6
        assert sim.control.pausing.pace is None


def test_a_different_step_length_is_refused_without_any_change() -> None:
    with load() as sim:
        response = ask(sim, "set_physics", time_step=0.002, gravity={"z": -1.6})
        assert not response.success
        assert "found time_step 0.002, it is 0.001 and cannot change while a world runs" in response.status_message
        assert "--set physics.max_step_size" in response.status_message
        assert sim.gravity[2] == -10.0


def test_unsupported_physics_settings_are_listed() -> None:
    with load() as sim:
        response = ask(sim, "set_physics", ode_config={"cfm": 0.1, "sor_pgs_iters": 50})
        assert response.success
        assert response.status_message == "not supported by this physics engine: sor_pgs_iters, cfm"


# ---------------------------------------------------------------------- looks


def test_a_light_changes_the_fields_of_the_request_and_keeps_the_others() -> None:
    with load() as sim:
        before = sim.light("lamp").scene
        assert ask(sim, "light_config", light={"name": "lamp", "diffuse": {"r": 0.25, "a": 1.0}}).success
        after = sim.light("lamp").scene
        assert (after.diffuse, after.attenuation, after.spot) == ((0.25, 0, 0, 1), before.attenuation, before.spot)
        index = list(sim.contents.lights).index("lamp")
        assert sim.mj_model.light_diffuse[index] == pytest.approx((0.25, 0, 0))
        wanted = {"name": "lamp", "type": 1, "intensity": 2.0, "range": 7.0, "attenuation_constant": 1.0}
        assert ask(
            sim, "light_config", light={**wanted, "direction": {"x": 2.0}, "pose": {"position": {"z": 9}}}
        ).success
        assert sim.mj_model.light_diffuse[index] == pytest.approx((0.5, 0, 0))
        assert (sim.mj_model.light_range[index], sim.light("lamp").pose.position[2]) == (7.0, 9.0)
        assert sim.mj_model.light_attenuation[index] == pytest.approx((1, 0, 0))
        assert sim.light("lamp").direction == pytest.approx((1, 0, 0))
        assert sim.mj_model.light_dir[index] == pytest.approx((1, 0, 0))


def test_snapshot_reset_and_spawn_handle_a_changed_light() -> None:
    with load() as sim:
        index = list(sim.contents.lights).index("lamp")
        ask(sim, "light_config", light={"name": "lamp", "diffuse": {"g": 0.75, "a": 1.0}})
        snapshot = sim.snapshot()
        sim.spawn(model("one", "5 5 5 0 0 0"))
        assert sim.mj_model.light_diffuse[index] == pytest.approx((0, 0.75, 0))
        sim.reset()
        assert sim.light("lamp").scene.diffuse == (1, 1, 1, 1)
        assert sim.mj_model.light_diffuse[index] == pytest.approx((1, 1, 1))
        sim.restore(snapshot)
        assert sim.light("lamp").scene.diffuse == (0, 0.75, 0, 1)
        assert sim.mj_model.light_diffuse[index] == pytest.approx((0, 0.75, 0))


def test_a_light_is_changed_by_topic_as_well() -> None:
    with load() as sim:
        sim.publish("/world/w/light_config", {"name": "sun", "diffuse": {"b": 1.0, "a": 1.0}})
        sim.step()
        assert sim.light("sun").scene.diffuse == (0, 0, 1, 1)


def test_a_light_keeps_its_type(caplog: pytest.LogCaptureFixture) -> None:
    with load() as sim:
        response = ask(sim, "light_config", light={"name": "lamp", "type": 2})
        assert response.status_message == "light 'lamp' is a spot light and cannot become a directional light"


def colours(sim: simkit.Simulation, visual: str) -> list[float]:
    return [float(c) for c in sim.mj_model.geom_rgba[sim.visual(visual).geoms[0]]]


def test_one_visual_all_of_a_model_or_all_of_a_name_are_painted() -> None:
    with load() as sim:
        create(sim, clone_name="box", name="other", pose={"position": {"x": 5}})
        red, green = {"r": 1.0, "a": 1.0}, {"g": 1.0, "a": 0.5}
        assert ask(sim, "visual_config", material_color={"entity": {"name": "box"}, "diffuse": red}).success
        assert colours(sim, "box::body::skin") == [1, 0, 0, 1]
        assert colours(sim, "other::body::skin") != [1, 0, 0, 1]
        every = {"entity": {"name": "skin", "type": 4}, "diffuse": green, "entity_match": 1}
        sim.publish("/world/w/material_color", every)
        sim.step()
        assert colours(sim, "box::body::skin") == colours(sim, "other::body::skin") == [0, 1, 0, 0.5]
        sim.reset()
        assert colours(sim, "box::body::skin") != [0, 1, 0, 0.5]


def test_ignored_colours_are_reported() -> None:
    with load() as sim:
        asked = {"entity": {"name": "box"}, "diffuse": {"r": 1.0, "a": 1.0}, "emissive": {"r": 1.0}, "shininess": 3.0}
        response = ask(sim, "visual_config", material_color=asked)
        assert (
            response.status_message
            == "the diffuse colour is set; emissive and shininess cannot be set and did not change"
        )
        assert not ask(sim, "visual_config", material_color={"entity": {"name": "box"}}).success


# ---------------------------------------------------------------------- collisions


@pytest.mark.parametrize("entity", [{"name": "box"}, {"name": "box::body"}, {"name": "box::body::hull", "type": 5}])
def test_a_model_with_disabled_collisions_falls_through_the_ground(entity: dict[str, Any]) -> None:
    with load() as sim:
        sim.run(0.1)
        assert ask(sim, "disable_collision", entity=entity).success
        sim.run(0.2)
        # free fall of 0.2 s from where it stood
        assert sim.model("box").pose.position[2] == pytest.approx(0.5 - 0.5 * 10 * 0.04, abs=5e-3)
        sim.reset()
        ask(sim, "disable_collision", entity=entity)
        assert ask(sim, "enable_collision", entity=entity).success
        sim.run(0.2)
        assert sim.model("box").pose.position[2] == pytest.approx(0.5, abs=1e-3)


def test_a_single_collision_of_two_is_disabled() -> None:
    feet = "".join(
        f'<collision name="{name}"><pose>0 0 {z} 0 0 0</pose><geometry><sphere><radius>0.1</radius></sphere></geometry>'
        "</collision>"
        for name, z in (("low", -1.0), ("high", 0.0))
    )
    stand = f'<model name="stand"><pose>8 0 1.1 0 0 0</pose><link name="l">{feet}</link></model>'
    with load(stand) as sim:
        sim.run(0.1)
        assert sim.model("stand").pose.position[2] == pytest.approx(1.1, abs=2e-3)
        assert ask(sim, "disable_collision", entity={"name": "stand::l::low"}).success
        assert sim.link("stand::l").collisions_enabled  # the other one
        sim.run(1.0)
        assert sim.model("stand").pose.position[2] == pytest.approx(0.1, abs=5e-3)


# ---------------------------------------------------------------------- the place on Earth


def test_the_worlds_origin_moves_and_gps_receivers_follow() -> None:
    with load(NAVSAT) as sim:
        gps = sim.subscribe("/gps")
        sim.step()
        assert gps.latest.latitude == pytest.approx(47.0, abs=1e-9)
        assert ask(sim, "set_spherical_coordinates", latitude_deg=-33.5, longitude_deg=151.0, elevation=10.0).success
        sim.step()
        assert (gps.latest.latitude, gps.latest.altitude) == (
            pytest.approx(-33.5, abs=1e-8),
            pytest.approx(10.5, abs=1e-3),
        )
        snapshot = sim.snapshot()
        sim.reset()
        sim.step()
        assert gps.latest.latitude == pytest.approx(47.0, abs=1e-9)
        sim.restore(snapshot)
        sim.step()
        assert gps.latest.latitude == pytest.approx(-33.5, abs=1e-8)


def test_a_world_without_a_location_gets_one() -> None:
    with load(NAVSAT[NAVSAT.index("<model") :]) as sim:
        gps = sim.subscribe("/gps")
        sim.step()
        assert gps.latest is None
        ask(sim, "set_spherical_coordinates", latitude_deg=10.0)
        sim.step()
        assert gps.latest.latitude == pytest.approx(10.0, abs=1e-9)


def test_an_entity_is_moved_to_a_geographic_location() -> None:
    with load(NAVSAT) as sim:
        where = {"latitude_deg": 47.0, "longitude_deg": 8.001, "elevation": 400.0, "heading_deg": 90.0}
        assert ask(sim, "set_spherical_coordinates", entity={"name": "box"}, **where).success
        pose = sim.model("box").pose
        # a thousandth of a degree of longitude at 47 degrees: N cos(47°) with N = a/sqrt(1 - e² sin²)
        radius = 6378137.0 / math.sqrt(1 - 0.00669437999014 * math.sin(math.radians(47)) ** 2)
        arc = math.radians(0.001) * (radius + 400) * math.cos(math.radians(47))
        assert pose.position == pytest.approx((arc, 0, 0), abs=2e-3)
        assert pose.rpy[2] == pytest.approx(math.pi / 2)


@pytest.mark.parametrize(
    ("fields", "why"),
    [
        ({"latitude_deg": 91.0}, "found latitude_deg 91; expected a number from -90 to 90"),
        ({"surface_model": 7}, "found surface_model 7; expected 0 (EARTH_WGS84) or 1 (MOON_SCS)"),
        ({"entity": {"name": "box"}}, "the world has no <spherical_coordinates>"),
    ],
)
def test_invalid_locations_are_refused(fields: dict[str, Any], why: str) -> None:
    with load() as sim:
        response = ask(sim, "set_spherical_coordinates", **fields)
        assert not response.success
        assert why in response.status_message


# ---------------------------------------------------------------------- what is there


def test_scene_info_has_every_entity_with_its_id_and_its_current_pose() -> None:
    with load() as sim:
        sim.joint("arm::hinge").set_position(math.pi / 6)
        scene = ask(sim, "scene/info")
        found = {e.entity.name: e for e in scene.entities}
        assert scene.name == "w"
        assert {"sun", "lamp", "box", "box::body", "box::body::hull", "box::body::skin", "arm::hinge"} <= set(found)
        tip = found["arm::tip"]
        assert (tip.entity.type, tip.parent, tip.is_static) == (3, "arm", False)
        assert tip.entity.id == entity_id("link", "arm::tip")
        assert (tip.pose.orientation.z, tip.pose.orientation.w) == pytest.approx(
            (math.sin(math.pi / 12), math.cos(math.pi / 12))
        )
        assert found["box"].parent == "w"
        assert found["ground::plane"].is_static
        assert len({e.entity.id for e in scene.entities}) == len(scene.entities)


def test_the_generated_sdf_has_the_current_state_and_can_be_loaded() -> None:
    with load() as sim:
        sim.remove("arm")
        create(sim, clone_name="box", name="other", pose={"position": {"x": 6, "z": 2}, "orientation": HALF})
        sim.model("box").set_pose(simkit.Pose((1, 2, 3)))
        sim.light("lamp").set_pose(simkit.Pose((0, 0, 8)))
        sim.gravity = (0, 0, -3)
        response = ask(sim, "generate_world_sdf")
        assert response.success
        with simkit.load(response.sdf) as again:
            assert list(again.models) == ["ground", "box", "other"]
            assert again.model("box").pose.position == pytest.approx((1, 2, 3))
            assert again.model("other").pose.rpy == pytest.approx((0, 0, math.pi / 2))
            assert again.light("lamp").pose.position == pytest.approx((0, 0, 8))
            assert again.gravity == pytest.approx((0, 0, -3))
            assert again.link("other::body").mass == 2.0


def test_a_plugin_may_replace_a_service_of_the_world() -> None:
    with load() as sim:
        sim.offer("/world/w/create", "std_srvs/srv/Trigger", lambda _: {"message": "mine"})
        assert sim.call("/world/w/create").message == "mine"
        assert sim.communication.services.names()["/world/w/create"] == "std_srvs/srv/Trigger"


def test_responses_have_the_declared_types() -> None:
    with load() as sim:
        response = ask(sim, "create", entity_factory={"sdf": model("one", "4 0 0 0 0 0")})
        assert msgs.type_name(response) == "ros_gz_interfaces/srv/SpawnEntity_Response"
        assert msgs.serialize(response) == b"\x00\x01\x00\x00\x01"


def test_a_call_from_a_hook_takes_effect_at_once() -> None:
    class Spawner(simkit.WorldPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            self.after_step_rate = 100.0

        def after_step(self) -> None:
            if self.sim.tick == 10:
                assert create(self.sim, sdf=model("one", "4 0 0.5 0 0 0"))
                assert "one" in self.sim.models

    with load(plugins=[Spawner()]) as sim:
        sim.run(0.05)
        assert sim.model("one").pose.position == pytest.approx((4, 0, 0.5), abs=1e-3)


def test_a_rotation_of_huge_or_tiny_numbers_is_valid() -> None:
    with load() as sim:
        for w, z in ((1e308, 1e308), (1e-300, 1e-300), (5e-324, 5e-324)):
            request = {"entity": {"name": "box"}, "pose": {"orientation": {"w": w, "z": z}}}
            assert sim.call("/world/w/set_pose", request).success
            assert np.allclose(sim.model("box").pose.rpy, (0.0, 0.0, math.pi / 2))


def test_a_model_whose_plugin_raises_is_not_spawned_and_the_run_continues(tmp_path: Path) -> None:
    lines = (
        "import simkit",
        "class Bad(simkit.ModelPlugin):",
        "    def load(self, parent, params):",
        "        raise ValueError('no')",
    )
    (tmp_path / "bad.py").write_text("\n".join(lines))
    bad = model("bad").replace("</model>", '<plugin name="bad" filename="bad.py"/></model>')
    with load(plugin_paths=[tmp_path]) as sim:
        there = list(sim.models)
        assert not sim.call("/world/w/create", {"entity_factory": {"sdf": bad}}).success
        answer = sim.call("/spawn_entity", {"xml": bad})
        assert not answer.success
        assert "plugin 'bad'" in answer.status_message and "ValueError('no')" in answer.status_message
        several = {"entity_factories": [{"sdf": model("good")}, {"sdf": bad}]}
        assert "plugin 'bad'" in sim.call("/world/w/create_multiple", several).status_message
        assert list(sim.models) == there
        sim.step()


@pytest.mark.parametrize("name", ["a::b", "", " ", "world", "__model__"])
def test_invalid_model_names_are_refused(name: str) -> None:
    with load() as sim:
        for add in (lambda: sim.spawn(model("z"), name=name), lambda: sim.contents.clone("box", name)):
            with pytest.raises(simkit.InputError, match="name"):
                add()
        if name.strip():  # in a message an empty one is none
            assert "name" in sim.call("/spawn_entity", {"xml": model("z"), "name": name}).status_message
        assert list(sim.models) == ["ground", "box", "arm"]


def test_a_failed_spawn_of_several_models_does_not_change_the_state() -> None:
    def run(asks: bool) -> bytes:
        with load() as sim:
            sim.run(0.5)  # the box rests
            if asks:
                factories = [{"sdf": model("good")}, {"sdf": "<bad"}]
                assert not sim.call("/world/w/create_multiple", {"entity_factories": factories}).success
            sim.run(0.5)
            return bytes(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())

    assert run(False) == run(True)


def test_commands_after_a_failed_spawn_are_not_lost(tmp_path: Path) -> None:
    class Asks(simkit.WorldPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            self.taken: list[int] = []
            self.listen("number", "std_msgs/msg/Int32", self.take)

        def take(self, message: Any) -> None:
            self.taken.append(int(message.data))
            if message.data == 1:
                assert not self.sim.call("/spawn_entity", {"xml": bad}).success

    lines = ("import simkit", "class Bad(simkit.ModelPlugin):", "    def load(self, parent, params):", "        1 / 0")
    (tmp_path / "bad.py").write_text("\n".join(lines))
    bad = model("bad").replace("</model>", '<plugin name="bad" filename="bad.py"/></model>')
    asks = Asks()
    with load(plugins=[asks], plugin_paths=[tmp_path]) as sim:
        for number in range(4):
            sim.publish("/number", {"data": number})
        sim.step()
        assert asks.taken == [0, 1, 2, 3]

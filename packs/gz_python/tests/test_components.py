"""Components by name, of a simulation and of a manager made by hand."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit_gz_python.math import Pose3d, Vector3d
from simkit_gz_python.plugins.gz_system_plugin import GzSystem
from simkit_gz_python.sim import EntityComponentManager, components

WORLD = """<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="body"><pose>1 2 3 0 0 0</pose>
  <link name="link"><pose>0 0 1 0 0 0</pose></link></model></world></sdf>"""


def run(hook: Any, steps: int = 1) -> Any:
    class System:
        def pre_update(self, info: Any, ecm: EntityComponentManager) -> None:
            hook(info, ecm)

    with simkit.load(WORLD, plugins=[GzSystem(System())]) as sim:
        sim.step(steps)
        return sim.link("body::link").linear_velocity, sim.model("body").pose.position


# ---------------------------------------------------------------------- by hand


def test_a_component_has_a_name_and_a_number_and_can_be_a_key() -> None:
    assert components.Model.name == "Model" and repr(components.Model) == "<gz.sim.components.Model>"
    assert components.Model == components.Model != components.Link and components.Model.type_id != 0
    assert {components.Model: 1}[components.Model] == 1
    with pytest.raises(AttributeError, match="no NoSuchThing; use register_custom_component"):
        components.NoSuchThing  # noqa: B018


def test_tags_and_data_can_be_set_and_removed() -> None:
    ecm = EntityComponentManager()
    e = ecm.create_entity()
    assert ecm.component(e, components.Model) is None
    ecm.create_component(e, components.Model)
    ecm.create_component(e, components.Pose, Pose3d(1, 2, 3, 0, 0, 0))
    assert ecm.entity_has_component_type(e, components.Model)
    ecm.component(e, components.Pose).set_x(42)
    assert ecm.component(e, components.Pose).x() == 42
    assert ecm.remove_component(e, components.Model) and not ecm.remove_component(e, components.Model)


def test_equal_data_is_set_again_only_without_compare() -> None:
    ecm = EntityComponentManager()
    e = ecm.create_entity()
    ecm.create_component(e, components.Name, "a")
    assert not ecm.set_component_data(e, components.Name, "a")
    assert ecm.set_component_data(e, components.Name, "a", False) and ecm.set_component_data(e, components.Name, "b")


def test_invalid_component_data_is_rejected() -> None:
    ecm = EntityComponentManager()
    e = ecm.create_entity()
    with pytest.raises(TypeError, match="is a tag"):
        ecm.create_component(e, components.Model, "data")
    with pytest.raises(TypeError, match="needs data"):
        ecm.create_component(e, components.Pose)
    with pytest.raises(KeyError, match="no entity 99"):
        ecm.create_component(99, components.Model)
    with pytest.raises(TypeError, match=r"components\.Pose, got 'Pose'"):
        ecm.component(e, "Pose")


def test_custom_components_are_found_by_each() -> None:
    ecm = EntityComponentManager()
    mine = components.register_custom_component("Mine")
    first, _, third = ecm.create_entity(), ecm.create_entity(), ecm.create_entity()
    ecm.create_component(first, mine, {"value": 1})
    ecm.create_component(third, mine, {"value": 3})
    seen = {}
    for item in ecm.each([mine]):
        seen[item.entity] = item.components[0]["value"]
        item.components[0]["value"] *= 10
    assert seen == {first: 1, third: 3} and ecm.component(third, mine) == {"value": 30}


def test_custom_entities_have_parents() -> None:
    ecm = EntityComponentManager()
    parent, child = ecm.create_entity(), ecm.create_entity()
    assert ecm.parent_entity(child) == 0 and ecm.set_parent_entity(child, parent)
    assert ecm.parent_entity(child) == parent and not ecm.has_entity(99) and ecm.entity_count() == 2


def test_a_missing_method_names_a_replacement() -> None:
    with pytest.raises(AttributeError, match=r"no request_remove_entity; use simkit's own sim\.remove\(name\)"):
        EntityComponentManager().request_remove_entity  # noqa: B018
    with pytest.raises(AttributeError, match=r"has no create_entitty; did you mean 'create_entity'"):
        EntityComponentManager().create_entitty  # noqa: B018
    with pytest.raises(RuntimeError, match="has no simulation"):
        EntityComponentManager().simulation  # noqa: B018


def test_later_versions_names_and_loops_work_too() -> None:
    ecm = EntityComponentManager()
    e = ecm.create_entity()
    ecm.create_component(e, components.Name, "a")
    assert ecm.component_data(e, components.Name) == "a"
    assert ecm.each_data(components.Name) == [(e, "a")]
    assert [(entity, name) for entity, (name,) in ecm.each([components.Name])] == [(e, "a")]


# ---------------------------------------------------------------------- of a simulation


def test_entities_of_the_world_have_gz_sims_components() -> None:
    found: dict[str, Any] = {}

    def look(info: Any, ecm: EntityComponentManager) -> None:
        (model,) = [item.entity for item in ecm.each([components.Model])]
        (link,) = [item.entity for item in ecm.each([components.Link, components.Name])]
        found["names"] = [ecm.component(e, components.Name) for e in (1, model, link)]
        found["parents"] = [ecm.parent_entity(e) for e in (1, model, link)] == [0, 1, model]
        found["pose"] = ecm.component(link, components.Pose), ecm.component(link, components.WorldPose)
        found["canonical"] = ecm.entity_has_component_type(link, components.CanonicalLink)
        found["gravity"] = ecm.component(1, components.Gravity)
        found["static"] = ecm.component(model, components.Static)

    run(look)
    assert found["names"] == ["w", "body", "link"] and found["parents"] and found["canonical"]
    assert found["pose"] == (Pose3d(0, 0, 1, 0, 0, 0), Pose3d(1, 2, 4, 0, 0, 0))
    assert found["gravity"] == Vector3d() and found["static"] is False


def test_commands_are_components_too() -> None:
    def push(info: Any, ecm: EntityComponentManager) -> None:
        ecm.create_component(5, components.LinearVelocityCmd, Vector3d(1, 0, 0))
        if info.iterations == 1:
            ecm.create_component(4, components.WorldPoseCmd, Pose3d(0, 0, 9, 0, 0, 0))

    velocity, position = run(push, 3)
    assert velocity == pytest.approx([1, 0, 0]) and position == pytest.approx([0.003, 0, 9])


def test_creating_a_velocity_component_enables_the_reading() -> None:
    told: list[Any] = []

    def look(info: Any, ecm: EntityComponentManager) -> None:
        told.append(ecm.component(5, components.WorldLinearVelocity))
        ecm.create_component(5, components.WorldLinearVelocity, Vector3d())
        ecm.create_component(5, components.LinearVelocityCmd, Vector3d(2, 0, 0))

    run(look, 2)
    assert told == [None, Vector3d(2, 0, 0)]


def test_a_read_only_component_cannot_be_overwritten() -> None:
    def write(info: Any, ecm: EntityComponentManager) -> None:
        ecm.create_component(4, components.Name, "other")

    with pytest.raises(simkit.PluginError, match="Name of model 'body' is read-only"):
        run(write)


def test_a_change_in_place_of_a_read_only_component_is_rejected() -> None:
    def move(info: Any, ecm: EntityComponentManager) -> None:
        ecm.component(4, components.Pose).set_x(9)
        ecm.set_changed(4, components.Pose)

    with pytest.raises(simkit.PluginError, match="Pose of model 'body' is read-only; use a command"):
        run(move)


def test_custom_data_can_be_changed_in_place() -> None:
    mine = components.register_custom_component("Mine")

    def keep(info: Any, ecm: EntityComponentManager) -> None:
        ecm.create_component(4, mine, {"value": 1})
        ecm.component(4, mine)["value"] = 2
        ecm.set_changed(4, mine)
        assert ecm.component_data(4, mine) == {"value": 2}

    run(keep)

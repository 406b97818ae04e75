"""Label plugin of Gazebo: the labels of visuals, and their lifetime."""

from __future__ import annotations

from pathlib import Path

import pytest
from plugin_worlds import GROUND, world

import simkit
from simkit.errors import LoadError

BOX = "<geometry><box><size>1 1 1</size></box></geometry>"


def label(number: object, filename: str = "gz-sim-label-system", name: str = "gz::sim::systems::Label") -> str:
    return f'<plugin filename="{filename}" name="{name}"><label>{number}</label></plugin>'


def model(name: str = "m", more: str = "", on_visual: str = "", on_link: str = "") -> str:
    return (
        f'<model name="{name}"><static>true</static><link name="l"><visual name="a">{BOX}{on_visual}</visual>'
        f'<visual name="b">{BOX}</visual>{on_link}</link>{more}</model>'
    )


def labels_of(*parts: str, quirks: bool = False) -> dict[str, int]:
    top = "<gazebo_quirks>true</gazebo_quirks>" if quirks else ""
    with simkit.load(world(top, *parts)) as sim:
        return sim.contents.labels.by_visual(nested=not quirks)


def codes(*parts: str) -> list[tuple[str, str]]:
    return [(d.code, d.severity) for d in simkit.check(world(*parts))]


@pytest.mark.parametrize(
    ("filename", "name"),
    [
        ("gz-sim-label-system", "gz::sim::systems::Label"),
        ("libgz-sim8-label-system.so", "whatever"),
        ("libignition-gazebo6-label-system.so", "ignition::gazebo::systems::Label"),
        ("mine.so", "gz::sim::systems::Label"),
    ],
)
def test_all_aliases_load_the_plugin(filename: str, name: str) -> None:
    assert labels_of(model(more=label(7, filename, name))) == {"m::l::a": 7, "m::l::b": 7}


def test_the_label_of_a_visual_overrides_that_of_its_model() -> None:
    assert labels_of(model(more=label(7), on_visual=label(8))) == {"m::l::a": 8, "m::l::b": 7}
    assert labels_of(model(on_visual=label(0))) == {"m::l::a": 0}


def test_the_later_of_two_labels_on_one_model_counts() -> None:
    assert labels_of(model(more=label(7) + label(9))) == {"m::l::a": 9, "m::l::b": 9}


def test_a_model_label_applies_to_nested_models_without_a_label() -> None:
    inner = model("bare") + model("own", label(3))
    outer = f'<model name="o"><static>true</static><link name="k"/>{inner}{label(5)}</model>'
    assert set(labels_of(outer).values()) == {3, 5}
    assert labels_of(outer)["o::bare::l::a"] == 5
    assert labels_of(outer)["o::own::l::a"] == 3
    assert "o::bare::l::a" not in labels_of(outer, quirks=True), "gz labels only the links of the model itself"
    assert labels_of(outer, quirks=True)["o::own::l::a"] == 3


def test_a_label_in_an_include_applies_to_the_included_model(tmp_path: Path) -> None:
    (tmp_path / "thing.sdf").write_text(f'<sdf version="1.9">{model("thing", label(1))}</sdf>')
    include = f"<include><uri>thing.sdf</uri><name>t</name>{label(66)}</include>"
    (tmp_path / "world.sdf").write_text(world(include))
    with simkit.load(tmp_path / "world.sdf") as sim:
        assert sim.contents.labels.by_visual() == {"t::l::a": 66, "t::l::b": 66}


def test_a_robot_in_urdf_has_labels_too() -> None:
    shape = '<geometry><box size="1 1 1"/></geometry>'
    robot = f"""<robot name="r"><link name="base"><visual name="a">{shape}</visual></link>
      <link name="arm"><visual name="b">{shape}</visual></link>
      <joint name="j" type="fixed"><parent link="base"/><child link="arm"/></joint>
      <gazebo>{label(4)}</gazebo><gazebo reference="arm"><visual>{label(5)}</visual></gazebo></robot>"""
    with simkit.load(robot) as sim:
        assert sorted(sim.contents.labels.by_visual().values()) == [4, 5]
        assert not [d for d in sim.diagnostics if "plugin" in d.message]


@pytest.mark.parametrize("number", ["256", "-1", "red", "nan", ""])
def test_an_invalid_label_is_an_error_with_the_allowed_range(number: str) -> None:
    with pytest.raises(LoadError, match=r"SK-PARAM-002.*a whole number from 0 to 255"):
        simkit.load(world(model(more=label(number))))


def test_a_plugin_without_a_label_is_an_error() -> None:
    text = model(more='<plugin filename="gz-sim-label-system" name="gz::sim::systems::Label"><lable>3</lable></plugin>')
    (found,) = [d for d in simkit.check(world(text)) if d.severity == "error"]
    assert found.code == "SK-PARAM-001"
    assert "lable" in found.hint


def test_on_a_link_or_a_world_it_is_left_out_with_a_warning() -> None:
    assert ("SK-PLUGIN-007", "warning") in codes(model(on_link=label(7)))
    assert ("SK-PLUGIN-007", "warning") in codes(label(7))
    assert labels_of(model(on_link=label(7))) == {}


def test_labels_are_added_and_removed_with_their_models() -> None:
    with simkit.load(world(model("a", label(1)))) as sim:
        before = sim.snapshot()
        sim.spawn(f'<sdf version="1.9">{model("b", label(2), label(3))}</sdf>')
        assert dict(sim.contents.labels) == {"a": 1, "b": 2, "b::l::a": 3}
        both = sim.snapshot()
        sim.remove("b")
        assert dict(sim.contents.labels) == {"a": 1}
        sim.spawn(f'<sdf version="1.9">{model("b")}</sdf>')
        assert dict(sim.contents.labels) == {"a": 1}, "another model of that name has no label"
        sim.restore(both)
        assert sim.contents.labels.by_visual() == {"a::l::a": 1, "a::l::b": 1, "b::l::a": 3, "b::l::b": 2}
        sim.restore(before)
        assert dict(sim.contents.labels) == {"a": 1}


def test_a_program_can_change_labels_and_a_reset_restores_those_of_the_file() -> None:
    with simkit.load(world(model("a", label(1)))) as sim:
        sim.contents.labels["a::l::b"] = 9
        sim.contents.labels["a"] = 2
        assert sim.contents.labels.by_visual() == {"a::l::a": 2, "a::l::b": 9}
        kept = sim.snapshot()
        del sim.contents.labels["a"]
        assert sim.contents.labels.by_visual() == {"a::l::b": 9}
        sim.restore(kept)
        assert sim.contents.labels.by_visual() == {"a::l::a": 2, "a::l::b": 9}
        sim.reset()
        assert dict(sim.contents.labels) == {"a": 1}


def test_a_wrong_name_or_number_is_refused() -> None:
    with simkit.load(world(model("crate"))) as sim:
        with pytest.raises(KeyError, match="did you mean 'crate'"):
            sim.contents.labels["crte"] = 1
        with pytest.raises(KeyError, match="did you mean 'crate::l::a'"):
            sim.contents.labels["crate::l::aa"] = 1
        for number in (-1, 256, 1.5):
            with pytest.raises(ValueError, match="from 0 to 255"):
                sim.contents.labels["crate"] = number
        assert not sim.contents.labels


def test_a_labelled_model_can_sleep() -> None:
    box = f'<collision name="c">{BOX}</collision><visual name="v">{BOX}</visual>'
    thing = f'<model name="m"><pose>0 0 0.5 0 0 0</pose><link name="l">{box}</link>{{}}</model>'

    def sleeps(text: str) -> bool:
        with simkit.load(world(GROUND, text, step=0.002)) as sim:
            sim.run(3.0)
            return bool(sim.engine.physics.sleep.is_asleep(int(sim.engine.names.link("m::l").body), sim.mj_data))

    assert sleeps(thing.format(label(3))) == sleeps(thing.format(""))

"""Images that are read after the world has changed: they show the world at the time of their samples."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from label_worlds import cube, labelled_model, visual
from sensor_worlds import sensor, world

import simkit
from simkit import msgs
from simkit.pose import Pose

pytestmark = pytest.mark.needs_packs

WARM = """<plugin filename="gz-sim-thermal-system" name="gz::sim::systems::Thermal">
  <temperature>350</temperature></plugin>"""
LAMP = """<light name="lamp" type="point"><pose>1 0 2 0 0 0</pose><diffuse>1 0.5 0 1</diffuse></light>"""
CRATE = f'<sdf version="1.9">{labelled_model("a_crate", "2 0.8 1 0 0 0", visual(cube(0.5), more=WARM), 77)}</sdf>'


def cameras() -> str:
    def block(more: str = "") -> str:
        return f"<camera><image><width>24</width><height>18</height></image>{more}</camera>"

    return (
        sensor("rgbd_camera", block(), name="rgbd", rate=10)
        + sensor("thermal_camera", block(), name="heat", rate=10)
        + sensor(
            "segmentation_camera", block("<segmentation_type>panoptic</segmentation_type>"), name="labels", rate=10
        )
        + sensor("boundingbox_camera", block("<box_type>full_2d</box_type>"), name="flat", rate=10)
        + sensor("boundingbox_camera", block("<box_type>3d</box_type>"), name="space", rate=10)
    )


def surrounding_models() -> str:
    """Return models drawn before and after the crate, so that the engine's geom ids shift."""
    ball = "<sphere><radius>0.3</radius></sphere>"
    return (
        LAMP
        + labelled_model("ball", "3 0 1 0 0 0", visual(ball, more=WARM), 5)
        + labelled_model("wall", "5 0 1 0 0 0", visual(cube(2)))
    )


def latest_bytes(script: Callable[[Any], None], is_read: bool) -> dict[str, bytes]:
    """Return the newest image of each camera after a script; with `is_read`, all images have subscribers before."""
    with simkit.load(world(cameras(), others=surrounding_models())) as sim:
        subs = [
            sim.subscribe(topic)
            for sensor in sim.contents.sensors.values()
            for topic in sensor._topics.values()
            if is_read
        ]
        script(sim)
        found = {name: msgs.serialize(sensor.latest) for name, sensor in sim.contents.sensors.items()}
        assert bool(subs) == is_read
        return found


def a_thing_is_gone(sim: Any) -> None:
    sim.spawn(CRATE)
    sim.run(0.1)
    sim.remove("a_crate")


def a_restore_undoes_a_spawn(sim: Any) -> None:
    sim.run(0.1)
    before = sim.snapshot()
    sim.run(0.1)
    sim.spawn(CRATE)
    sim.run(0.1)
    sim.restore(before)


def a_restore_undoes_a_removal(sim: Any) -> None:
    sim.spawn(CRATE)
    sim.run(0.1)
    before = sim.snapshot()
    sim.run(0.1)
    sim.remove("a_crate")
    sim.run(0.1)
    sim.restore(before)


def a_restore_brings_back_what_was_worn(sim: Any) -> None:
    sim.run(0.1)
    before = sim.snapshot()
    sim.run(0.1)
    sim.contents.labels["ball"], sim.contents.labels["wall"] = 9, 10
    sim.contents.temperatures["ball::l::v"] = 600
    sim.run(0.1)
    sim.restore(before)


def a_lamp_moves(sim: Any) -> None:
    sim.run(0.1)
    sim.light("lamp").set_pose(Pose((2.5, 1.0, 0.5)))


def things_change_colour(sim: Any) -> None:
    sim.run(0.1)
    sim.engine.touch("geom_rgba")[:, :3] = 1, 0, 0


SCRIPTS = (
    a_thing_is_gone,
    a_restore_undoes_a_spawn,
    a_restore_undoes_a_removal,
    a_restore_brings_back_what_was_worn,
    a_lamp_moves,
    things_change_colour,
)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.__name__)
def test_an_image_that_is_read_later_is_the_same(script: Callable[[Any], None]) -> None:
    at_once, later = latest_bytes(script, True), latest_bytes(script, False)
    assert [name for name in at_once if at_once[name] != later[name]] == []


def test_each_of_these_changes_the_next_image() -> None:
    def moved(sim: Any) -> None:
        a_lamp_moves(sim)
        sim.run(0.1)

    def labelled(sim: Any) -> None:
        sim.run(0.1)
        sim.spawn(CRATE)
        sim.contents.labels["ball"] = 9
        sim.run(0.1)

    plain, lit, others = (
        latest_bytes(lambda sim: sim.run(0.2), True),
        latest_bytes(moved, True),
        latest_bytes(labelled, True),
    )
    assert [name for name in plain if plain[name] != lit[name]] == ["m::l::rgbd"]
    assert [name for name in plain if plain[name] == others[name]] == []

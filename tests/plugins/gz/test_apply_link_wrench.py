"""Forces on links, from the file and from topics."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import simkit
from simkit.errors import LoadError

BODY = """<model name="{name}"><pose>{x} 0 1 0 0 0</pose><link name="{link}"><inertial><pose>0.1 0 0 0 0 0</pose>
<mass>2</mass><inertia><ixx>0.5</ixx><iyy>0.5</iyy><izz>0.5</izz></inertia></inertial></link></model>"""


def world(parameters: str = "", more: str = "") -> str:
    bodies = BODY.format(name="one", x=0, link="body") + BODY.format(name="two", x=2, link="body")
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>{bodies}{more}
    <plugin filename="gz-sim-apply-link-wrench-system" name="gz::sim::systems::ApplyLinkWrench">{parameters}</plugin>
    </world></sdf>"""


PERSISTENT = """<persistent><entity_name>{name}</entity_name><entity_type>{kind}</entity_type>
<force>{force}</force><torque>{torque}</torque></persistent>"""


def command(name: str, kind: int, force: Any = (0, 0, 0), torque: Any = (0, 0, 0)) -> dict[str, Any]:
    wrench = {k: dict(zip("xyz", map(float, v), strict=True)) for k, v in (("force", force), ("torque", torque))}
    return {"entity": {"name": name, "type": kind}, "wrench": wrench}


@pytest.mark.parametrize(("name", "kind"), [("one", "model"), ("one::body", "link")])
def test_a_wrench_of_the_file_pushes_at_every_step_at_the_centre_of_mass(name: str, kind: str) -> None:
    sim = simkit.load(world(PERSISTENT.format(name=name, kind=kind, force="4 0 0", torque="0 0 1")))
    body = sim.link("one::body")
    sim.run(0.5)
    # the torque of 1 N m turns 0.5 kg m² about the centre of mass; the force goes through it
    assert body.angular_velocity[2] == pytest.approx(1.0, rel=1e-6)
    centre = body.pose @ simkit.Pose((0.1, 0, 0))
    assert centre.position[:2] == pytest.approx((0.1 + 0.5 * 2 * 0.25, 0), abs=1e-3)
    assert np.linalg.norm(sim.link("two::body").linear_velocity) == 0.0


def test_the_measured_acceleration_includes_the_wrench() -> None:
    sim = simkit.load(world(PERSISTENT.format(name="one", kind="model", force="0 0 6", torque="0 0 0")))
    assert sim.link("one::body").linear_acceleration == pytest.approx((0, 0, 3))
    sim.run(0.2)
    assert sim.link("one::body").linear_acceleration == pytest.approx((0, 0, 3))


def test_a_message_pushes_for_one_step() -> None:
    sim = simkit.load(world())
    sim.publish("/world/w/wrench", command("two::body", 3, force=(10, 0, 0)))
    sim.run(0.1)
    assert sim.link("two::body").linear_velocity[0] == pytest.approx(10 / 2 * 0.001)


def test_persistent_messages_add_up_until_they_are_cleared() -> None:
    sim = simkit.load(world(PERSISTENT.format(name="one", kind="model", force="1 0 0", torque="0 0 0")))
    sim.publish("/world/w/wrench/persistent", command("one", 2, force=(3, 0, 0)))
    sim.run(0.1)
    assert sim.link("one::body").linear_velocity[0] == pytest.approx(4 / 2 * 0.1)
    sim.publish("/world/w/wrench/clear", {"name": "one", "type": 2})
    sim.run(0.1)
    assert sim.link("one::body").linear_velocity[0] == pytest.approx(4 / 2 * 0.1, rel=1e-9)


def test_other_wrenches_still_last_one_step() -> None:
    sim = simkit.load(world(PERSISTENT.format(name="one", kind="model", force="1 0 0", torque="0 0 0")))
    sim.link("one::body").apply_wrench((2.0, 0, 0))
    sim.step(10)
    assert sim.link("one::body").linear_velocity[0] == pytest.approx((10 * 1 + 2) / 2 * 0.001)


def test_an_entity_that_is_spawned_later_is_pushed_from_then_on() -> None:
    persistent = PERSISTENT.format(name="late", kind="model", force="2 0 0", torque="0 0 0")
    sim = simkit.load(world(persistent))
    assert "SK-JOINT-013" in [d.code for d in sim.diagnostics]
    sim.run(0.1)
    sim.spawn(f'<sdf version="1.9">{BODY.format(name="late", x=5, link="body")}</sdf>')
    sim.run(0.1)
    assert sim.link("late::body").linear_velocity[0] == pytest.approx(0.1, abs=0.002)
    sim.remove("late")
    sim.run(0.1)
    sim.spawn(f'<sdf version="1.9">{BODY.format(name="late", x=5, link="body")}</sdf>')
    sim.run(0.1)
    assert sim.link("late::body").linear_velocity[0] == pytest.approx(0.1, abs=0.002)


def test_snapshots_and_resets_restore_the_wrenches() -> None:
    sim = simkit.load(world())
    snapshot = sim.snapshot()
    sim.publish("/world/w/wrench/persistent", command("one", 2, force=(3, 0, 0)))
    sim.run(0.1)
    pushed = sim.snapshot()
    speed = float(sim.link("one::body").linear_velocity[0])
    sim.restore(snapshot)
    sim.run(0.1)
    assert sim.link("one::body").linear_velocity[0] == 0.0
    sim.restore(pushed)
    sim.run(0.1)
    assert sim.link("one::body").linear_velocity[0] == pytest.approx(2 * speed)
    sim.reset()
    sim.run(0.1)
    assert sim.link("one::body").linear_velocity[0] == 0.0


@pytest.mark.parametrize(
    "broken",
    [
        "<persistent><entity_type>link</entity_type></persistent>",
        PERSISTENT.format(name="one", kind="light", force="0 0 0", torque="0 0 0"),
    ],
)
def test_an_entity_without_name_or_of_another_type_is_an_error(broken: str) -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-00"):
        simkit.load(world(broken))


def test_topics_can_be_named() -> None:
    sim = simkit.load(
        world("<topic>/push</topic><topic_persistent>/lean</topic_persistent><topic_clear>/stop</topic_clear>")
    )
    assert {"/push", "/lean", "/stop"} <= set(sim.topics())


def test_an_entity_can_be_given_by_its_id() -> None:
    sim = simkit.load(world())
    scene = sim.call("/world/w/scene/info")
    numbers = {e.entity.name: e.entity.id for e in scene.entities}
    by_id = command("", 0, force=(10, 0, 0))
    by_id["entity"]["id"] = next(number for name, number in numbers.items() if name.endswith("two::body"))
    sim.publish("/world/w/wrench", by_id)
    sim.step()
    assert sim.link("two::body").linear_velocity[0] == pytest.approx(10 / 2 * 0.001)


def test_requests_for_missing_entities_are_ignored() -> None:
    sim = simkit.load(world())
    sim.publish("/world/w/wrench", command("two::body", 3, force=(float("nan"), 0, 0)))
    sim.publish("/world/w/wrench/persistent", command("two::body", 3, torque=(float("inf"), 0, 0)))
    sim.publish("/world/w/wrench", command("two::body", 4, force=(1, 0, 0)))
    sim.publish("/world/w/wrench", command("", 0, force=(1, 0, 0)))
    sim.step(10)
    assert np.linalg.norm(sim.link("two::body").linear_velocity) == 0.0
    assert [d.code for d in sim.diagnostics] == ["SK-PLUGIN-041"]


def test_a_name_may_begin_with_the_name_of_the_world() -> None:
    sim = simkit.load(world())
    sim.publish("/world/w/wrench", command("w::two", 2, force=(10, 0, 0)))
    sim.step()
    assert sim.link("two::body").linear_velocity[0] == pytest.approx(10 / 2 * 0.001)


def test_an_entity_without_a_name_is_an_error() -> None:
    with pytest.raises(LoadError, match="found <entity_name></entity_name>; expected a name"):
        simkit.load(world("<persistent><entity_name/><entity_type>link</entity_type></persistent>"))

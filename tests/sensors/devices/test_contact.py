"""Contact sensors: forces compared with mechanics, reported contacts, and their times."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from contact_worlds import GROUND, G, body, contact, mu, names, topic, total_force, world, xyz

import simkit
from simkit import msgs

BOX = body("b", sensor=contact(), mass=2.5)
NO_GRAVITY = "<gravity>0 0 0</gravity>"


def table(sensor: str, more: str = "<static>true</static>") -> str:
    return f"""<model name="table"><pose>0 0 0.5 0 0 0</pose>{more}<link name="l"><collision name="c"><geometry>
    <box><size>2 2 0.2</size></box></geometry></collision>{sensor}</link></model>"""


# ---------------------------------------------------------------------- mechanics


@pytest.mark.parametrize("step", [0.001, 0.004])  # elliptic cones, pyramids
@pytest.mark.parametrize("shape", ["box", "sphere", "cylinder", "capsule"])
def test_at_rest_the_forces_are_the_weight(shape: str, step: float) -> None:
    with simkit.load(world(GROUND, body("b", shape=shape, mass=2.5, sensor=contact()), step=step)) as sim:
        sub = sim.subscribe(topic("b"), keep=1)
        sim.run(1.5)
        (touch,) = sub.latest.contacts
        np.testing.assert_allclose(total_force(sub.latest), (0, 0, 2.5 * G), atol=1e-3)
        for normal, depth in zip(touch.normals, touch.depths, strict=True):
            np.testing.assert_allclose(xyz(normal), (0, 0, 1), atol=1e-6)
            assert 0 <= depth < 1e-3
        assert (touch.collision1.name, touch.collision2.name) == ("b::l::c", "ground::l::c")
        assert touch.collision1.type == touch.collision2.type == 5
        assert len(touch.positions) == len(touch.normals) == len(touch.wrenches) == len(touch.depths)


def test_friction_opposes_a_push_up_to_the_friction_cone() -> None:
    with simkit.load(world(GROUND, body("b", mass=2, sensor=contact(), friction=mu(0.6)))) as sim:
        sensor = sim.sensor("b::l::s")
        sim.run(0.5)

        def push(*force: float) -> Any:
            felt = []
            for _ in range(200):
                sim.link("b::l").apply_wrench(force)
                sim.step()
                felt.append(total_force(sensor.latest))
            return np.array(felt)

        np.testing.assert_allclose(push(5, 1, -3)[-1], (-5, -1, 2 * G + 3), atol=0.05)
        before = sim.link("b::l").linear_velocity
        sliding = push(15, 0, 0)
        forces = [xyz(w.body_1_wrench.force) for c in sensor.latest.contacts for w in c.wrenches]
        assert all(np.hypot(x, y) <= 0.6 * z + 1e-6 for x, y, z in forces)
        # the force of a sliding contact oscillates, so the test uses the mean
        momentum = (np.array((15, 0, -2 * G)) + sliding.mean(axis=0)) * 0.2
        np.testing.assert_allclose(2 * (sim.link("b::l").linear_velocity - before), momentum, atol=0.1)


def test_without_friction_there_is_only_the_normal_force() -> None:
    with simkit.load(world(GROUND, body("b", mass=2, sensor=contact(), friction=mu(0)))) as sim:
        sub = sim.subscribe(topic("b"), keep=1)
        sim.run(0.5)
        sim.link("b::l").apply_wrench((20, 0, 0))
        sim.step()
        np.testing.assert_allclose(total_force(sub.latest), (0, 0, 2 * G), atol=1e-6)


def test_colliding_bodies_measure_opposite_forces_that_change_their_momentum() -> None:
    first = body("a", "0 0 0 0 0 0", sensor=contact())
    second = body("b", "0.3 0 0.02 0 0 0", "sphere", mass=3, sensor=contact())
    with simkit.load(world(first, second, top=NO_GRAVITY)) as sim:
        felt = {name: sim.subscribe(topic(name)) for name in "ab"}
        sim.model("a").set_velocity((1, 0, 0), (0, 0, 0))
        sim.run(0.3)
        on_a, on_b = (np.array([total_force(m) for m in felt[name].messages]) for name in "ab")
        assert len(on_a) > 3
        np.testing.assert_array_equal(on_a, -on_b)
        for name, other in ("ab", "ba"):
            (touch,) = felt[name].messages[0].contacts
            assert (touch.collision1.name, touch.collision2.name) == (f"{name}::l::c", f"{other}::l::c")
            wrench = touch.wrenches[0]
            np.testing.assert_array_equal(xyz(wrench.body_1_wrench.force), -xyz(wrench.body_2_wrench.force))
        assert xyz(felt["a"].messages[0].contacts[0].normals[0])[0] < -0.99
        # a message contains the force of the step after it, so the force of the last step is not known yet
        on_a, on_b = on_a[:-1], on_b[:-1]
        np.testing.assert_allclose(on_b.sum(axis=0) * 0.001, 3 * sim.link("b::l").linear_velocity, atol=1e-9)
        np.testing.assert_allclose(on_a.sum(axis=0) * 0.001, sim.link("a::l").linear_velocity - (1, 0, 0), atol=1e-9)


def test_the_torque_of_a_contact_stops_a_spinning_ball() -> None:
    friction = mu(0.9) + "<torsional><coefficient>1</coefficient><patch_radius>0.05</patch_radius></torsional>"
    ball = body("b", shape="sphere", sensor=contact(), friction=friction)
    with simkit.load(world(GROUND, ball)) as sim:
        sub = sim.subscribe(topic("b"), keep=1)
        sim.run(0.3)
        sim.model("b").set_velocity((0, 0, 0), (0, 0, 1))
        sim.step()
        before, felt = sim.link("b::l").angular_velocity[2], sub.latest
        sim.step()
        slowing = (sim.link("b::l").angular_velocity[2] - before) / 0.001 * 0.2**2 / 6
        (wrench,) = felt.contacts[0].wrenches
        assert wrench.body_1_wrench.torque.z < -0.01
        assert wrench.body_1_wrench.torque.z == pytest.approx(slowing, rel=1e-3)
        assert wrench.body_2_wrench.torque.z == -wrench.body_1_wrench.torque.z


# ---------------------------------------------------------------------- what touches


def test_a_collision_in_convex_pieces_is_one_collision() -> None:
    """The collision is an L on its flat side: two convex pieces with one name."""
    outline = ("0 0", "0.4 0", "0.4 0.1", "0.1 0.1", "0.1 0.4", "0 0.4")
    shape = "<polyline>" + "".join(f"<point>{p}</point>" for p in outline) + "<height>0.1</height></polyline>"
    part = body("b", "0 0 0.0 0 0 0", shape, sensor=contact())
    with simkit.load(world(GROUND, part.replace("<inertial>", "<inertial><pose>0.1 0.1 0.05 0 0 0</pose>"))) as sim:
        assert len(sim.engine.names.link("b::l").geoms) > 1
        sub = sim.subscribe(topic("b"), keep=1)
        sim.run(1.0)
        assert names(sub.latest) == [("b::l::c", "ground::l::c")]
        assert len(sub.latest.contacts[0].positions) > 4
        np.testing.assert_allclose(total_force(sub.latest), (0, 0, G), atol=1e-3)


def test_a_pair_is_published_once_in_the_order_of_the_sensors_collisions() -> None:
    feet = "".join(
        f'<collision name="{name}"><pose>{x} 0 -0.1 0 0 0</pose><geometry><sphere><radius>0.05</radius></sphere>'
        "</geometry></collision>"
        for name, x in (("left", -0.3), ("right", 0.3))
    )
    rest = contact("right left right") + '<collision name="none"><geometry><empty/></geometry></collision>'
    walker = body("b", "0 0 0.15 0 0 0", "<empty/>", sensor=feet + rest)
    boards = [body(n, f"{x} 0 -0.1 0 0 0", "<box><size>0.2 2 0.2</size></box>", more="<static>1</static>") for n, x in
              (("p", -0.3), ("q", 0.3))]  # fmt: skip
    with simkit.load(world(*boards, walker)) as sim:
        sub = sim.subscribe(topic("b"), keep=1)
        sim.run(0.1)
        assert names(sub.latest) == [("b::l::right", "q::l::c"), ("b::l::left", "p::l::c")]
        assert sim.sensor("b::l::s").collisions == ("b::l::right", "b::l::left")


def test_a_link_of_a_nested_model_is_found_by_its_scoped_name() -> None:
    inner = body("inner", "0 0 0 0 0 0", sensor=contact())
    outer = f'<model name="outer"><pose>0 0 0.1 0 0 0</pose>{inner}</model>'
    with simkit.load(world(GROUND, outer)) as sim:
        sub = sim.subscribe("/world/w/model/outer/model/inner/link/l/sensor/s/contact", keep=1)
        sim.run(0.1)
        assert names(sub.latest) == [("outer::inner::l::c", "ground::l::c")]


@pytest.mark.parametrize("held", ["static", "joint"])
def test_a_static_link_keeps_detecting_resting_bodies(held: str) -> None:
    """Boxes at rest would fall asleep, and the engine computes no contacts of sleeping bodies."""
    fixed = '<joint name="j" type="fixed"><parent>world</parent><child>l</child></joint>'
    stand = table(contact(rate=10), "<static>true</static>" if held == "static" else fixed)
    boxes = [body(f"b{x}", f"{x * 0.5} 0 0.7 0 0 0") for x in (0, 1)]
    with simkit.load(world(stand, *boxes)) as sim:
        sub = sim.subscribe(topic("table"))
        sim.run(4.0)
        assert len(sub.messages) == 41
        np.testing.assert_allclose(total_force(sub.latest), (0, 0, -2 * G), atol=1e-3)
        assert names(sub.latest) == [("table::l::c", "b0::l::c"), ("table::l::c", "b1::l::c")]
        if held == "static":  # the static table becomes a kinematic body
            sim.model("table").set_pose(simkit.Pose((0, 0, 0.45)))
            sim.run(1.0)
            np.testing.assert_allclose(total_force(sub.latest), (0, 0, -2 * G), atol=1e-3)


def test_bodies_without_a_contact_sensor_may_sleep() -> None:
    with simkit.load(world(GROUND, BOX, body("other", "2 0 0.1 0 0 0"))) as sim:
        sim.run(4.0)
        assert (sim.mj_data.tree_asleep >= 0).tolist() == [False, True]


def test_planes_and_heightmaps_have_contacts(tmp_path: Any) -> None:
    from PIL import Image

    Image.fromarray(np.full((17, 17), 255, np.uint8)).save(tmp_path / "flat.png")
    shape = "<heightmap><uri>flat.png</uri><size>4 4 1</size><pos>0 0 -1</pos></heightmap>"
    ground = GROUND.replace("<plane/>", shape).replace("</collision>", "</collision>" + contact())
    (tmp_path / "w.sdf").write_text(world(ground, body("b", "0.1 0.1 0.101 0 0 0", "sphere", sensor=contact())))
    with simkit.load(tmp_path / "w.sdf") as sim:
        felt = {name: sim.subscribe(topic(name), keep=1) for name in ("b", "ground")}
        sim.run(1.0)
        assert names(felt["b"].latest) == [("b::l::c", "ground::l::c")]
        np.testing.assert_allclose(total_force(felt["b"].latest), (0, 0, G), atol=1e-2)
        np.testing.assert_array_equal(total_force(felt["b"].latest), -total_force(felt["ground"].latest))
    plane = GROUND.replace("</collision>", "</collision>" + contact())
    with simkit.load(world(plane, body("b"))) as sim:
        sim.run(1.0)
        np.testing.assert_allclose(total_force(sim.sensor("ground::l::s").latest), (0, 0, -G), atol=1e-3)


# ---------------------------------------------------------------------- when


def test_without_contacts_there_is_a_reading_but_no_message() -> None:
    with simkit.load(world(GROUND, body("b", "0 0 0.2 0 0 0", sensor=contact()))) as sim:
        sub = sim.subscribe(topic("b"))
        sim.run(0.1)
        assert sub.messages == []
        assert sim.sensor("b::l::s").latest.contacts == []
        sim.run(0.9)
        count = len(sub.messages)
        assert 800 < count < 870  # it falls 0.1 m: 0.14 s
        assert msgs.stamp_ns(sub.messages[0].header.stamp) == pytest.approx((2 * 0.1 / G) ** 0.5 * 1e9, abs=3e6)
        sim.model("b").set_pose(simkit.Pose((0, 0, 1)))
        sim.model("b").set_velocity((0, 0, 0), (0, 0, 0))
        sim.run(0.1)
        assert len(sub.messages) == count
        assert sim.sensor("b::l::s").latest.contacts == []
        sim.run(0.5)
        assert len(sub.messages) > count


@pytest.mark.parametrize(("quirks", "count"), [("", 11), ("<gazebo_quirks>true</gazebo_quirks>", 1000)])
def test_the_rate_of_the_file_applies_without_gazebos_quirks(quirks: str, count: int) -> None:
    with simkit.load(world(GROUND, body("b", sensor=contact(rate=10)), top=quirks)) as sim:
        sub = sim.subscribe(topic("b"))
        sim.run(1.0)
        assert len(sub.messages) == count


def test_subscribers_change_no_message() -> None:
    def run(*listens: str) -> list[bytes]:
        heap = [body(n, f"{x} 0 {z} 0 0.3 0", s, sensor=contact(rate=100)) for n, x, z, s in
                (("a", 0, 0.2, "box"), ("b", 0.05, 0.45, "cylinder"), ("c", 0.02, 0.7, "capsule"))]  # fmt: skip
        out = []
        with simkit.load(world(GROUND, *heap)) as sim:
            for name in listens:
                sim.subscribe(topic(name))
            for _ in range(30):
                sim.step(37)
                out += [msgs.serialize(sim.sensor(f"{name}::l::s").latest) for name in "abc"]
        return out

    quiet = run()
    assert run("a", "b", "c") == quiet
    assert run("b") == quiet


def test_truth_is_the_same_message() -> None:
    with simkit.load(world(GROUND, BOX)) as sim:
        sim.run(0.2)
        sensor = sim.sensor("b::l::s")
        assert msgs.serialize(sensor.truth) == msgs.serialize(sensor.latest)
        assert sensor.topic == topic("b")
        assert sim.topics()[sensor.topic] == "ros_gz_interfaces/msg/Contacts"


@pytest.mark.parametrize(
    ("more", "name"), [("<topic>touch</topic>", "/touch"), ("<topic>__default_topic__</topic>", topic("b"))]
)
def test_the_topic_is_in_the_sensors_block(more: str, name: str) -> None:
    block = contact().replace("</contact>", more + "</contact>")
    with simkit.load(world(GROUND, body("b", sensor=block))) as sim:
        assert sim.sensor("b::l::s").topic == name
        assert not [d for d in sim.diagnostics if d.severity != "note"]


# ---------------------------------------------------------------------- the world changes


def test_reset_and_restore_repeat_the_readings() -> None:
    def record(sim: Any) -> list[bytes]:
        sub = sim.subscribe(topic("b"))
        sim.run(0.5)
        sub.close()
        return [msgs.serialize(m) for m in sub.messages]

    with simkit.load(world(GROUND, body("b", "0 0 0.2 0.3 0.2 0", sensor=contact()))) as sim:
        first = record(sim)
        snapshot = sim.snapshot()
        second = record(sim)
        sim.restore(snapshot)
        assert record(sim) == second
        sim.reset()
        assert record(sim) == first


def test_models_in_contact_can_be_spawned_and_removed() -> None:
    with simkit.load(world(GROUND, BOX)) as sim:
        sub = sim.subscribe(topic("b"), keep=1)
        sim.run(0.5)
        before = sim.snapshot()
        sim.spawn(f'<sdf version="1.9">{body("top", "0 0 0.3 0 0 0", sensor=contact())}</sdf>')
        sim.run(1.0)
        assert names(sub.latest) == [("b::l::c", "ground::l::c"), ("b::l::c", "top::l::c")]
        np.testing.assert_allclose(total_force(sub.latest), (0, 0, 2.5 * G), atol=1e-3)
        np.testing.assert_allclose(total_force(sim.sensor("top::l::s").latest), (0, 0, G), atol=1e-3)
        sim.remove("ground")
        sim.step()
        assert names(sub.latest) == [("b::l::c", "top::l::c")]
        sim.restore(before)
        sim.run(0.1)
        assert names(sub.latest) == [("b::l::c", "ground::l::c")]
        sim.reset()
        sim.run(0.1)
        assert names(sub.latest) == [("b::l::c", "ground::l::c")]


def test_collisions_that_are_off_touch_nothing() -> None:
    with simkit.load(world(GROUND, BOX)) as sim:
        sub = sim.subscribe(topic("b"))
        sim.run(0.2)
        sim.link("b::l").collisions_enabled = False
        count = len(sub.messages)
        sim.run(0.01)
        assert len(sub.messages) == count


# ---------------------------------------------------------------------- names


def codes(source: str) -> list[tuple[str, str, str]]:
    with simkit.load(source) as sim:
        return [(d.code, d.severity, d.hint) for d in sim.diagnostics if d.severity != "note"]


def test_a_missing_collision_is_reported_with_the_closest_name() -> None:
    wrong = body("b", sensor=contact("shel foot"))
    own = wrong.replace('name="c"', 'name="shell"')
    assert codes(world(GROUND, own)) == [
        ("SK-SENSOR-040", "warning", "did you mean 'shell'?"),
        ("SK-SENSOR-040", "warning", ""),
    ]
    elsewhere = body("b", sensor=contact("pad"), more='<link name="k"><collision name="pad"><geometry><sphere><radius>1'
                     '</radius></sphere></geometry></collision></link>')  # fmt: skip
    (hint,) = [hint for code, _, hint in codes(world(GROUND, elsewhere)) if code == "SK-SENSOR-040"]
    assert "'b::k'" in hint


def test_a_contact_sensor_without_collisions_detects_nothing_as_in_gazebo() -> None:
    assert [c for c, *_ in codes(world(GROUND, body("b", sensor=contact(""))))] == ["SK-SENSOR-041"]
    with simkit.load(world(GROUND, body("b", sensor=contact("")))) as sim:
        sub = sim.subscribe(topic("b"))
        sim.run(0.1)
        assert sub.messages == []


def test_old_files_name_the_collision_in_an_attribute() -> None:
    block = contact("").replace("<contact>", '<contact><collision name="c"/>')
    with simkit.load(world(GROUND, body("b", sensor=block))) as sim:
        sim.run(0.1)
        assert names(sim.sensor("b::l::s").latest) == [("b::l::c", "ground::l::c")]


@pytest.mark.parametrize("name", ["a b", "größe", "a/b#0", "c.1", "100%"])
def test_unusual_names_are_accepted(name: str) -> None:
    block = contact("").replace("<contact>", f"<contact><collision>{name}</collision>")
    odd = body("b", sensor=block).replace('name="c"', f'name="{name}"')
    with simkit.load(world(GROUND, odd)) as sim:
        sim.run(0.1)
        assert names(sim.sensor("b::l::s").latest) == [(f"b::l::{name}", "ground::l::c")]


@pytest.mark.parametrize("is_named", [True, False])
def test_names_are_left_out_where_the_physics_system_asks_for_it(is_named: bool) -> None:
    said = f"<contacts><include_entity_names>{str(is_named).lower()}</include_entity_names></contacts>"
    system = f"<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'>{said}</plugin>"
    with simkit.load(world(system, GROUND, BOX)) as sim:
        sub = sim.subscribe(topic("b"))
        sim.run(0.5)
        (touch,) = sub.latest.contacts
        pair = (touch.collision1, touch.collision2)
        assert [one.name for one in pair] == (["b::l::c", "ground::l::c"] if is_named else ["", ""])
        assert touch.collision1.id != touch.collision2.id
        assert bool(touch.wrenches[0].body_1_name.data) == is_named

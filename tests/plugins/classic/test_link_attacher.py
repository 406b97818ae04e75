"""Link attachers of Gazebo Classic: attach two links by a service, carry, and detach them."""

from __future__ import annotations

from typing import Any

import pytest

import simkit

G = 9.8
BODY = "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"


def crane(plugin: str = '<plugin name="attacher" filename="libgazebo_link_attacher.so"/>') -> str:
    """Hook on a spring, and a load that floats beside it without gravity until it is attached."""
    return f"""<sdf version="1.6"><world name="w">{plugin}
      <model name="crane"><pose>0 0 2 0 0 0</pose><link name="hook">{BODY}</link>
      <joint name="spring" type="prismatic"><parent>world</parent><child>hook</child><axis><xyz>0 0 1</xyz><dynamics>
      <damping>40</damping><spring_stiffness>400</spring_stiffness></dynamics></axis></joint></model>
      <model name="load"><pose>0.3 0 1.8 0 0 0.5</pose><link name="box">{BODY}</link></model>
      <model name="floor"><static>true</static><link name="slab"/></model></world></sdf>"""


def request(first: str = "crane::hook", second: str = "load::box") -> dict[str, str]:
    (model_1, link_1), (model_2, link_2) = first.split("::", 1), second.split("::", 1)
    return {"model1_name": model_1, "link1_name": link_1, "model2_name": model_2, "link2_name": link_2}


def call(sim: simkit.Simulation, word: str, **names: str) -> Any:
    return sim.call(f"/{word}LINK", request(**names))


def test_an_attached_load_hangs_on_the_hook_and_falls_when_it_is_detached() -> None:
    with simkit.load(crane()) as sim:
        load, hook = sim.model("load"), sim.link("crane::hook")
        before = hook.pose.inverse() @ load.pose
        assert call(sim, "ATTACH").success
        sim.run(3.0)
        held = hook.pose.inverse() @ load.pose
        assert held.position == pytest.approx(before.position, abs=1e-3)
        assert held.rpy == pytest.approx(before.rpy, abs=1e-3)
        # the weights of the hook and of the load on the spring of 400 N/m
        assert sim.joint("crane::spring").position == pytest.approx(-2 * G / 400, rel=1e-2)
        answer = call(sim, "DETACH")
        assert answer.success and "DETACHED" in answer.message
        height = float(load.pose.position[2])
        sim.run(0.5)
        assert height - load.pose.position[2] == pytest.approx(G / 8, rel=1e-2)


def test_a_second_attachment_keeps_the_pose_of_its_moment() -> None:
    with simkit.load(crane()) as sim:
        for word in ("ATTACH", "DETACH"):
            assert call(sim, word).success
        sim.run(0.2)
        assert call(sim, "ATTACH").success
        held = sim.link("crane::hook").pose.inverse() @ sim.model("load").pose
        sim.run(1.0)
        now = sim.link("crane::hook").pose.inverse() @ sim.model("load").pose
        assert now.position == pytest.approx(held.position, abs=2e-3)
        assert held.position[2] < -0.3


def test_a_load_is_attached_to_a_static_model_too() -> None:
    with simkit.load(crane()) as sim:
        assert call(sim, "ATTACH", first="floor::slab").success
        sim.run(0.5)
        assert sim.model("load").pose.position == pytest.approx((0.3, 0, 1.8), abs=1e-4)


@pytest.mark.parametrize(
    ("names", "reason"),
    [
        ({"second": "laod::box"}, "did you mean 'load'"),
        ({"second": "load::bxo"}, "did you mean 'load::box'"),
        ({"first": "load::box"}, "itself"),
    ],
)
def test_a_wrong_name_is_refused_with_the_closest_one(names: dict[str, str], reason: str) -> None:
    with simkit.load(crane()) as sim:
        answer = call(sim, "ATTACH", **names)
        assert not answer.success and reason in answer.message
        answer = call(sim, "DETACH", **names)
        assert not answer.success and "not attached" in answer.message


def test_two_static_links_are_refused() -> None:
    text = crane().replace("</world>", '<model name="wall"><static>true</static><link name="l"/></model></world>')
    with simkit.load(text) as sim:
        answer = call(sim, "ATTACH", first="floor::slab", second="wall::l")
        assert not answer.success and "both static" in answer.message
        sim.step()


def test_the_node_of_ros_1_has_other_names() -> None:
    with simkit.load(crane('<plugin name="attacher" filename="libgazebo_ros_link_attacher.so"/>')) as sim:
        names = {"model_name_1": "crane", "link_name_1": "hook", "model_name_2": "load", "link_name_2": "box"}
        assert not sim.call("/link_attacher_node/detach", names).ok
        assert sim.call("/link_attacher_node/attach", names).ok
        sim.run(0.3)
        assert sim.model("load").pose.position[2] > 1.6
        assert sim.call("/link_attacher_node/detach", names).ok


def test_a_namespace_moves_the_services() -> None:
    plugin = '<plugin name="a" filename="libgazebo_link_attacher.so"><ros><namespace>cell</namespace></ros></plugin>'
    with simkit.load(crane(plugin)) as sim:
        assert sim.call("/cell/ATTACHLINK", request()).success


def test_a_model_spawned_again_is_attached_again() -> None:
    with simkit.load(crane()) as sim:
        assert call(sim, "ATTACH").success
        sim.remove("load")
        assert not call(sim, "DETACH").success
        pose = "<pose>0 0.3 2 0 0 0</pose>"
        sim.spawn(f'<sdf version="1.6"><model name="load">{pose}<link name="box">{BODY}</link></model></sdf>')
        assert call(sim, "ATTACH").success
        sim.run(0.5)
        assert sim.model("load").pose.position[2] > 1.7


def test_a_restored_run_repeats_bit_for_bit_and_a_reset_detaches() -> None:
    with simkit.load(crane()) as sim:
        sim.run(0.1)
        call(sim, "ATTACH")
        sim.run(0.1)
        snapshot = sim.snapshot()

        def rest() -> tuple[float, ...]:
            sim.run(0.1)
            assert call(sim, "DETACH").success
            sim.run(0.1)
            return tuple(sim.model("load").pose.position)

        first = rest()
        sim.restore(snapshot)
        assert rest() == first
        sim.reset()
        assert not call(sim, "DETACH").success
        sim.run(0.2)
        assert sim.model("load").pose.position[2] == pytest.approx(1.8 - G * 0.02, abs=2e-3)

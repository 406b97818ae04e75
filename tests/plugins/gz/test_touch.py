"""TouchPlugin of Gazebo: one message after a time of uninterrupted contact with its target."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit.errors import LoadError

SENSOR = '<sensor name="s" type="contact"><contact><collision>c</collision></contact></sensor>'


def body(name: str, pose: str, more: str = "", sensor: str = SENSOR, static: bool = False) -> str:
    shape = '<collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>'
    moments = "".join(f"<{axis}>0.01</{axis}>" for axis in ("ixx", "iyy", "izz"))
    return f"""<model name="{name}"><static>{str(static).lower()}</static><pose>{pose}</pose><link name="l">
    <inertial><mass>1</mass><inertia>{moments}</inertia></inertial>{shape}{sensor}</link>{more}</model>"""


def plugin(target: str = "pad", time: float = 0.1, enabled: str = "true", more: str = "") -> str:
    return f"""<plugin filename="gz-sim-touchplugin-system" name="gz::sim::systems::TouchPlugin">
    <target>{target}</target><time>{time}</time><namespace>probe</namespace><enabled>{enabled}</enabled>{more}</plugin>"""


PAD = body("pad", "0 0 0.1 0 0 0", sensor="", static=True)


def world(*parts: str) -> str:
    return f'<sdf version="1.9"><world name="w">{"".join(parts)}</world></sdf>'


def probe(*, pose: str = "0 0 0.3 0 0 0", sensor: str = SENSOR, name: str = "probe", **settings: Any) -> str:
    return body(name, pose, plugin(**settings), sensor)


def touch_ticks(sim: Any, duration: float = 0.3) -> list[int]:
    """Return the ticks at which a touch is published."""
    ticks: list[int] = []
    sub = sim.subscribe("/probe/touched", lambda message: ticks.append(sim.tick) if message.data else None)
    sim.run(duration)
    sub.close()
    return ticks


def test_a_touch_is_published_once_after_the_given_time() -> None:
    with simkit.load(world(PAD, probe())) as sim:
        assert sim.topics()["/probe/touched"] == sim.topics()["/probe/enable"] == "std_msgs/msg/Bool"
        # touches at the first step; more than 0.1 s later it is enough
        assert touch_ticks(sim, 0.5) == [102]


def test_a_detector_that_is_enabled_again_starts_from_zero() -> None:
    with simkit.load(world(PAD, probe(enabled="false"))) as sim:
        assert touch_ticks(sim) == []
        sim.publish("/probe/enable", {"data": True})
        assert touch_ticks(sim) == [pytest.approx(300 + 102, abs=2)]
        sim.publish("/probe/enable", {"data": True})
        sim.run(0.05)
        sim.publish("/probe/enable", {"data": False})
        assert touch_ticks(sim) == []


def test_an_interruption_restarts_the_time() -> None:
    with simkit.load(world(PAD, probe(time=0.1))) as sim:
        sim.run(0.08)
        sim.model("probe").set_pose(simkit.Pose((0, 0, 0.305)))
        (tick,) = touch_ticks(sim)
        assert 80 + 32 + 100 < tick < 80 + 32 + 110  # the target falls 5 mm


@pytest.mark.parametrize("target", ["pad", "pad::l::c", "/pad/l/c", "model/pad/link/l", "world/w/model/pad"])
def test_the_target_is_a_part_of_a_scoped_name_in_any_spelling(target: str) -> None:
    with simkit.load(world(PAD, probe(target=target))) as sim:
        assert touch_ticks(sim) == [102]
        assert not [d for d in sim.diagnostics if d.severity != "note"]


def test_contact_with_other_objects_does_not_interrupt_the_time() -> None:
    other = body("other", "0.15 0 0.1 0 0 0", sensor="", static=True)
    with simkit.load(world(PAD, other, probe(pose="0.1 0 0.3 0 0 0"))) as sim:
        assert touch_ticks(sim) == [102]
    with simkit.load(world(PAD, probe(pose="3 0 0.3 0 0 0"), body("other", "3 0 0.1 0 0 0", static=True))) as sim:
        assert touch_ticks(sim) == []


def test_only_named_collisions_or_those_with_a_sensor_count() -> None:
    make = "<create_contact_sensor_for_collision>true</create_contact_sensor_for_collision>"
    with simkit.load(world(PAD, probe(sensor=""))) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-043"] == ["warning"]
        assert touch_ticks(sim) == []
    with simkit.load(world(PAD, probe(sensor="", more="<collision>c</collision>"))) as sim:
        assert touch_ticks(sim) == []
    with simkit.load(world(PAD, probe(sensor="", more=f"<collision>c</collision>{make}"))) as sim:
        assert touch_ticks(sim) == [102]
        assert not [d for d in sim.diagnostics if d.severity != "note"]
    with pytest.raises(LoadError, match="no collision 'd'"):
        simkit.load(world(PAD, probe(more="<collision>d</collision>")))


def test_a_target_can_be_spawned_later() -> None:
    with simkit.load(world(body("probe", "0 0 5 0 0 0", plugin(), static=True))) as sim:
        assert "SK-SENSOR-044" in {d.code for d in sim.diagnostics}
        assert touch_ticks(sim, 0.1) == []
        sim.spawn(f'<sdf version="1.9">{body("pad", "0 0 5.21 0 0 0", sensor="")}</sdf>')
        (tick,) = touch_ticks(sim, 3.0)
        assert 100 + 45 + 100 < tick < 100 + 45 + 110
        assert (sim.mj_data.tree_asleep < 0).all()


@pytest.mark.parametrize("held", ["sensor", "created"])
def test_a_target_that_rests_on_a_static_probe_stays_in_contact(held: str) -> None:
    """A sleeping target would have no contacts, so the detector keeps it awake."""
    make = "<create_contact_sensor_for_collision>true</create_contact_sensor_for_collision><collision>c</collision>"
    more = plugin(target="top", time=4.0, more="" if held == "sensor" else make)
    base = body("base", "0 0 0.1 0 0 0", more, SENSOR if held == "sensor" else "", static=True)
    with simkit.load(world(base, body("top", "0 0 0.3 0 0 0", sensor=""))) as sim:
        assert touch_ticks(sim, 4.5) == [4002]


def test_reset_and_restore_include_the_state() -> None:
    with simkit.load(world(PAD, probe())) as sim:
        sim.run(0.06)
        snapshot = sim.snapshot()
        assert touch_ticks(sim) == [102]
        assert touch_ticks(sim) == []
        sim.restore(snapshot)
        assert touch_ticks(sim) == [102]
        sim.reset()
        assert touch_ticks(sim) == [102]


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("<target>pad</target>", "", "needs <target>"),
        ("<namespace>probe</namespace>", "", "needs <namespace>"),
        ("<time>0.1</time>", "", "needs <time>"),
        ("<time>0.1</time>", "<time>-1</time>", "a number from 0"),
        ("<namespace>probe</namespace>", "<namespace>???</namespace>", "a topic's name"),
    ],
)
def test_missing_required_elements_are_errors(old: str, new: str, says: str) -> None:
    with pytest.raises(LoadError, match=says):
        simkit.load(world(PAD, probe().replace(old, new)))


def test_two_on_one_model_keep_their_own_targets() -> None:
    second = plugin(target="nothing").replace("probe", "second").replace("<target>nothing", "<target>ceiling")
    both = body("probe", "0 0 0.3 0 0 0", plugin() + second)
    with simkit.load(world(PAD, both)) as sim:
        other = sim.subscribe("/second/touched")
        assert touch_ticks(sim) == [102]
        assert other.messages == []


def test_it_can_be_enabled_by_a_service_as_in_gazebo() -> None:
    with simkit.load(world(PAD, probe(enabled="false"))) as sim:
        assert not touch_ticks(sim)
        assert sim.call("/probe/enable", {"data": True}).success
        assert len(touch_ticks(sim)) == 1
        sim.call("/probe/enable", {"data": True})
        sim.call("/probe/enable", {"data": False})
        assert not touch_ticks(sim)


def test_the_service_enables_all_detectors_of_a_namespace() -> None:
    twice = body("probe", "0 0 0.3 0 0 0", plugin(enabled="false") + plugin(enabled="false", time=0.2))
    with simkit.load(world(PAD, twice)) as sim:
        sim.call("/probe/enable", {"data": True})
        assert len(touch_ticks(sim)) == 2


def test_an_empty_target_is_an_error() -> None:
    with pytest.raises(LoadError, match="found <target></target>; expected a name"):
        simkit.load(world(PAD, probe(target="")))

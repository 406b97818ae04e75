"""Doors and lifts of Open-RMF: motion, states, requests and errors."""

from __future__ import annotations

import math

import pytest

import simkit
from simkit import msgs

BODY = "<inertial><mass>20</mass><inertia><ixx>7</ixx><iyy>8</iyy><izz>2</izz></inertia></inertial>"
LIMITS = "<v_max_door>{v}</v_max_door><a_max_door>0.3</a_max_door><a_nom_door>0.15</a_nom_door>"
LIMITS += "<f_max_door>500</f_max_door>"
LEFT = '<door left_joint_name="hinge" right_joint_name="empty_joint" name="office" type="SwingDoor"/>'
HINGED = f"""<link name="frame"/><joint name="w" type="fixed"><parent>world</parent><child>frame</child></joint>
  <link name="leaf"><pose>0 0 1 0 0 0</pose>{BODY}</link><joint name="hinge" type="revolute"><parent>frame</parent>
  <child>leaf</child><axis><xyz>0 0 1</xyz><limit><lower>-1.5</lower><upper>0</upper></limit></axis></joint>"""


def world(models: str) -> str:
    return f"""<sdf version="1.9"><world name="w"><physics type="ode"><max_step_size>0.004</max_step_size></physics>
      <plugin filename="libdoor.so" name="door"/><plugin filename="liblift.so" name="lift"/>{models}</world></sdf>"""


def door(element: str = LEFT, v: float = 0.5, filename: str = "libdoor.so") -> str:
    plugin = f'<plugin filename="{filename}" name="door">{LIMITS.format(v=v)}{element}</plugin>'
    return world(f'<model name="office">{HINGED}{plugin}</model>')


def request(sim: simkit.Simulation, mode: int = 2, name: str = "office") -> None:
    found = msgs.make("rmf_door_msgs/msg/DoorRequest", door_name=name, requested_mode={"value": mode})
    sim.publish("/door_requests", found)


def modes(subscription: object) -> list[int]:
    return [message.current_mode.value for message in subscription.messages]


@pytest.mark.parametrize(
    ("v", "expected"),
    [
        pytest.param(0.5, 2 * math.sqrt(1.5 / 0.15), marks=pytest.mark.slow),  # accelerates and brakes
        (0.3, 1.5 / 0.3 + 0.3 / 0.15),  # reaches its largest speed
    ],
)
def test_a_door_opens_in_the_time_of_its_speed_and_acceleration(v: float, expected: float) -> None:
    with simkit.load(door(v=v)) as sim:
        states = sim.subscribe("/door_states")
        sim.run(1.0)
        request(sim)
        assert sim.run_until(lambda sim: 2 in modes(states), timeout=20)
        rest = math.sqrt(2 * 0.01 / 0.15)  # time for the last centimetre
        assert sim.time - 1 == pytest.approx(expected - rest, abs=0.03)
        sim.run(1.0)
        assert sim.joint("office::hinge").position == pytest.approx(-1.5, abs=1e-3)
        assert sorted(set(modes(states))) == [0, 1, 2]
        request(sim, 0)
        sim.run(8.0)
        assert sim.joint("office::hinge").position == pytest.approx(0, abs=1e-3) and modes(states)[-1] == 0


def test_the_state_of_a_door_comes_once_a_second_and_at_changes() -> None:
    with simkit.load(door()) as sim:
        states = sim.subscribe("/door_states")
        sim.run(3.5)
        assert [m.door_time.sec for m in states.messages] == [1, 2, 3]
        request(sim)
        sim.run(0.5)
        assert modes(states) == [0, 0, 0, 1, 1] and states.messages[-2].door_time.nanosec % 1_000_000_000 > 500_000_000


def test_a_door_ignores_requests_for_other_doors() -> None:
    with simkit.load(door()) as sim:
        request(sim, name="other")
        sim.run(2.0)
        assert abs(sim.joint("office::hinge").position) < 1e-9


def test_a_held_door_waits_and_opens_when_it_is_free() -> None:
    with simkit.load(door().replace("<f_max_door>500", "<f_max_door>10")) as sim:
        request(sim)
        for _ in range(2000):
            sim.joint("office::hinge").set_effort(40)  # stronger than the door
            sim.step()
        assert abs(sim.joint("office::hinge").position) < 0.01
        fastest = 0.0
        for _ in range(1000):
            sim.step()
            fastest = max(fastest, abs(sim.joint("office::hinge").velocity))
        assert sim.joint("office::hinge").position < -0.5 and fastest < 0.8  # the door does not hurry


def test_a_right_joint_is_closed_at_its_lower_limit() -> None:
    right = '<door left_joint_name="" right_joint_name="hinge"/>'
    with simkit.load(door(right)) as sim:  # begins at the upper limit, and closes
        sim.run(8.0)
        assert sim.joint("office::hinge").position == pytest.approx(-1.5, abs=1e-3)


CABIN = """<link name="cabin"><inertial><mass>800</mass><inertia><ixx>900</ixx><iyy>900</iyy><izz>900</izz></inertia>
  </inertial><collision name="c"><geometry><box><size>2 2 0.1</size></box></geometry></collision></link>
  <joint name="rail" type="prismatic"><parent>world</parent><child>cabin</child><axis><xyz>0 0 1</xyz>
  <limit><lower>-1e8</lower><upper>1e8</upper></limit></axis></joint>"""
LEAF = f"""<model name="CabinDoor"><link name="leaf"><pose>1 0.4 1 0 0 0</pose>{BODY}</link>
  <plugin filename="libregister_component.so" name="c"><component name="Door">{LIMITS.format(v=0.5)}
  <door left_joint_name="empty_joint" right_joint_name="slide"/></component></plugin></model>
  <joint name="slide" type="prismatic"><parent>cabin</parent><child>CabinDoor::leaf</child><axis><xyz>0 1 0</xyz>
  <limit><lower>0</lower><upper>0.8</upper></limit></axis></joint>"""
FLOORS = """<floor name="L1" elevation="0"><door_pair cabin_door="CabinDoor" shaft_door="Shaft1"/></floor>
  <floor name="L2" elevation="5"><door_pair cabin_door="CabinDoor" shaft_door="Shaft2"/></floor>
  <floor name="B1" elevation="-3"/>"""
MOTION = "<v_max_cabin>2</v_max_cabin><a_max_cabin>1.2</a_max_cabin><a_nom_cabin>1</a_nom_cabin>"
MOTION += "<dx_min_cabin>0.001</dx_min_cabin><f_max_cabin>25000</f_max_cabin><cabin_joint_name>rail</cabin_joint_name>"
CRATE = f"""<model name="crate"><pose>0 0 0.35 0 0 0</pose><link name="l">{BODY}<collision name="c"><geometry><box>
  <size>0.5 0.5 0.6</size></box></geometry></collision></link></model>"""


def lift(floors: str = FLOORS, more: str = "", crate: str = "") -> str:
    component = f'<component name="Lift">{MOTION}{more}{floors}</component>'
    plugin = f'<plugin filename="register_component" name="register_component">{component}</plugin>'
    return world(f'{crate}<model name="lift1">{CABIN}{LEAF}{plugin}</model>')


def call(sim: simkit.Simulation, floor: str, doors: int = 2, session: str = "me", kind: int = 1) -> None:
    fields = {"destination_floor": floor, "door_state": doors, "session_id": session, "request_type": kind}
    sim.publish("/lift_requests", msgs.make("rmf_lift_msgs/msg/LiftRequest", lift_name="lift1", **fields))


@pytest.mark.slow
def test_a_lift_moves_with_closed_doors_opens_them_and_carries_a_crate() -> None:
    with simkit.load(lift(crate=CRATE)) as sim:
        states = sim.subscribe("/lift_states")
        sim.run(1.0)
        call(sim, "L2")
        sim.run(4.8)  # 5 m: 5 / 2 + 2 / 1 = 4.5 s
        assert sim.joint("lift1::rail").position == pytest.approx(5, abs=2e-3)
        assert sim.model("crate").pose.position[2] == pytest.approx(5.35, abs=5e-3)
        assert all(m.door_state == 0 for m in states.messages if m.motion_state == 1)
        sim.run(6.0)
        assert sim.joint("lift1::slide").position == pytest.approx(0.8, abs=6e-3)
        last = states.messages[-1]
        assert (last.current_floor, last.destination_floor, last.door_state, last.motion_state) == ("L2", "L2", 2, 0)
        assert (last.session_id, last.current_mode, last.available_floors) == ("me", 2, ["L1", "L2", "B1"])
        call(sim, "B1", kind=0)  # ends the session; closes the doors first
        sim.run(3.0)
        assert sim.joint("lift1::rail").position == pytest.approx(5, abs=2e-3)
        sim.run(10.0)
        assert sim.joint("lift1::rail").position == pytest.approx(-3, abs=2e-3)
        assert states.messages[-1].session_id == "" and sim.joint("lift1::slide").position < 0.01


def test_a_lift_begins_at_its_initial_floor_and_does_not_sink() -> None:
    with simkit.load(lift(more="<initial_floor>L2</initial_floor>")) as sim:
        assert sim.joint("lift1::rail").position == 5
        sim.run(20.0)
        assert sim.joint("lift1::rail").position == pytest.approx(5, abs=1e-3)


def test_a_moving_lift_ignores_requests_and_unknown_floors_are_reported() -> None:
    with simkit.load(lift()) as sim:
        call(sim, "L9")
        sim.run(0.1)
        assert "no floor 'L9'" in [d for d in sim.diagnostics if d.code == "SK-PLUGIN-041"][-1].message
        call(sim, "L2")
        sim.run(1.0)
        call(sim, "B1")
        sim.run(6.0)
        assert sim.joint("lift1::rail").position == pytest.approx(5, abs=2e-3)


def test_a_reset_and_a_restored_snapshot_repeat_the_ride() -> None:
    with simkit.load(lift()) as sim:
        call(sim, "L2")
        sim.run(2.0)
        snapshot = sim.snapshot()
        sim.run(2.0)
        first = sim.joint("lift1::rail").position
        sim.restore(snapshot)
        sim.run(2.0)
        assert sim.joint("lift1::rail").position == first
        sim.reset()
        assert sim.joint("lift1::rail").position == 0
        sim.run(2.0)
        assert abs(sim.joint("lift1::rail").position) < 1e-3


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (door('<door left_joint_name="none" right_joint_name=""/>'), "SK-PLUGIN-003.*no joint 'none'"),
        (door('<door left_joint_name="" right_joint_name=""/>'), "SK-PLUGIN-003.*names no joint"),
        (door(""), "SK-PARAM-001.*door"),
        (door().replace("<limit><lower>-1.5</lower><upper>0</upper></limit>", ""), "SK-PLUGIN-003.*no limits"),
        (lift('<floor name="L1" elevation="high"/>'), "SK-PARAM-002.*elevation"),
        (lift(""), "SK-PARAM-001.*floor"),
        (lift(more="<initial_floor>L7</initial_floor>"), "SK-PARAM-002.*L7"),
        (lift().replace("<upper>1e8", "<upper>3"), "SK-PARAM-002.*'L2' is at 5 m"),
        (lift('<floor name="L1" elevation="0"/><floor name="L1" elevation="1"/>'), "SK-PARAM-002.*listed twice"),
        (lift().replace('name="Lift"', 'name="Lyft"'), "SK-PARAM-002.*Lyft"),
    ],
)
def test_mistakes_are_errors(text: str, code: str) -> None:
    with pytest.raises(simkit.InputError, match=f"(?s){code}"):
        simkit.load(text)

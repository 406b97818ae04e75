"""Elevator of Gazebo: floors, doors, queues and doorways."""

from __future__ import annotations

from itertools import pairwise

import pytest
from lift_worlds import HEIGHTS, elevator, shaft
from plugin_worlds import world

import simkit

CMD, STATE = "/model/lift_1/cmd", "/model/lift_1/state"
PILLAR = """<model name="pillar"><static>true</static><pose>0 -0.4 0.5 0 0 0</pose><link name="l"><collision name="c">
  <geometry><box><size>0.2 0.2 1</size></box></geometry></collision></link></model>"""


def load(parameters: str = "", **options: object) -> simkit.Simulation:
    return simkit.load(world(shaft(elevator(parameters), **options), step=0.01))  # type: ignore[arg-type]


def stops(sim: simkit.Simulation, seconds: float) -> list[int]:
    """Return the floors at which a door opens, in order."""
    found: list[int] = []
    joints = [sim.joint(f"lift_1::door_{k}") for k in range(len(HEIGHTS))]
    for _ in range(round(seconds / 0.1)):
        sim.run(0.1)
        for k, joint in enumerate(joints):
            if joint.position > 0.7 and found[-1:] != [k]:
                found.append(k)
    return found


def test_the_cabin_goes_to_the_floor_and_its_door_opens_waits_and_closes() -> None:
    sim = load("<open_door_wait_duration>2</open_door_wait_duration>")
    lift, door = sim.joint("lift_1::lift"), sim.joint("lift_1::door_1")
    sim.run(0.05)
    sim.publish(CMD, {"data": 1})
    sim.run(1.5)
    assert lift.position == pytest.approx(1.5, abs=0.01)  # at 1 m/s, the limit of its controller
    assert door.position == pytest.approx(0, abs=1e-6)
    sim.run(1.7)
    assert lift.position == pytest.approx(3.0, abs=1e-6)
    # 3.05 s + 0.8 m at 0.5 m/s, then a wait of 2 s; each end is detected at 10 Hz
    sim.run(1.7)
    assert door.position == pytest.approx(0.8, abs=1e-3)
    sim.run(1.5)
    assert door.position == pytest.approx(0.8, abs=1e-3)
    sim.run(2.5)
    assert door.position == pytest.approx(0.0, abs=1e-3)
    assert lift.position == pytest.approx(3.0, abs=1e-6)


def test_a_command_to_the_current_floor_opens_the_door() -> None:
    sim = load()
    sim.publish(CMD, {"data": 0})
    sim.run(2.5)
    assert sim.joint("lift_1::door_0").position == pytest.approx(0.8, abs=1e-3)
    assert sim.joint("lift_1::lift").position == pytest.approx(0, abs=1e-6)


def test_the_floor_nearest_to_the_cabin_is_published() -> None:
    sim = load()
    states = sim.subscribe(STATE)
    sim.publish(CMD, {"data": 2})
    sim.run(7.0)
    floors = [m.data for m in states.messages]
    assert len(floors) == pytest.approx(35, abs=1)  # 5 Hz
    assert floors[0] == 0
    assert floors[-1] == 2
    changes = [(k * 0.2, b) for k, (a, b) in enumerate(pairwise(floors), 2) if a != b]
    # half way between the floors, at 1 m/s
    assert [(round(t, 1), floor) for t, floor in changes] == [(1.6, 1), (4.2, 2)]


def test_floors_on_the_way_are_served_first() -> None:
    sim = load("<open_door_wait_duration>0.5</open_door_wait_duration>")
    for floor in (0, 2, 1):  # the last two come while the first door is open
        sim.publish(CMD, {"data": floor})
        sim.run(0.1)
    assert stops(sim, 25.0) == [0, 1, 2]


def test_repeated_commands_add_one_stop_and_invalid_floors_none() -> None:
    sim = load("<open_door_wait_duration>0.5</open_door_wait_duration>")
    for floor in (1, 2, 2, 3, -1):
        sim.publish(CMD, {"data": floor})
    assert stops(sim, 25.0) == [1, 2]
    left_out = [d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-041"]
    assert [("floor 3" in m, "0 to 2" in m) for m in left_out] == [(True, True), (False, True)]


@pytest.mark.slow
def test_a_blocked_doorway_keeps_the_door_open_and_restarts_the_wait() -> None:
    text = world(shaft(elevator("<open_door_wait_duration>1</open_door_wait_duration>"), lidar=True), PILLAR)
    sim = simkit.load(text)
    door = sim.joint("lift_1::door_0")
    sim.run(0.1)
    sim.publish(CMD, {"data": 0})
    sim.run(8.0)
    assert door.position == pytest.approx(0.8, abs=1e-3)
    sim.remove("pillar")
    sim.run(0.9)
    assert door.position == pytest.approx(0.8, abs=1e-3)
    sim.run(2.5)
    assert door.position == pytest.approx(0.0, abs=1e-3)


def test_runs_after_a_reset_and_a_restore_are_identical() -> None:
    sim = load("<open_door_wait_duration>0.5</open_door_wait_duration>")

    def ride() -> list[float]:
        sim.publish(CMD, {"data": 1})
        found = []
        for _ in range(60):
            sim.run(0.1)
            found += [sim.joint("lift_1::lift").position, sim.joint("lift_1::door_1").position]
        return found

    first = ride()
    sim.reset()
    half = ride()[:60]
    assert half == first[:60]
    sim.reset()
    sim.publish(CMD, {"data": 1})
    sim.run(3.0)
    kept = sim.snapshot()
    sim.run(3.0)
    after = sim.joint("lift_1::door_1").position
    sim.run(5.0)
    sim.restore(kept)
    sim.run(3.0)
    assert sim.joint("lift_1::door_1").position == after


def test_an_idle_elevator_needs_no_callback() -> None:
    sim = load()
    plugin = next(p for p in sim.engine.structure.all_plugins() if type(p).__name__ == "Elevator")
    sim.run(0.1)
    assert plugin.after_step_rate == pytest.approx(1e-9)


def test_two_spawned_elevators_move_independently() -> None:
    sim = simkit.load(world(step=0.01))
    for name, y in (("lift_a", 0), ("lift_b", 5)):
        sim.spawn(f"<sdf version='1.9'>{shaft(elevator(), name=name, pose=f'0 {y} 1 0 0 0.5')}</sdf>")
    sim.publish("/model/lift_b/cmd", {"data": 1})
    sim.run(4.0)
    assert sim.joint("lift_a::lift").position == pytest.approx(0, abs=1e-6)
    assert sim.joint("lift_b::lift").position == pytest.approx(3, abs=1e-6)


def test_all_missing_parts_are_reported_together() -> None:
    wrong = "<floor_link_prefix>storey_</floor_link_prefix><cabin_joint>lfit</cabin_joint><update_rate>-1</update_rate>"
    with pytest.raises(simkit.InputError) as caught:
        load(wrong)
    text = str(caught.value)
    assert "storey_0" in text
    assert "did you mean 'lift'" in text
    assert "update_rate" in text


def test_a_joint_without_a_controller_is_reported() -> None:
    model = shaft(elevator()).replace("JointPositionController", "X").replace("joint-position-controller", "x")
    sim = simkit.load(world(model, step=0.01))
    sim.publish(CMD, {"data": 1})
    sim.run(0.1)
    assert any(
        "no plugin subscribes to the positions" in d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-132"
    )


def test_a_nested_model_with_floors_of_the_same_names_adds_none() -> None:
    inner = '<model name="twin"><pose>0 0 40 0 0 0</pose><link name="floor_0"/><link name="floor_1"/></model>'
    mount = '<joint name="twins" type="fixed"><parent>shaft</parent><child>twin::floor_0</child></joint>'
    bolt = '<joint name="bolt" type="fixed"><parent>shaft</parent><child>twin::floor_1</child></joint>'
    sim = simkit.load(world(shaft(elevator() + inner + mount + bolt), step=0.01))
    sim.publish(CMD, {"data": 2})
    sim.run(8.0)
    assert sim.joint("lift_1::lift").position == pytest.approx(HEIGHTS[2], abs=0.01)

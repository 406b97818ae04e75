"""Infrared signals and docking status of the Create 3 base."""

from __future__ import annotations

import math

import pytest

import simkit

NAMES = """<robot_model_name>create3</robot_model_name><receiver_link_name>ir_omni</receiver_link_name>
  <dock_model_name>standard_dock</dock_model_name><emitter_link_name>halo_link</emitter_link_name>"""
SENSORS = f"""<sensor_0_fov>{2 * math.pi + 0.01}</sensor_0_fov><sensor_0_range>0.1</sensor_0_range>
  <sensor_1_fov>{math.radians(56)}</sensor_1_fov><sensor_1_range>0.3</sensor_1_range>"""
DOCK = """<model name="standard_dock"><static>true</static><link name="dock"/><link name="halo_link">
  <pose>-0.06 0 0 0 0 0</pose></link></model>"""
FIELD, GREEN, RED, BOTH = 161, 164, 168, 172


def world(x: float, y: float, yaw: float, dock: str = DOCK, names: str = NAMES) -> str:
    plugins = "".join(
        f'<plugin name="{name}" filename="libgazebo_ros_create_{name}.so"><ros>'
        f"<remapping>~/out:={name}</remapping></ros>{names}{more}</plugin>"
        for name, more in (("ir_opcode", SENSORS), ("docking_status", ""))
    )
    return f"""<sdf version="1.6"><world name="w">{dock}<model name="create3"><pose>{x} {y} 0 0 0 {yaw}</pose>
      <link name="ir_omni"><gravity>false</gravity><inertial><mass>1</mass></inertial></link>{plugins}</model>
      </world></sdf>"""


@pytest.mark.parametrize(
    ("distance", "bearing", "yaw", "expected"),
    [
        (0.5, 0, math.pi, {(FIELD, 0), (FIELD, 1), (BOTH, 0), (BOTH, 1)}),  # in front, facing the dock
        (0.8, 0, math.pi, {(FIELD, 1), (BOTH, 0), (BOTH, 1)}),  # the force field reaches 0.71 m and 0.91 m
        (1.2, 0, math.pi, {(BOTH, 1)}),  # the buoys reach 1.1 m and 1.3 m
        (1.35, 0, math.pi, set()),
        (0.8, 0, 0, {(BOTH, 0)}),  # only the receiver that looks all round
        (0.9, math.radians(10), math.pi, {(FIELD, 1), (RED, 0), (RED, 1)}),  # left of the dock's axis
        (0.9, math.radians(-10), math.pi, {(FIELD, 1), (GREEN, 0), (GREEN, 1)}),
        (0.9, math.radians(4), math.pi, {(FIELD, 1), (BOTH, 0), (BOTH, 1)}),  # 60 % of 50°: they overlap by 10°
        (0.9, math.radians(26), math.radians(206), {(FIELD, 1)}),
        (0.5, math.pi, 0, {(FIELD, 0), (FIELD, 1)}),  # behind the dock
    ],
)
def test_receivers_see_the_force_field_and_the_buoys(
    distance: float, bearing: float, yaw: float, expected: set[tuple[int, int]]
) -> None:
    x, y = -0.06 + distance * math.cos(bearing), distance * math.sin(bearing)
    with simkit.load(world(x, y, yaw)) as sim:
        found = sim.subscribe("/ir_opcode")
        sim.run(1.0)
        assert {(m.opcode, m.sensor) for m in found.messages} == expected
        assert len(found.messages) == 31 * len(expected)
        assert all(m.header.frame_id == "ir_omni" for m in found.messages)


@pytest.mark.parametrize(
    ("x", "y", "yaw", "visible", "docked"),
    [
        (0.01, 0, math.pi, True, True),  # 0.07 m from the emitter
        (0.02, 0, math.pi, True, False),  # 0.08 m
        (0.01, 0, math.pi - 0.12, True, False),  # turned by 6.9°
        (2.0, 0, math.pi, False, False),
    ],
)
def test_the_robot_is_docked_near_the_emitter_and_faces_it(
    x: float, y: float, yaw: float, visible: bool, docked: bool
) -> None:
    with simkit.load(world(x, y, yaw)) as sim:
        found = sim.subscribe("/docking_status")
        sim.run(3.0)
        assert [(m.dock_visible, m.is_docked) for m in found.messages] == [(visible, docked)] * 3
        assert found.messages[-1].header.frame_id == "base_link"


def test_a_change_is_published_at_once() -> None:
    with simkit.load(world(2.0, 0, math.pi)) as sim:
        found = sim.subscribe("/docking_status")
        sim.run(1.5)
        sim.model("create3").set_pose(simkit.Pose.from_rpy(0.01, 0, 0, 0, 0, math.pi))
        sim.run(0.1)
        assert [m.is_docked for m in found.messages] == [False, True]
        assert found.messages[-1].header.stamp.nanosec == pytest.approx(501_000_000, abs=1_000_000)


def test_without_a_dock_there_are_no_messages() -> None:
    with simkit.load(world(0, 0, 0, dock="")) as sim:
        found = sim.subscribe("/docking_status"), sim.subscribe("/ir_opcode")
        sim.run(1.5)
        assert not found[0].messages and not found[1].messages


def test_a_dock_without_the_emitter_is_reported_and_a_missing_receiver_is_an_error() -> None:
    with simkit.load(world(0, 0, 0, names=NAMES.replace("halo_link", "none"))) as sim:
        sim.subscribe("/ir_opcode")
        sim.run(0.1)
        assert "SK-PLUGIN-003" in [d.code for d in sim.diagnostics]
    with pytest.raises(simkit.InputError, match="SK-PLUGIN-003"):
        simkit.load(world(0, 0, 0, names=NAMES.replace("ir_omni", "none")))

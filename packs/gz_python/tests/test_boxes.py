"""Boxes around links, against those of the geometry."""

from __future__ import annotations

import math

import pytest

from simkit_gz_python.math import AxisAlignedBox, Vector3d
from simkit_gz_python.sim import Link, Model, World
from simkit_gz_python.sim.fixture import TestFixture

WORLD = f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
  <model name="m"><pose>5 0 0 0 0 {math.pi / 4}</pose>
    <link name="body"><collision name="a"><pose>0 0 0.5 0 0 0</pose><geometry><box><size>2 1 1</size></box></geometry>
      </collision><collision name="b"><pose>0 0 2 0 0 0</pose>
      <geometry><sphere><radius>0.25</radius></sphere></geometry></collision></link>
    <link name="bare"/><joint name="j" type="fixed"><parent>body</parent><child>bare</child></joint></model>
  <model name="rock"><static>true</static><pose>0 3 0 0 0 0</pose><link name="stone"><pose>0 0 1 0 0 0</pose>
    <collision name="c"><geometry><cylinder><radius>1</radius><length>4</length></cylinder></geometry></collision>
    <collision name="d"><geometry><plane/></geometry></collision></link></model>
</world></sdf>"""


def corners(box: AxisAlignedBox | None) -> list[float]:
    assert box is not None
    return [*box.min(), *box.max()]


def test_the_box_is_around_all_collisions_and_turns_with_the_link() -> None:
    fixture = TestFixture(WORLD)
    with fixture.server().ecm() as ecm:
        body = Link(Model(World(1).model_by_name(ecm, "m")).link_by_name(ecm, "body"))
        assert body.axis_aligned_box(ecm) is None and body.world_axis_aligned_box(ecm) is None
        assert corners(body.compute_axis_aligned_box(ecm)) == pytest.approx([-1, -0.5, 0, 1, 0.5, 2.25])
        body.enable_bounding_box_checks(ecm)
        reach = 1.5 / math.sqrt(2)  # of the corner (1, 0.5), turned by 45°
        wanted = [5 - reach, -reach, 0, 5 + reach, reach, 2.25]
        assert corners(body.world_axis_aligned_box(ecm)) == pytest.approx(wanted)
        body.enable_bounding_box_checks(ecm, False)
        assert body.axis_aligned_box(ecm) is None


def test_a_static_link_has_a_box_and_a_link_without_collision_an_empty_one() -> None:
    fixture = TestFixture(WORLD)
    with fixture.server().ecm() as ecm:
        stone = Link(Model(World(1).model_by_name(ecm, "rock")).canonical_link(ecm))
        assert corners(stone.compute_axis_aligned_box(ecm)) == pytest.approx([-1, -1, -2, 1, 1, 2])
        stone.enable_bounding_box_checks(ecm)
        assert corners(stone.world_axis_aligned_box(ecm)) == pytest.approx([-1, 2, -1, 1, 4, 3])
        bare = Link(Model(World(1).model_by_name(ecm, "m")).link_by_name(ecm, "bare"))
        bare.enable_bounding_box_checks(ecm)
        world = bare.world_axis_aligned_box(ecm)
        assert world is not None and world.size() == Vector3d() and world == AxisAlignedBox()

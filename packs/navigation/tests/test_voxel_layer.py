"""Voxel layer and point clouds: the same voxels as the loops of Nav2, and a table that the lidar does not see."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from point_clouds import place_camera, send

import simkit
from simkit import msgs
from simkit_navigation.plugins.costmaps.cost_grid import FREE, LETHAL, CostGrid, grid_of_message
from simkit_navigation.plugins.costmaps.ray_cells import RayTracer

WORLD = """<sdf version="1.9"><world name="w"><plugin filename="libsimkit_costmap_2d.so" name="local_costmap">
<resolution>0.05</resolution><origin_x>-1</origin_x><origin_y>-1</origin_y><width>3</width><height>2</height>
<plugins>voxels</plugins>{top}<voxels><plugin>nav2_costmap_2d/VoxelLayer</plugin>
<observation_sources>cloud</observation_sources><z_voxels>10</z_voxels><z_resolution>0.1</z_resolution>
<footprint_clearing_enabled>false</footprint_clearing_enabled>{options}
<cloud><topic>/points</topic><data_type>PointCloud2</data_type>{source}</cloud></voxels></plugin></world></sdf>"""


def world(options: str = "", source: str = "", top: str = "") -> str:
    return WORLD.format(options=options, source=source, top=top)


def costs(sim: simkit.Simulation) -> CostGrid:
    found = grid_of_message(sim.call("/local_costmap/get_costmap").map)
    assert found is not None
    return found


def bresenham(
    start: tuple[float, ...], end: tuple[float, ...], shape: tuple[int, int, int], most: int, least: int
) -> set[tuple[int, int, int]]:
    """Return the cells of a ray as a loop finds them, one step of Bresenham's algorithm after the other."""
    distance = math.dist(start, end)
    if int(distance) < least:
        return set()
    first = [int(a + ((b - a) / distance * least if distance else 0.0)) for a, b in zip(start, end, strict=True)]
    steps = [int(b) - a for a, b in zip(first, end, strict=True)]
    sizes = [abs(step) for step in steps]
    axis = max(range(3), key=lambda number: (sizes[number], -number))
    scale = min(1.0, most / distance) if distance else 1.0
    cell, errors, found = list(first), [sizes[axis] // 2] * 3, {tuple(first)}
    for _ in range(min(int(scale * sizes[axis]), sizes[axis])):
        for number in range(3):
            errors[number] += sizes[number]
            if number == axis or errors[number] >= sizes[axis]:
                cell[number] += 1 if steps[number] > 0 else -1
                errors[number] -= sizes[axis]
        found.add(tuple(cell))
    return {(row, column, level) for column, row, level in found}


@pytest.mark.parametrize(("most", "least"), [(100, 0), (7, 0), (100, 3), (12, 2)])
def test_rays_cross_the_cells_that_a_loop_over_each_ray_finds(most: int, least: int) -> None:
    shape = (20, 30, 8)
    random = np.random.default_rng(4)
    ends = [random.uniform(0, size, 200) for size in (30, 20, 8)]
    ends = [np.concatenate((end, end[:60])) for end in ends]  # some rays are there twice
    start = (11.3, 9.8, 4.4)
    tracer = RayTracer(start, shape, most, least)
    tracer.add([end[:100] for end in ends])
    tracer.add([end[100:] for end in ends])
    touched = tracer.cells()
    expected: set[tuple[int, int, int]] = set()
    for end in zip(*ends, strict=True):
        expected |= bresenham(start, tuple(map(float, end)), shape, most, least)
    assert {tuple(cell) for cell in np.argwhere(touched).tolist()} == expected


def test_points_mark_columns_and_clear_the_voxels_before_them() -> None:
    with simkit.load(world(top="<track_unknown_space>true</track_unknown_space>")) as sim:
        place_camera(sim)
        sim.run(0.1)
        send(sim, [[0.82, 0.01, -0.1], [0.82, 0.51, -0.1]])
        sim.run(0.25)
        grid = costs(sim)
        assert [grid.cost(0.82, 0.01), grid.cost(0.82, 0.51), grid.cost(0.4, 0.01)] == [LETHAL, LETHAL, FREE]
        send(sim, [[1.52, 0.01, -0.19]])  # passes through the first voxel: only this one is free afterwards
        sim.run(0.25)
        grid = costs(sim)
        assert [grid.cost(0.82, 0.01), grid.cost(0.82, 0.51), grid.cost(1.52, 0.01)] == [FREE, LETHAL, LETHAL]
        send(sim, [[1.52, 0.51, 0.35]])  # passes above the second one
        sim.run(0.25)
        assert costs(sim).cost(0.82, 0.51) == LETHAL


def test_a_column_is_an_obstacle_if_enough_of_its_voxels_are_marked() -> None:
    with simkit.load(world("<mark_threshold>1</mark_threshold>")) as sim:
        place_camera(sim)
        sim.run(0.1)
        send(sim, [[0.82, 0.01, 0.0], [0.82, 0.51, 0.0], [0.82, 0.51, 0.1]])
        sim.run(0.25)
        grid = costs(sim)
        assert [grid.cost(0.82, 0.01), grid.cost(0.82, 0.51)] == [FREE, LETHAL]


def test_heights_and_ranges_of_a_source_select_its_points() -> None:
    limits = "<min_obstacle_height>0.1</min_obstacle_height><max_obstacle_height>0.8</max_obstacle_height>"
    limits += "<obstacle_min_range>0.5</obstacle_min_range><obstacle_max_range>1.0</obstacle_max_range>"
    with simkit.load(world(source=limits)) as sim:
        place_camera(sim)
        sim.run(0.1)
        points = {(0.8, 0.5, 0.0): True, (0.8, 0.6, -0.5): False, (0.8, 0.4, 0.3): False, (0.3, 0.0, 0.0): False}
        points[(1.3, 0.0, 0.0)] = False
        send(sim, list(points))
        sim.run(0.25)
        grid = costs(sim)
        assert {point: grid.cost(point[0] + 1e-3, point[1] + 1e-3) == LETHAL for point in points} == points


def test_observations_are_in_effect_as_long_as_they_persist() -> None:
    """With the persistence of 1 s, a point of an earlier cloud is marked again after a later cloud has cleared it."""
    for persistence, expected in ((0.0, FREE), (1.0, LETHAL)):
        source = f"<observation_persistence>{persistence}</observation_persistence>"
        with simkit.load(world(source=source)) as sim:
            place_camera(sim)
            sim.run(0.1)
            send(sim, [[0.82, 0.01, 0.0]])
            sim.run(0.25)
            send(sim, [[1.52, 0.01, 0.0]])
            sim.run(0.25)
            assert costs(sim).cost(0.82, 0.01) == expected


def test_the_voxels_are_published_with_the_bits_of_nav2() -> None:
    with simkit.load(world("<publish_voxel_map>true</publish_voxel_map>")) as sim:
        voxels = sim.subscribe("/local_costmap/voxel_grid", keep=1)
        place_camera(sim)
        sim.run(0.1)
        send(sim, [[0.82, 0.01, 0.0]])
        sim.run(0.25)
        grid = voxels.latest
        columns = np.asarray(grid.data, np.uint32).reshape(grid.size_y, grid.size_x)
        assert (grid.size_x, grid.size_y, grid.size_z) == (60, 40, 10)
        assert columns[20, 36] == 0xFFFF | 1 << (16 + 5)  # 0.55 m is the voxel 5: marked, the others are unknown
        assert columns[20, 25] == 0xFFFF & ~(1 << 5)  # free
        assert columns[0, 0] == 0xFFFF


def test_a_camera_above_the_voxels_is_told_and_marks() -> None:
    with simkit.load(world()) as sim:
        place_camera(sim, 1.2)
        sim.run(0.1)
        send(sim, [[0.82, 0.01, -0.9]])
        sim.run(0.25)
        assert costs(sim).cost(0.82, 0.01) == LETHAL
        (found,) = [item.message for item in sim.diagnostics if item.code == "SK-COSTMAP-001"]
        assert "the sensor of /points is outside of the costmap" in found


def test_a_cloud_that_is_not_valid_is_told_once() -> None:
    with simkit.load(world()) as sim:
        place_camera(sim)
        sim.run(0.1)
        for _ in range(2):
            cloud = {"header": msgs.header(sim.time_ns, "camera"), "width": 1, "height": 1, "point_step": 4}
            sim.advertise("/points", "sensor_msgs/msg/PointCloud2").publish({**cloud, "data": bytes(4)})
            sim.run(0.25)
        found = [item.message for item in sim.diagnostics if item.code == "SK-COSTMAP-001"]
        assert len(found) == 1 and "a point cloud on /points is ignored" in found[0]


def test_a_restored_costmap_continues_with_the_same_cells() -> None:
    """So does another simulation with a pickled snapshot, whose layer holds a cloud that is still in effect."""
    text = world(source="<observation_persistence>1</observation_persistence>")
    with simkit.load(text) as sim, simkit.load(text) as other:
        place_camera(sim)
        sim.run(0.1)
        send(sim, [[0.82, 0.01, 0.0], [0.82, 0.51, 0.0]])
        sim.run(0.25)
        state = sim.snapshot()
        other.restore(pickle.loads(pickle.dumps(state)))
        runs = []
        for each in (sim, sim, other):
            if each is sim:
                sim.restore(state)
            send(each, [[1.52, 0.01, 0.0]])
            each.run(0.25)
            runs.append(costs(each).cells)
        assert np.array_equal(runs[0], runs[1]) and np.array_equal(runs[0], runs[2]) and (runs[0] == LETHAL).sum() == 3

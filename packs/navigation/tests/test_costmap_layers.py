"""Layers of a costmap with range sensors, noise and maps, the services that clear areas, and updates of topics."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from navigation_worlds import place

import simkit
from simkit import msgs
from simkit_navigation.plugins.costmaps.cost_grid import FREE, LETHAL, UNKNOWN, CostGrid, cost_table, grid_of_message
from simkit_navigation.plugins.costmaps.costmap_parameters import costmap_parameters
from simkit_navigation.plugins.costmaps.footprint import cells_within, padded, read_footprint, round_footprint
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

WORLD = """<sdf version="1.9"><world name="w"><plugin filename="libsimkit_costmap_2d.so" name="local_costmap">
<resolution>0.1</resolution><width>4</width><height>3</height><robot_radius>0</robot_radius>
<origin_x>-1</origin_x><origin_y>-1.5</origin_y><publish_frequency>5</publish_frequency>{options}</plugin></world></sdf>"""
OBSTACLES = """<plugins>obstacle_layer</plugins><obstacle_layer><footprint_clearing_enabled>false
</footprint_clearing_enabled></obstacle_layer>"""
RANGE = "<plugins>sonar</plugins><sonar><plugin>nav2_costmap_2d::RangeSensorLayer</plugin>{}</sonar>"


def load(options: str) -> simkit.Simulation:
    return simkit.load(WORLD.format(options=options))


def costs(sim: simkit.Simulation) -> CostGrid:
    found = grid_of_message(sim.call("/local_costmap/get_costmap").map)
    assert found is not None
    return found


def send_scan(sim: simkit.Simulation, *ranges: float) -> None:
    """Publish the ranges of beams at 0°, 90°, 180° and 270°."""
    scan = {"angle_increment": math.pi / 2, "range_min": 0.1, "range_max": 4.0, "ranges": np.array(ranges, np.float32)}
    header = {"frame_id": "base_footprint", "stamp": msgs.time(sim.time_ns)}
    sim.advertise("/scan", "sensor_msgs/msg/LaserScan").publish({"header": header, **scan})


def send_range(sim: simkit.Simulation, reading: float, least: float = 0.05, most: float = 2.0) -> None:
    header = {"frame_id": "base_footprint", "stamp": msgs.time(sim.time_ns)}
    values = {"field_of_view": 0.4, "min_range": least, "max_range": most, "range": reading}
    sim.advertise("/sonar", "sensor_msgs/msg/Range").publish({"header": header, **values})


# ---------------------------------------------------------------------- range sensors


def test_readings_of_a_sonar_mark_their_distance_and_clear_the_cone_before_it() -> None:
    with load("<track_unknown_space>true</track_unknown_space>" + RANGE.format("<topics>/sonar</topics>")) as sim:
        place(sim)
        for _ in range(3):
            send_range(sim, 1.05)
            sim.run(0.25)
        grid = costs(sim)
        assert [grid.cost(1.05, 0.0), grid.cost(0.55, 0.0), grid.cost(0.55, 0.6)] == [LETHAL, FREE, UNKNOWN]
        sim.call("/local_costmap/clear_entirely_local_costmap")
        assert not (costs(sim).cells == LETHAL).any()


def test_the_probability_of_a_cell_follows_the_sensor_model_of_nav2() -> None:
    """One reading of 1 m: the cell at 0.55 m on the axis has the weight λ, so its probability falls to (1 - λ) / 2."""
    with load(RANGE.format("<topics>/sonar</topics>")) as sim:
        place(sim)
        send_range(sim, 1.0)
        sim.run(0.25)
        layer = sim.plugins["local_costmap"].parts["sonar"]
        row, column = layer_cell(sim, 0.55, 0.05)
        away, angle = math.hypot(0.55, 0.05), math.atan2(0.05, 0.55)
        weight = (1 - (1 + math.tanh(2 * (away - 1.2))) / 2) * (1 - (angle / 0.2) ** 2)
        occupied, prior = (1 - weight) / 2, 127 / 254
        expected = occupied * prior / (occupied * prior + (1 - occupied) * (1 - prior))
        assert layer._odds[row, column] == int(254 * expected)


def layer_cell(sim: simkit.Simulation, x: float, y: float) -> tuple[int, int]:
    cell = costs(sim).to_cell(x, y)
    assert cell is not None
    return cell


def test_a_sensor_of_a_fixed_range_marks_with_minus_infinity() -> None:
    options = RANGE.format("<topics>/sonar</topics><clear_on_max_reading>true</clear_on_max_reading>")
    with load(options) as sim:
        place(sim)
        for _ in range(3):
            send_range(sim, -math.inf, 0.85, 0.85)
            sim.run(0.25)
        assert costs(sim).cost(0.85, 0.0) == LETHAL
        for _ in range(3):
            send_range(sim, math.inf, 0.85, 0.85)
            sim.run(0.25)
        assert costs(sim).cost(0.85, 0.0) == FREE
        send_range(sim, 0.5, 0.85, 0.85)
        sim.run(0.25)
        assert "only -inf (object) and inf (none) are valid" in [item.message for item in sim.diagnostics][-1]


# ---------------------------------------------------------------------- noise, maps and parameters


@pytest.mark.parametrize(("connectivity", "least", "kept"), [(8, 2, 5), (8, 3, 3), (4, 2, 3), (8, 1, 6)])
def test_small_groups_of_obstacles_are_removed(connectivity: int, least: int, kept: int) -> None:
    """The map has a row of three obstacles, two that touch at a corner, and one alone."""
    cells = np.zeros((8, 8), np.int8)
    cells[1, 1:4] = cells[5, 5] = cells[6, 6] = cells[6, 1] = 100
    layer = f"<noise><plugin>nav2_costmap_2d::DenoiseLayer</plugin><minimal_group_size>{least}</minimal_group_size>"
    layer += f"<group_connectivity_type>{connectivity}</group_connectivity_type></noise>"
    with load(f"<plugins>static_layer noise</plugins>{layer}") as sim:
        place(sim)
        send_map(sim, cells)
        sim.run(0.25)
        assert (costs(sim).cells == LETHAL).sum() == kept


def send_map(sim: simkit.Simulation, cells: Any) -> None:
    info = {"resolution": 0.1, "width": cells.shape[1], "height": cells.shape[0], "origin": {"orientation": {"w": 1.0}}}
    publisher = sim.advertise("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
    publisher.publish({"header": {"frame_id": "map"}, "info": info, "data": cells.reshape(-1)})


def test_the_occupancy_of_a_map_becomes_a_cost_as_in_nav2() -> None:
    assert cost_table(100, UNKNOWN)[[0, 50, 99, 100, 255]].tolist() == [FREE, FREE, FREE, LETHAL, UNKNOWN]
    assert cost_table(65, FREE, is_trinary=False)[[0, 13, 64, 65, 255]].tolist() == [0, 50, 250, LETHAL, FREE]
    assert cost_table(100, UNKNOWN, unknown_value=50)[[50, 255]].tolist() == [UNKNOWN, LETHAL]


def test_updates_of_a_map_replace_a_rectangle() -> None:
    layer = "<static_layer><subscribe_to_updates>true</subscribe_to_updates></static_layer>"
    with load(f"<plugins>static_layer</plugins>{layer}") as sim:
        place(sim)
        send_map(sim, np.zeros((8, 8), np.int8))
        update = {"header": {"frame_id": "map"}, "x": 2, "y": 3, "width": 2, "height": 1, "data": [100, 100]}
        publisher = sim.advertise("/map_updates", "map_msgs/msg/OccupancyGridUpdate")
        publisher.publish(update)
        publisher.publish({**update, "x": 7})  # does not fit
        sim.run(0.25)
        assert np.argwhere(costs(sim).cells == LETHAL).tolist() == [[3, 2], [3, 3]]
        assert "an update of the map on /map is ignored" in [item.message for item in sim.diagnostics][-1]


def test_cells_outside_of_the_map_keep_their_cost() -> None:
    """The map reaches from x = 0 to 0.8; without track_unknown_space, cells beyond it are free, not unknown."""
    with load("<rolling_window>true</rolling_window><plugins>static_layer</plugins>") as sim:
        place(sim, 0.02, 0.02)
        send_map(sim, np.full((8, 8), 100, np.int8))
        sim.run(0.25)
        grid = costs(sim)
        assert [grid.cost(x, 0.45) for x in (-0.55, 0.45, 1.15)] == [FREE, LETHAL, FREE]


def test_the_footprint_is_padded_along_both_axes() -> None:
    """Nav2's `padFootprint`: a corner moves by the padding along x and along y."""
    node: Any = None
    square = padded(read_footprint(node, "[[0.3, 0.2], [0.3, -0.2], [-0.3, -0.2], [-0.3, 0.2]]", 0.0), 0.05)
    assert square.corners.tolist() == [[0.35, 0.25], [0.35, -0.25], [-0.35, -0.25], [-0.35, 0.25]]
    assert square.inscribed_radius == pytest.approx(0.25)
    disc = padded(round_footprint(0.2), 0.01)
    assert disc.is_round and disc.corners[0].tolist() == pytest.approx([0.21, 0.0])
    assert disc.inscribed_radius == pytest.approx(0.2 * math.cos(math.pi / 16) + 0.01, abs=0.004)


def test_a_polygon_clears_the_cells_that_it_covers() -> None:
    node: Any = None
    outline = read_footprint(node, "[[0.3, 0.1], [0.3, -0.1], [-0.3, -0.1], [-0.3, 0.1]]", 0.0)
    grid = CostGrid(np.zeros((20, 20), np.uint8), 0.1, PlanarPose(-1.0, -1.0, 0.0), "map")
    rows, columns = cells_within(grid, outline, PlanarPose(0.05, 0.05, math.pi / 2))
    assert (rows.min(), rows.max(), columns.min(), columns.max()) == (7, 13, 9, 11)


def test_the_costmap_node_has_the_defaults_of_nav2() -> None:
    found = costmap_parameters(
        {
            "plugins": ["voxel_layer", "odd_layer"],
            "voxel_layer": {"plugin": "nav2_costmap_2d/VoxelLayer", "observation_sources": "scan camera radar"}
            | {"camera": {"data_type": "PointCloud2", "clearing": True}, "radar": {"data_type": "Radar"}},
            "odd_layer": {"plugin": "nav2_costmap_2d::OddLayer"},
            "static_layer": {"plugin": "nav2_costmap_2d::StaticLayer"},
        }
    )
    values, blocks, told = found.values, found.blocks, found.told
    layer = values["voxel_layer"]
    assert isinstance(layer, dict) and layer["max_obstacle_height"] == 2.0
    assert layer["scan"] == {"topic": "scan", "clearing": False, "min_obstacle_height": 0.0, "max_obstacle_height": 0.0}
    assert layer["camera"]["clearing"] and layer["observation_sources"] == "scan camera"
    assert (values["plugins"], values["footprint_padding"]) == (["voxel_layer"], 0.01)
    assert blocks == ["voxel_layer", "scan", "camera"] and "static_layer" not in values
    assert len(told) == 2 and "OddLayer is left out" in told[1] and "the source radar is left out" in told[0]


def test_filters_that_the_launch_file_of_nav2_enables_are_enabled() -> None:
    block = {"plugin": "nav2_costmap_2d::KeepoutFilter", "enabled": "KEEPOUT_ZONE_ENABLED"}
    found = costmap_parameters({"filters": ["zones"], "zones": block})
    values, told = found.values, found.told
    assert values["zones"] == {**block, "enabled": True} and not told


def test_heights_of_a_laser_scan_are_checked() -> None:
    layer = "<plugins>obstacle_layer</plugins><obstacle_layer><scan>{}</scan></obstacle_layer>"
    for limits, expected in (("<min_obstacle_height>0.1</min_obstacle_height>", 0), ("", 1)):
        with load(layer.format(limits)) as sim:  # the scanner is at the height 0
            place(sim)
            send_scan(sim, 1.02, math.inf, math.inf, math.inf)
            sim.run(0.25)
            assert (costs(sim).cells == LETHAL).sum() == expected


@pytest.mark.parametrize(("method", "expected"), [(0, FREE), (1, LETHAL), (2, LETHAL)])
def test_the_combination_method_decides_about_known_cells(method: int, expected: int) -> None:
    """A beam passes an obstacle of the map: method 0 overwrites it, the others keep the larger cost."""
    layer = f"<obstacle_layer><combination_method>{method}</combination_method></obstacle_layer>"
    with load(f"<plugins>static_layer obstacle_layer</plugins>{layer}") as sim:
        place(sim, 0.05, 0.05)
        cells = np.zeros((20, 30), np.int8)
        cells[0, 8] = 100
        send_map(sim, cells)
        send_scan(sim, 1.52, math.inf, math.inf, math.inf)
        sim.run(0.25)
        grid = costs(sim)
        assert (grid.cost(0.85, 0.05), grid.cost(1.57, 0.05)) == (expected, LETHAL)


# ---------------------------------------------------------------------- services and topics


def test_the_services_clear_a_square_or_all_but_a_square() -> None:
    """Obstacles in 0.5 m and 2 m; the scan that is in effect sees neither, so they do not come back."""
    for service, extra, expected in (
        ("clear_around_local_costmap", {}, [FREE, LETHAL]),
        ("clear_except_local_costmap", {}, [LETHAL, FREE]),
        (
            "clear_around_pose_local_costmap",
            {"pose": {"header": {"frame_id": "map"}, "pose": {"position": {"x": 2.0}}}},
            [LETHAL, FREE],
        ),
    ):
        with load(OBSTACLES) as sim:
            place(sim)
            for reach in ((2.02, math.inf), (math.inf, 0.52), (math.inf, math.inf)):
                send_scan(sim, *reach, math.inf, math.inf)
                sim.run(0.25)
            grid = costs(sim)
            assert [grid.cost(0.01, 0.52), grid.cost(2.02, 0.01)] == [LETHAL, LETHAL]
            sim.call(f"/local_costmap/{service}", {"reset_distance": 1.4, **extra})
            grid = costs(sim)
            assert [grid.cost(0.01, 0.52), grid.cost(2.02, 0.01)] == expected, service


def test_without_the_full_costmap_only_changes_are_published() -> None:
    options = f"<always_send_full_costmap>false</always_send_full_costmap><map_vis_z>-0.2</map_vis_z>{OBSTACLES}"
    with load(options) as sim:
        full = sim.subscribe("/local_costmap/costmap")
        updates = sim.subscribe("/local_costmap/costmap_updates")
        raw = sim.subscribe("/local_costmap/costmap_raw_updates")
        place(sim)
        sim.run(0.25)
        send_scan(sim, 1.02, 0.52, math.inf, math.inf)
        sim.run(0.5)
        assert len(full.messages) == 1 and full.latest.info.origin.position.z == pytest.approx(-0.2)
        (update,) = updates.messages
        assert (update.x, update.y, update.width, update.height) == (10, 15, 11, 6)
        assert np.asarray(update.data).reshape(6, 11)[[0, 5], [10, 0]].tolist() == [100, 100]
        assert np.asarray(raw.latest.data).max() == LETHAL


def test_readers_of_a_costmap_follow_its_updates() -> None:
    planner = '</plugin><plugin filename="libsimkit_planner_server.so" name="planner_server"><costmap_topic>'
    planner += "local_costmap/costmap_raw</costmap_topic>"
    options = f"<always_send_full_costmap>false</always_send_full_costmap>{OBSTACLES}{planner}"
    with load(options) as sim:
        place(sim)
        sim.run(0.25)
        send_scan(sim, 1.02, math.inf, math.inf, math.inf)
        sim.run(0.5)
        grid = sim.plugins["planner_server"].grid
        assert np.array_equal(grid.cells, costs(sim).cells) and (grid.cells == LETHAL).sum() == 1


def test_a_late_source_and_a_missing_transform_are_told() -> None:
    source = "<expected_update_rate>0.3</expected_update_rate>"
    timeout = "<initial_transform_timeout>0.5</initial_transform_timeout>"
    layer = f"<plugins>obstacle_layer</plugins><obstacle_layer><scan>{source}</scan></obstacle_layer>"
    with load(timeout + layer) as sim:
        logged = sim.subscribe("/rosout")
        sim.run(1.0)
        assert (
            "no transform from 'base_footprint' to 'map' after 0.5 s" in [item.message for item in sim.diagnostics][-1]
        )
        place(sim)
        sim.run(0.5)
        assert [m.msg for m in logged.messages if "no message on scan" in m.msg]

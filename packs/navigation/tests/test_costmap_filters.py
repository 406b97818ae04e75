"""Filters of a costmap: keep-out zones, speed limits and switches of a mask."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from navigation_worlds import WALL, place, pose, run_until_done
from PIL import Image

import simkit
from simkit_navigation.plugins.costmaps.cost_grid import FREE, LETHAL, CostGrid, grid_of_message

WORLD = """<sdf version="1.9"><world name="w">{models}<plugin filename="libsimkit_costmap_2d.so" name="global_costmap">
<resolution>0.1</resolution><width>6</width><height>4</height><plugins>none</plugins>
<none><plugin>nav2_costmap_2d::DenoiseLayer</plugin></none><filters>zone</filters>
<zone><plugin>nav2_costmap_2d::{kind}</plugin><filter_info_topic>/info</filter_info_topic>{options}</zone>
</plugin>{more}</world></sdf>"""
KEEPOUT, PERCENT, ABSOLUTE, BINARY = range(4)


def load(kind: str, options: str = "", more: str = "", models: str = "") -> simkit.Simulation:
    return simkit.load(WORLD.format(kind=kind, options=options, more=more, models=models))


def send_info(sim: simkit.Simulation, kind: int, base: float = 0.0, multiplier: float = 1.0) -> None:
    """Publish the information about a filter."""
    publisher = sim.advertise("/info", "nav2_msgs/msg/CostmapFilterInfo", latched=True)
    publisher.publish({"type": kind, "filter_mask_topic": "/mask", "base": base, "multiplier": multiplier})


def send_mask(sim: simkit.Simulation, frame: str = "map") -> None:
    """Publish a mask whose columns of 1 m have the occupancy 0, 20, 60, 100 and unknown; it reaches to x = 5."""
    cells = np.tile(np.repeat(np.array([0, 20, 60, 100, -1], np.int8), 10), (40, 1))
    info = {"resolution": 0.1, "width": 50, "height": 40, "origin": {"orientation": {"w": 1.0}}}
    publisher = sim.advertise("/mask", "nav_msgs/msg/OccupancyGrid", latched=True)
    publisher.publish({"header": {"frame_id": frame}, "info": info, "data": cells.reshape(-1)})


def costs(sim: simkit.Simulation) -> CostGrid:
    found = grid_of_message(sim.call("/global_costmap/get_costmap").map)
    assert found is not None
    return found


def drive(sim: simkit.Simulation, *xs: float) -> None:
    """Place the robot at several positions in turn."""
    for x in xs:
        place(sim, x, 1.0)
        sim.run(0.25)


def test_a_keepout_filter_writes_the_costs_of_its_mask() -> None:
    """The cost is 254 % of the occupancy; unknown cells and cells outside of the mask do not change."""
    with load("KeepoutFilter") as sim:
        place(sim)
        send_mask(sim)
        send_info(sim, KEEPOUT)
        sim.run(0.25)
        grid = costs(sim)
        assert [grid.cost(x + 0.5, 1.0) for x in range(6)] == [FREE, 51, 152, LETHAL, FREE, FREE]
        assert sim.call("/global_costmap/zone/toggle_filter", {"data": False}).message == "Disabled"
        sim.run(0.25)
        assert not costs(sim).cells.any()


def test_a_robot_in_a_keepout_zone_may_leave_it() -> None:
    options = "<override_lethal_cost>true</override_lethal_cost><lethal_override_cost>200</lethal_override_cost>"
    with load("KeepoutFilter", options) as sim:
        send_mask(sim)
        send_info(sim, KEEPOUT)
        drive(sim, 3.5)
        assert costs(sim).cost(3.5, 1.0) == 200
        drive(sim, 0.5)
        assert costs(sim).cost(3.5, 1.0) == LETHAL


def test_a_plan_leads_around_a_keepout_zone() -> None:
    planner = '<plugin filename="libsimkit_planner_server.so" name="planner_server"/>'
    with load("KeepoutFilter", more=planner) as sim:
        place(sim, 0.5, 1.0)
        cells = np.zeros((40, 60), np.int8)
        cells[:30, 25:30] = 100
        info = {"resolution": 0.1, "width": 60, "height": 40, "origin": {"orientation": {"w": 1.0}}}
        mask = {"header": {"frame_id": "map"}, "info": info, "data": cells.reshape(-1)}
        lengths, highest = [], []
        for is_there in (False, True):
            if is_there:
                sim.advertise("/mask", "nav_msgs/msg/OccupancyGrid", latched=True).publish(mask)
                send_info(sim, KEEPOUT)
            sim.run(1.1)
            goal = sim.send_goal(
                "/compute_path_to_pose", {"goal": pose(5.0, 1.0), "start": pose(0.5, 1.0), "use_start": True}
            )
            run_until_done(sim, goal, 2.0)
            path = goal.result.path.poses
            lengths.append(len(path))
            highest.append(max(item.pose.position.y for item in path))
        assert highest[0] < 1.3 and highest[1] > 3.0 and lengths[1] > lengths[0]


def test_a_speed_filter_publishes_each_limit_once() -> None:
    with load("SpeedFilter", "<speed_limit_topic>/speed_limit</speed_limit_topic>") as sim:
        limits = sim.subscribe("/speed_limit")
        send_mask(sim)
        send_info(sim, PERCENT, 100.0, -1.0)
        drive(sim, 0.5, 1.5, 1.6, 2.5, 3.5, 4.5, 0.5)
        assert [message.speed_limit for message in limits.messages] == [80.0, 40.0, 0.0]
        assert all(message.percentage and message.header.frame_id == "map" for message in limits.messages)
        send_info(sim, ABSOLUTE, 0.1, 0.01)
        drive(sim, 1.5)
        assert limits.latest.speed_limit == pytest.approx(0.3) and not limits.latest.percentage
        told = [item.message for item in sim.diagnostics if item.code == "SK-COSTMAP-001"]
        assert len(told) == 1 and "an unknown cell of the mask" in told[0]


def test_a_limit_that_is_out_of_range_is_no_limit() -> None:
    with load("SpeedFilter") as sim:
        limits = sim.subscribe("/speed_limit")
        send_mask(sim)
        send_info(sim, PERCENT, 50.0, 1.0)
        drive(sim, 1.5, 2.5)
        assert [message.speed_limit for message in limits.messages] == [70.0, 0.0]
        assert "110 % is out of range" in [item.message for item in sim.diagnostics][-1]


@pytest.mark.parametrize("default", [False, True])
def test_a_binary_filter_flips_its_state_above_the_threshold(default: bool) -> None:
    with load("BinaryFilter", f"<default_state>{str(default).lower()}</default_state>") as sim:
        states = sim.subscribe("/binary_state")
        send_mask(sim)
        send_info(sim, BINARY)
        drive(sim, 0.5, 2.5, 3.5, 4.5, 5.5)  # beyond the mask: the default again
        assert [message.data for message in states.messages] == [default, not default, default]


def test_an_info_of_another_filter_is_told_and_not_used() -> None:
    with load("KeepoutFilter") as sim:
        place(sim)
        send_mask(sim)
        send_info(sim, BINARY)
        sim.run(0.25)
        assert not costs(sim).cells.any()
        assert "a filter info of the type 3 is ignored" in [item.message for item in sim.diagnostics][-1]


def test_a_filter_continues_after_a_reset_and_a_restore() -> None:
    with load("KeepoutFilter") as sim:
        runs = []
        for _ in range(2):
            place(sim)
            sim.run(0.25)
            send_mask(sim)
            send_info(sim, KEEPOUT)
            sim.run(0.25)
            runs.append(costs(sim).cells)
            state = sim.snapshot()
            sim.run(0.5)
            sim.restore(state)
            sim.run(0.25)
            runs.append(costs(sim).cells)
            sim.reset()
        assert runs[0].any() and all(np.array_equal(cells, runs[0]) for cells in runs)


def test_a_pickled_snapshot_has_the_mask() -> None:
    with load("KeepoutFilter") as sim, load("KeepoutFilter") as other:
        place(sim)
        send_mask(sim)
        send_info(sim, KEEPOUT)
        sim.run(0.25)
        other.restore(pickle.loads(pickle.dumps(sim.snapshot())))
        other.run(0.25)
        assert costs(other).cells.any() and np.array_equal(costs(other).cells, costs(sim).cells)


def test_a_controller_obeys_the_limit_of_a_speed_zone() -> None:
    """The mask allows 40 % of the speed from x = 2 to 3, where the controller drives with 40 % of its speed before."""
    controller = '<plugin filename="libsimkit_controller_server.so" name="controller_server"><costmap_topic>'
    controller += "global_costmap/costmap_raw</costmap_topic><odom_frame_id>map</odom_frame_id></plugin>"
    with load("SpeedFilter", more=controller) as sim:
        commands = sim.subscribe("/cmd_vel", keep=1)
        send_mask(sim)
        send_info(sim, PERCENT, 100.0, -1.0)
        speeds = []
        for x in (0.5, 2.5):
            drive(sim, x, x)
            path = {"header": {"frame_id": "map"}, "poses": [pose(x + 0.05 * number, 1.0) for number in range(60)]}
            task = sim.send_goal("/follow_path", {"path": path})
            sim.run(0.2)
            speeds.append(commands.latest.linear.x)
            task.cancel()
            sim.run(0.2)
        assert speeds[1] == pytest.approx(0.4 * speeds[0], rel=0.05) and speeds[0] > 0.1


def write_mask(folder: Path) -> None:
    """Write a mask as a file of map_server: a keep-out zone from x = 2 to 3, light grey up to x = 2."""
    image = np.full((40, 60), 255, np.uint8)
    image[:, :20], image[:, 20:30] = 204, 0
    Image.fromarray(image).save(folder / "mask.pgm")
    lines = ("image: mask.pgm", "mode: scale", "resolution: 0.1", "origin: [0.0, 0.0, 0.0]", "negate: 0")
    (folder / "mask.yaml").write_text("\n".join((*lines, "occupied_thresh: 1.0", "free_thresh: 0.0")))


def test_the_servers_of_nav2_give_the_mask_and_its_meaning(tmp_path: Path) -> None:
    """The nodes of Nav2's tutorial: a map server for the mask, and a filter info server."""
    write_mask(tmp_path)
    with load("KeepoutFilter", "<enabled>true</enabled>", models=WALL) as sim:
        infos = sim.subscribe("/info", keep=1)
        nodes: dict[str, dict[str, Any]] = {
            "map_server": {
                "yaml_filename": str(tmp_path / "mask.yaml"),
                "topic_name": "/keepout_mask",
                "frame_id": "map",
            },
            "costmap_filter_info_server": {"type": 0, "filter_info_topic": "/info", "mask_topic": "/keepout_mask"},
        }
        for name, params in nodes.items():
            sim.add_node(f"nav2_map_server/{name}", params=params)
        manager = {"autostart": True, "node_names": list(nodes)}
        sim.add_node("nav2_lifecycle_manager/lifecycle_manager", params=manager)
        place(sim)
        sim.run(1.0)
        assert infos.latest.filter_mask_topic == "/keepout_mask" and infos.latest.multiplier == 1.0
        grid = costs(sim)
        assert [grid.cost(0.5, 1.0), grid.cost(2.5, 1.0), grid.cost(3.5, 1.0)] == [51, LETHAL, FREE]
        sim.check_nodes()


def test_a_missing_transform_is_told() -> None:
    with load("KeepoutFilter") as sim:
        place(sim)
        send_mask(sim, "nowhere")
        send_info(sim, KEEPOUT)
        sim.run(0.25)
        assert "no transform from 'map' to the frame 'nowhere' of the mask" in [i.message for i in sim.diagnostics][-1]

"""Drive a robot to goals all over a world with Nav2's servers and a parameter file, and draw what it did.

    python benchmarks/navigation_goals.py turtlebot3_house --goals 10 --params-file nav2_params.yaml --picture house.png

A goal is a free cell of the true map at least 0.45 m from walls, 2 m from the goal before and connected with the
start by a way that is 0.35 m from walls; `--way-clearance 0.45` leaves out places under tables between chairs. A goal
is reached if the action succeeds and the true position is within the tolerance of it. The least distance is that of the
robot's centre from an occupied cell of the true map. `--motion home` plays a motion of `play_motion2` first, for a
TIAGo whose arm is stretched out at the start.
"""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

import simkit
from simkit import msgs
from simkit_navigation.navigation_nodes import MAP_MODEL, navigation_nodes, topics_of_robot

CLEARANCE = 0.45  # [m] of a goal from a wall
LINE_CLEARANCE = 0.25  # [m] of the straight lines of --in-sight from a wall
APART = 2.0  # [m] between two goals
LONGEST = 300.0  # [s] for one goal


def goals_of(
    grid: msgs.OccupancyGrid, start: tuple[float, float], count: int, seed: int, way_clearance: float, in_sight: bool
) -> npt.NDArray[np.float64]:
    """Return places in the map [m], shape (count, 2); with `in_sight`, straight lines lead from each to the next."""
    cells = np.asarray(grid.data).reshape(grid.info.height, grid.info.width)
    step, origin = float(f"{grid.info.resolution:.7g}"), grid.info.origin.position
    distance = cv2.distanceTransform((cells == 0).astype(np.uint8), cv2.DIST_L2, 5) * step
    _, labels = cv2.connectedComponents((distance > way_clearance).astype(np.uint8))
    row, column = int((start[1] - origin.y) / step), int((start[0] - origin.x) / step)
    is_good = (distance > CLEARANCE) & (labels == labels[row, column])
    rows, columns = np.nonzero(is_good)
    places = np.column_stack((columns + 0.5, rows + 0.5)) * step + (origin.x, origin.y)
    generator, found = np.random.default_rng(seed), [np.array(start)]
    while len(found) <= count:
        far = places[np.hypot(*(places - found[-1]).T) > (0.5 if in_sight else APART)]
        if in_sight:
            parts = np.linspace(0.0, 1.0, 100)[:, None, None]
            lines = ((found[-1] + parts * (far - found[-1]) - (origin.x, origin.y)) / step).astype(np.intp)
            far = far[(distance[lines[..., 1], lines[..., 0]] > LINE_CLEARANCE).all(axis=0)]
        found.append(far[generator.integers(len(far))])
    return np.array(found[1:])


def drive(sim: simkit.Simulation, goals: npt.NDArray[np.float64], robot: str, tolerance: float) -> tuple[int, Any, Any]:
    """Drive to all goals; return how many were reached, the track, and the last plan."""
    plans = sim.subscribe("/plan", keep=1)
    track, reached, model = [], 0, sim.model(robot)
    sim.run(2.0)
    for x, y in goals:
        pose = {"header": {"frame_id": "map"}, "pose": {"position": {"x": x, "y": y}, "orientation": {"w": 1.0}}}
        task, begun = sim.send_goal("/navigate_to_pose", {"pose": pose}), sim.time
        while not task.is_done and sim.time - begun < LONGEST:
            sim.run(0.2)
            track.append(model.pose.position[:2])
        error = math.dist(model.pose.position[:2], (x, y))
        is_reached = task.is_done and task.status.name == "SUCCEEDED" and error < tolerance
        reached += is_reached
        state = task.status.name if task.is_done else "NOT DONE"
        print(
            f"  ({x:6.2f}, {y:6.2f}): {state} after {sim.time - begun:5.1f} s, {error:.2f} m away {task.reason or ''}"
        )
        if not task.is_done:
            task.cancel()
            sim.run(1.0)
    return reached, np.array(track), plans.messages[-1] if plans.messages else None


def least_distance(grid: msgs.OccupancyGrid, track: npt.NDArray[np.float64]) -> float:
    """Return the least distance of places from the middle of an occupied cell [m]."""
    cells = np.asarray(grid.data).reshape(grid.info.height, grid.info.width)
    step, origin = float(f"{grid.info.resolution:.7g}"), grid.info.origin.position
    distance = cv2.distanceTransform((cells != 100).astype(np.uint8), cv2.DIST_L2, 5) * step
    columns, rows = np.floor((track - (origin.x, origin.y)) / step).astype(np.intp).T
    return float(distance[rows, columns].min())


def play(sim: simkit.Simulation, motion: str) -> None:
    """Play a motion of `play_motion2`."""
    task = sim.send_goal("/play_motion2", {"motion_name": motion, "skip_planning": True})
    while not task.is_done and sim.time < LONGEST:
        sim.run(0.2)
    print(f"  motion {motion}: {task.status.name if task.is_done else 'NOT DONE'} at {sim.time:.1f} s")


def draw(file: str, grid: msgs.OccupancyGrid, track: Any, goals: Any, plan: Any, costs: Any) -> None:
    """Draw map, costs, track, goals and the last plan."""
    cells = np.asarray(grid.data).reshape(grid.info.height, grid.info.width)
    image = np.where(cells == 100, 0, np.where(cells == 0, 255, 205)).astype(np.uint8)
    image = cv2.cvtColor(image, cv2.COLOR_GRAY2BGR)
    if costs is not None and len(costs.data) == cells.size:
        cost = np.asarray(costs.data).reshape(cells.shape).clip(0, 100).astype(np.float64)[..., None] / 100
        image = (image * (1 - 0.5 * cost) + np.array([200, 80, 200]) * 0.5 * cost).astype(np.uint8)
    scale = max(1, 1000 // max(cells.shape))
    image = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_NEAREST)
    image = np.ascontiguousarray(image[::-1])
    step, origin = grid.info.resolution, grid.info.origin.position

    def pixels(points: Any) -> npt.NDArray[np.int32]:
        found = ((np.asarray(points) - (origin.x, origin.y)) / step * scale).astype(np.int32)
        return np.column_stack((found[:, 0], image.shape[0] - 1 - found[:, 1]))

    cv2.polylines(image, [pixels(track)], False, (0, 140, 0), 2)
    if plan is not None:
        points = [(pose.pose.position.x, pose.pose.position.y) for pose in plan.poses]
        cv2.polylines(image, [pixels(points)], False, (200, 60, 0), 1)
    for number, place in enumerate(pixels(goals), 1):
        cv2.circle(image, tuple(map(int, place)), 5, (0, 0, 220), -1)
        cv2.putText(image, str(number), tuple(map(int, place + 7)), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 220), 1)
    cv2.imwrite(file, image)


def main() -> None:
    """Measure one world."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("world")
    parser.add_argument("--robot", default="turtlebot3")
    parser.add_argument("--goals", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--params-file", default=None)
    parser.add_argument("--tolerance", type=float, default=0.4)
    parser.add_argument("--picture", default="")
    parser.add_argument("--way-clearance", type=float, default=0.35, help="of the ways to the goals from walls [m]")
    parser.add_argument("--in-sight", action="store_true", help="straight lines lead from each goal to the next")
    parser.add_argument("--spawn", action="append", default=[], metavar="MODEL:x,y,yaw")
    parser.add_argument("--remap", action="append", default=[], metavar="OLD:=NEW")
    parser.add_argument("--motion", default="", help="motion to play first, such as home")
    options = parser.parse_args()
    files = [options.params_file] if options.params_file else []
    rules = dict(rule.split(":=") for rule in options.remap)
    spawn = [{"model": MAP_MODEL}, *options.spawn]
    with simkit.load(options.world, spawn=spawn, params_files=files) as sim:
        for node in navigation_nodes(params_files=files, remap=topics_of_robot(sim) | rules):
            sim.add_node(**node)
        maps, costs = sim.subscribe("/map", keep=1), sim.subscribe("/global_costmap/costmap", keep=1)
        sim.step()
        if options.motion:
            play(sim, options.motion)
        x, y, _ = sim.model(options.robot).pose.position
        goals = goals_of(
            maps.messages[-1], (x, y), options.goals, options.seed, options.way_clearance, options.in_sight
        )
        begun, cpu = sim.time, time.process_time()
        reached, track, plan = drive(sim, goals, options.robot, options.tolerance)
        cpu, simulated = time.process_time() - cpu, sim.time - begun
        for item in sim.diagnostics:
            if item.code.startswith("SK-NAV"):
                print(f"  {item.code} {item.message}")
        length = float(np.hypot(*np.diff(track, axis=0).T).sum())
        name = Path(options.params_file).name if options.params_file else "default parameters"
        print(f"{options.world}, {name}: {reached} of {len(goals)} goals, {length:.1f} m, {simulated:.0f} s")
        print(f"{least_distance(maps.messages[-1], track):.2f} m from a wall at least")
        print(f"{simulated / cpu:.1f} × real time of CPU")
        if options.picture:
            draw(options.picture, maps.messages[-1], track, goals, plan, costs.messages[-1] if costs.messages else None)


if __name__ == "__main__":
    main()

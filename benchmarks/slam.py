"""Accuracy and speed of SLAM: a corridor of 60 m, the house and the office, each with an odometry that drifts.

python benchmarks/slam.py [loop] [house] [office] [--pictures FOLDER]

Aims: 98 % of the occupied cells are within 5 cm of a true surface, 95 % of the surface that three or more rays have
met is within 10 cm of an occupied cell (as in lab 5), the loop closes below 10 cm, and a run takes an eighth of its
simulated time.
"""

from __future__ import annotations

import argparse
import math
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import simkit
from simkit.sensors.occupancy_map import OccupancyMap
from simkit_navigation.plugins.maps.scan_mapper import MapperSettings, MapScan, ScanMapper
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, planar_of

Floats = npt.NDArray[np.float64]

NEAR, FOUND, SEEN = 0.05, 0.10, 3  # [m] to a surface, [m] to a cell, rays; as in the referee of lab 5
LENGTH, WIDTH, CORRIDOR = 20.0, 10.0, 2.0  # [m] of the middle of the corridor, and its own width
NICHES, NICHE = 4.0, 0.4  # [m] between niches in the outer wall, and their depth
RANGE, NOISE = 3.5, 0.01  # [m] of the LDS-01 of a TurtleBot3
ANGLES = np.linspace(-math.pi, math.pi, 360, endpoint=False)
SENSOR = PlanarPose(-0.064, 0.0, 0.0)
SCALE, DRIFT = 0.03, math.radians(0.5)  # of the odometry: too long by 3 %, and 0.5° more for each metre


def corridor() -> Floats:
    """Return the walls of a corridor around a block: x and y of both ends [m], shape (n, 4)."""
    half, outer = CORRIDOR / 2, []
    corners = [(-half, -half), (LENGTH + half, -half), (LENGTH + half, WIDTH + half), (-half, WIDTH + half)]
    for (x, y), (u, v) in zip(corners, corners[1:] + corners[:1], strict=True):
        length = math.hypot(u - x, v - y)
        dx, dy = (u - x) / length, (v - y) / length
        outer.append((x, y))
        at = NICHES / 2
        while at + 1.0 < length:  # niches, each of another width
            wide = 0.6 + 0.2 * (len(outer) % 3)
            for along, deep in ((at, 0.0), (at, NICHE), (at + wide, NICHE), (at + wide, 0.0)):
                outer.append((x + along * dx + deep * dy, y + along * dy - deep * dx))
            at += NICHES
    inner = [(half, half), (LENGTH - half, half), (LENGTH - half, WIDTH - half), (half, WIDTH - half)]
    walls = [(*a, *b) for ring in (outer, inner) for a, b in zip(ring, ring[1:] + ring[:1], strict=True)]
    return np.array(walls)


def ranges(at: PlanarPose, walls: Floats) -> Floats:
    """Return the distances to the nearest wall."""
    directions = np.column_stack((np.cos(ANGLES + at.yaw), np.sin(ANGLES + at.yaw)))
    begin, along = walls[:, :2] - (at.x, at.y), walls[:, 2:] - walls[:, :2]
    across = directions[:, 0, None] * along[:, 1] - directions[:, 1, None] * along[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = (begin[:, 0] * along[:, 1] - begin[:, 1] * along[:, 0]) / across
        share = (begin[:, 0] * directions[:, 1, None] - begin[:, 1] * directions[:, 0, None]) / across
    is_met = (reach > 0) & (share >= 0) & (share <= 1)
    nearest: Floats = np.where(is_met, reach, np.inf).min(axis=1)
    return np.where(nearest <= RANGE, nearest, np.inf)


def way(step: float) -> list[PlanarPose]:
    """Return poses once around the corridor and 6 m further; the robot turns on the spot in the corners."""
    poses, x, y, yaw = [PlanarPose(0.0, 0.0, 0.0)], 0.0, 0.0, 0.0
    for length in (LENGTH, WIDTH, LENGTH, WIDTH, 6.0):
        for _ in range(round(length / step)):
            x, y = x + step * math.cos(yaw), y + step * math.sin(yaw)
            poses.append(PlanarPose(x, y, yaw))
        if length != 6.0:
            for _ in range(4):
                yaw += math.pi / 8
                poses.append(PlanarPose(x, y, math.remainder(yaw, math.tau)))
    return poses


def loop(pictures: Path | None = None, seed: int = 1) -> tuple[float, float, float]:
    """Map the corridor; return the errors of the odometry, of the last pose and of the worst one [m]."""
    generator, walls, truth = np.random.default_rng(seed), corridor(), way(0.5)
    mapper, odometry, before = ScanMapper(MapperSettings()), truth[0], truth[0]
    closures: list[int] = []
    times: list[float] = []
    for pose in truth:
        moved = before.inverse().compose(pose)
        far = math.hypot(moved.x, moved.y)
        odometry = odometry.compose(PlanarPose(moved.x * (1 + SCALE), moved.y * (1 + SCALE), moved.yaw + DRIFT * far))
        measured = ranges(pose.compose(SENSOR), walls) + generator.normal(0.0, NOISE, len(ANGLES))
        guess = odometry
        if mapper.scans:
            last = mapper.scans[-1]
            guess = last.pose.compose(last.odometry.inverse().compose(odometry))
        begin = time.process_time()
        loops = mapper.loops
        mapper.add_scan(MapScan(measured, ANGLES, RANGE, SENSOR, odometry, guess))
        times.append(time.process_time() - begin)
        if mapper.loops > loops:
            closures.append(len(mapper.scans) - 1)
        before = pose
    errors = [math.hypot(s.pose.x - t.x, s.pose.y - t.y) for s, t in zip(mapper.scans, truth, strict=True)]
    drift = math.hypot(odometry.x - truth[-1].x, odometry.y - truth[-1].y)
    print(f"loop: odometry off by {drift:.2f} m, last pose {errors[-1]:.3f} m, worst pose {max(errors):.3f} m")
    print(f"      loops closed at scans {closures} of {len(truth)}   aim: last pose <= 0.10 m")
    print(f"      {sum(times) / len(truth) * 1e3:.0f} ms a scan, at most {max(times) * 1e3:.0f} ms")
    if pictures:
        picture(mapper.occupancy(), pictures / "loop.png")
    return drift, errors[-1], max(errors)


HOUSE = """<sdf version="1.12" xmlns:simkit="https://simkit" xmlns:experimental="http://sdformat.org/schemas/experimental">
<world name="house"><physics name="step" type="ignored"><max_step_size>0.002</max_step_size></physics>
<include><uri>model://sun</uri></include><include><uri>model://ground_plane</uri></include>
<include><uri>model://turtlebot3_house</uri></include>
<include><uri>model://turtlebot3_burger</uri><name>robot</name><pose>-2 -0.5 0 0 0 0</pose>
<experimental:params><plugin element_id="diff_drive"><simkit:odometry_noise action="add">
<right_radius_error>0.008</right_radius_error><separation_error>0.02</separation_error>
<wheel_variance>2e-5</wheel_variance></simkit:odometry_noise></plugin></experimental:params></include>
<plugin filename="libsimkit_map_server.so" name="truth"><topic_name>/truth/map</topic_name><frame_id>world</frame_id>
<height>0.182</height><resolution>0.01</resolution></plugin></world></sdf>"""
OFFICE = """<sdf version="1.12" xmlns:experimental="http://sdformat.org/schemas/experimental">
<world name="office"><physics name="step" type="ignored"><max_step_size>0.002</max_step_size></physics>
<include><uri>model://sun</uri></include><include><uri>model://ground_plane</uri></include>
<include><uri>model://simple_office</uri></include>
<include><uri>model://tiago_no_arm</uri><name>robot</name><pose>-2.5 0 0 0 0 0</pose>
<experimental:params><sensor element_id="base_laser_link::base_laser" action="modify">
<ray><noise><stddev>0.02</stddev></noise></ray></sensor></experimental:params></include>
<plugin filename="libsimkit_map_server.so" name="truth"><topic_name>/truth/map</topic_name><frame_id>world</frame_id>
<height>0.0945</height><resolution>0.01</resolution></plugin></world></sdf>"""
OFFICE_ODOMETRY = """mobile_base_controller:
  ros__parameters:
    wheel_separation_multiplier: 1.03
    right_wheel_radius_multiplier: 1.01
"""
QUARTER = (3.14, 0.0, 0.5)  # a quarter turn: duration [s], speed [m/s], turning rate [rad/s]
HOUSE_DRIVE = [(20.91, 0.22, 0), QUARTER, (6.82, 0.22, 0), QUARTER, (16.82, 0.22, 0), QUARTER, (6.82, 0.22, 0)]
HOUSE_DRIVE += [(3.14, 0.0, -0.5), (4.09, 0.22, 0), (12.56, 0.0, 0.5)]
OFFICE_DRIVE = [(10.0, 0.5, 0.0), (3.5, 0.0, 0.8), (10.0, 0.5, 0.0), (4.3, 0.0, 0.8)]


def simulated(name: str, pictures: Path | None = None) -> tuple[float, float, float, float]:
    """Map a world of simkit with a node of slam_toolbox, and compare the map with the true one.

    Returns:
        Shares of occupied cells that are true and of the seen surface that is found, and the errors of the pose in the
        map and in the odometry [m].
    """
    is_house = name == "house"
    topic = "/cmd_vel" if is_house else "/mobile_base_controller/cmd_vel_unstamped"
    scan_topic, lidar = ("/scan", "base_scan") if is_house else ("/scan_raw", "base_laser_link")
    options: dict[str, Any] = {}
    if not is_house:
        parameters = Path(tempfile.mkdtemp()) / "odometry.yaml"
        parameters.write_text(OFFICE_ODOMETRY, "utf-8")
        options = {"params_files": [str(parameters)]}
    with simkit.load(HOUSE if is_house else OFFICE, seed=1, **options) as sim:
        sim.add_node("slam_toolbox/async_slam_toolbox_node", params={"scan_topic": scan_topic})
        start = sim.model("robot").pose
        hits: list[Floats] = []

        def on_scan(scan: Any) -> None:
            measured = np.asarray(scan.ranges, float)
            is_hit = np.isfinite(measured) & (measured < scan.range_max)
            pose = sim.model("robot").link(lidar).pose
            angles = scan.angle_min + scan.angle_increment * np.arange(len(measured)) + pose.rpy[2]
            directions = np.column_stack((np.cos(angles), np.sin(angles)))[is_hit]
            hits.append(pose.position[:2] + measured[is_hit, None] * directions)

        sim.tf.open()
        sim.subscribe(scan_topic, on_scan)
        truth = sim.subscribe("/truth/map", keep=1)
        begin, start_time = time.process_time(), sim.time
        for duration, speed, turn in [(0.5, 0.0, 0.0), *(HOUSE_DRIVE if is_house else OFFICE_DRIVE), (1.0, 0.0, 0.0)]:
            for _ in range(round(duration / 0.1)):
                sim.publish(topic, {"linear": {"x": speed}, "angular": {"z": turn}})
                sim.run(0.1)
        used, seconds = time.process_time() - begin, sim.time - start_time
        found = sim.tf.lookup("map", "odom") @ sim.tf.lookup("odom", "base_footprint")
        true = start.inverse() @ sim.model("robot").pose
        wheels = sim.tf.lookup("odom", "base_footprint")
        response = sim.call("/slam_toolbox/dynamic_map")
        occupied, seen, free = judged(response.map, start, truth.latest, hits)
        away, drift = (math.hypot(*(p.position - true.position)[:2]) for p in (found, wheels))
        print(f"{name}: odometry off by {drift:.2f} m, pose {away:.3f} m   {free:.1%} of the free cells are free,")
        print(
            f"      {occupied:.1%} of the occupied cells are true (98 %), {seen:.1%} of the seen surface found (95 %)"
        )
        print(f"      {seconds / used:.1f} x real time ({used:.1f} s of the processor for {seconds:.1f} s)   aim: >= 8")
        if pictures:
            info = response.map.info
            cells = np.asarray(response.map.data, np.int8).reshape(info.height, info.width)
            picture(OccupancyMap(cells, info.resolution, simkit.Pose()), pictures / f"{name}.png")
    return occupied, seen, away, drift


def judged(grid: Any, start: simkit.Pose, truth: Any, hits: list[Floats]) -> tuple[float, float, float]:
    """Return the shares of occupied cells that are true, of the seen surface that is found, and of true free cells."""
    from scipy.ndimage import distance_transform_edt

    info, side = truth.info, truth.info.resolution
    corner = np.array((info.origin.position.x, info.origin.position.y))
    walls = np.asarray(truth.data, np.int8).reshape(info.height, info.width) >= 65
    away = distance_transform_edt(~walls) * side

    def cells(points: Floats) -> tuple[Any, Any]:
        columns, rows = np.floor((points - corner) / side).astype(int).T
        return np.clip(rows, 0, info.height - 1), np.clip(columns, 0, info.width - 1)

    count = np.zeros(walls.shape, int)
    np.add.at(count, cells(np.concatenate(hits)), 1)
    values = np.asarray(grid.data, np.int8).reshape(grid.info.height, grid.info.width)

    def middles(is_chosen: npt.NDArray[np.bool_]) -> Floats:
        rows, columns = np.nonzero(is_chosen)
        points = (np.column_stack((columns, rows)) + 0.5) * grid.info.resolution
        points += (grid.info.origin.position.x, grid.info.origin.position.y)
        return planar_of(start).transform(points)

    marked = np.zeros(walls.shape, bool)
    marked[cells(middles(values >= 65))] = True
    surface = (count >= SEEN) & (away <= side)
    found = distance_transform_edt(~marked)[surface] * side <= FOUND
    free = away[cells(middles(values == 0))] > 0
    return float((away[cells(middles(values >= 65))] <= NEAR).mean()), float(found.mean()), float(free.mean())


def picture(grid: OccupancyMap, file: Path) -> None:
    from PIL import Image

    grey = np.where(grid.cells < 0, 205, np.where(grid.cells >= 65, 0, 254)).astype(np.uint8)[::-1]
    image = Image.fromarray(grey)
    image.resize((image.width * 3, image.height * 3), 0).save(file)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", default=["loop", "house", "office"])
    parser.add_argument("--pictures", type=Path)
    values = parser.parse_args()
    for name in values.parts:
        if name == "loop":
            loop(values.pictures)
        else:
            simulated(name, values.pictures)


if __name__ == "__main__":
    main()

"""Simultaneous localisation and mapping in the plane: scan matching, loop closure and a graph of poses.

The steps are those of Karto, the mapper of slam_toolbox. Each scan is matched with the last scans and with those that
are linked to them nearby. Chains of scans that are near, but not linked, are candidates for a loop: the newest scans
are searched in a large space around their pose, and a match adds an edge to the graph. All poses are then optimised.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, fields
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.float_sum import float_sum
from simkit.sensors.occupancy_map import OccupancyMap
from simkit_navigation.plugins.maps.beam_counts import BeamCounts
from simkit_navigation.plugins.maps.correlation_matcher import CorrelationMatcher, Covariance, Match, SearchRules
from simkit_navigation.plugins.maps.line_refinement import refine
from simkit_navigation.plugins.maps.pose_graph import Edge, information_of, optimised, residual
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

Floats = npt.NDArray[np.float64]

_NEIGHBOUR: Final = 2  # points between which the direction of a surface is measured
_SURFACE: Final = 0.5  # [m] of the longest distance between points of one surface
_QUERY_REACH: Final = 2.0  # [m] around the newest scan, of scans that are searched together for a loop
_QUERY_CELL: Final = 0.05  # [m] in which one point of them is enough
_MOST_REFERENCES: Final = 30  # linked scans with which a scan is matched
_CLEAR: Final = 0.2  # [m] standard deviation of a loop search above which its covariance counts
_LARGEST_STRAIN: Final = (0.4, 0.35)  # [m], [rad] by which a closed loop may contradict one edge
_LONGEST: Final = 200.0  # [m] of a beam in the map
_STILL: Final = (0.002, 0.0005)  # [m], [rad] by which a scan may move without being drawn anew


@dataclass(frozen=True)
class MapperSettings:
    """Parameters of slam_toolbox that its mapper has, with the defaults of `slam_mapper.cpp`."""

    resolution: float = 0.05
    max_laser_range: float = 80.0
    min_laser_range: float = 0.0
    use_scan_matching: bool = True
    use_scan_barycenter: bool = True
    scan_buffer_size: int = 10
    scan_buffer_maximum_scan_distance: float = 10.0
    link_match_minimum_response_fine: float = 0.1
    link_scan_maximum_distance: float = 1.5
    do_loop_closing: bool = True
    loop_search_maximum_distance: float = 3.0
    loop_match_minimum_chain_size: int = 10
    loop_match_maximum_variance_coarse: float = 3.0
    loop_match_minimum_response_coarse: float = 0.35
    loop_match_minimum_response_fine: float = 0.45
    correlation_search_space_dimension: float = 0.5
    correlation_search_space_resolution: float = 0.01
    correlation_search_space_smear_deviation: float = 0.1
    loop_search_space_dimension: float = 8.0
    loop_search_space_resolution: float = 0.05
    loop_search_space_smear_deviation: float = 0.03
    rules: SearchRules = field(default_factory=SearchRules)


@dataclass(eq=False)
class MapScan:
    """Scan of the map.

    Attributes:
        ranges: ranges [m]; NaN for no measurement, infinite for nothing within the range.
        angles: directions in the frame of the sensor [rad].
        limit: longest range of the sensor [m].
        sensor: pose of the sensor in the frame of the robot.
        odometry: pose of the robot in the odometry.
        pose: pose of the robot in the map.
        points: ends of the rays that met something, in the frame of the sensor [m].
        centre: mean of the points.
    """

    ranges: Floats
    angles: Floats
    limit: float
    sensor: PlanarPose
    odometry: PlanarPose
    pose: PlanarPose
    is_hit: npt.NDArray[np.bool_] = field(init=False)
    points: Floats = field(init=False)
    centre: tuple[float, float] = field(init=False)

    def use_ranges(self, least: float, most: float) -> None:
        """Find the points, within a least and a largest range [m]."""
        self.limit = min(self.limit, most, _LONGEST)
        is_valid = np.isfinite(self.ranges) & np.isfinite(self.angles)
        with np.errstate(invalid="ignore"):
            self.is_hit = is_valid & (self.ranges > max(least, 0.0)) & (self.ranges <= self.limit)
        reach, angles = self.ranges[self.is_hit], self.angles[self.is_hit]
        self.points = np.column_stack((np.cos(angles) * reach, np.sin(angles) * reach))
        count = max(len(reach), 1)
        self.centre = (float_sum(self.points[:, 0].tolist()) / count, float_sum(self.points[:, 1].tolist()) / count)

    @property
    def sensor_pose(self) -> PlanarPose:
        """Pose of the sensor in the map."""
        return self.pose.compose(self.sensor)

    def beams(self) -> tuple[Floats, npt.NDArray[np.bool_]]:
        """Return the ends of all beams in the frame of the sensor, and whether each met something."""
        with np.errstate(invalid="ignore"):
            is_used = self.is_hit | ((self.ranges > self.limit) & np.isfinite(self.angles))
        reach = np.where(self.is_hit, self.ranges, self.limit)[is_used]
        angles = self.angles[is_used]
        return np.column_stack((np.cos(angles) * reach, np.sin(angles) * reach)), self.is_hit[is_used]


class ScanMapper:
    """Map that grows with each scan.

    Args:
        settings: parameters.

    Attributes:
        scans: scans of the map, the nodes of the graph.
        edges: edges of the graph.
        covariance: of the last match.
        response: of the last match, 0 to 1.
        loops: number of closed loops.
    """

    def __init__(self, settings: MapperSettings) -> None:
        self.settings = settings
        self.scans: list[MapScan] = []
        self.edges: list[Edge] = []
        self.covariance: Covariance = (1.0, 0.0, 1.0, 1.0)
        self.response = 1.0
        self.loops = 0
        self._links: list[set[int]] = []
        self._first_running = 0  # scans before a gap in the odometry are no neighbours of those after it
        self._map = BeamCounts(settings.resolution)
        self._drawn: list[PlanarPose] = []  # pose of the sensor with which each scan is in the map
        rules, s = settings.rules, settings
        self._matcher = CorrelationMatcher(
            s.correlation_search_space_dimension,
            s.correlation_search_space_resolution,
            s.correlation_search_space_smear_deviation,
            rules,
        )
        self._loop_matcher = CorrelationMatcher(
            s.loop_search_space_dimension, s.loop_search_space_resolution, s.loop_search_space_smear_deviation, rules
        )

    # ------------------------------------------------------------------ scans

    def add_scan(self, scan: MapScan) -> PlanarPose:
        """Match a scan whose pose is a guess, add it to the map, close loops, and return the pose of the robot."""
        scan.use_ranges(self.settings.min_laser_range, self.settings.max_laser_range)
        index = len(self.scans)
        running = list(self._running())
        near: list[int] = []
        if running:
            near = self._linked(index - 1, scan, self.settings.link_scan_maximum_distance)
            near = [k for k in near if k not in running][-_MOST_REFERENCES:]
            self._match(scan, [*near, *running])
        self._append(scan)
        if running:
            self._connect(index - 1, index, self.covariance)
            if near and self.response > self.settings.link_match_minimum_response_fine:
                self._connect(min(near, key=lambda k: (self._distance(k, scan), k)), index, self.covariance)
        if self.settings.do_loop_closing:
            self._close_loops(index)
        return scan.pose

    def add_far_scan(self, scan: MapScan) -> PlanarPose:
        """Add the first scan of a new part of the odometry: its guess may be wrong by the size of the loop search."""
        scan.use_ranges(self.settings.min_laser_range, self.settings.max_laser_range)
        near = self._nearest(scan)
        self._match_in_large_space(scan, near)
        index = len(self.scans)
        self._append(scan)
        self._first_running = index
        if near:
            self._connect(near[0], index, self.covariance)
        return scan.pose

    def localise(self, scan: MapScan, is_far: bool = False) -> PlanarPose:
        """Match a scan with the map without adding it; return the pose of the robot.

        Args:
            scan: scan, whose pose is a guess.
            is_far: whether the guess may be wrong by the size of the loop search.
        """
        scan.use_ranges(self.settings.min_laser_range, self.settings.max_laser_range)
        near = self._nearest(scan)
        if is_far:
            self._match_in_large_space(scan, near)
        else:
            self._match(scan, near)
        return scan.pose

    def restore(self, scans: list[MapScan], edges: list[Edge]) -> None:
        """Replace the map by the scans and the edges of a stored one."""
        self.__init__(self.settings)  # type: ignore[misc]
        for scan in scans:
            scan.use_ranges(self.settings.min_laser_range, self.settings.max_laser_range)
            self._append(scan)
        for edge in edges:
            self._add_edge(edge)
        self._first_running = len(scans)

    def move(self, poses: dict[int, PlanarPose]) -> None:
        """Move nodes of the graph by hand, and optimise all poses from there."""
        for index, pose in poses.items():
            self.scans[index].pose = pose
        self._use_poses(optimised([scan.pose for scan in self.scans], self.edges))

    def _append(self, scan: MapScan) -> None:
        self.scans.append(scan)
        self._links.append(set())

    def _add_edge(self, edge: Edge) -> None:
        self.edges.append(edge)
        self._links[edge.first].add(edge.second)
        self._links[edge.second].add(edge.first)

    def _connect(self, first: int, second: int, covariance: Covariance, pose: PlanarPose | None = None) -> None:
        """Add an edge; its pose is that of both scans in the map, or `pose` for the second one."""
        begin, end = self.scans[first].pose, pose or self.scans[second].pose
        information = information_of(covariance, begin.yaw)
        self._add_edge(Edge(first, second, begin.inverse().compose(end), information, pose is not None))

    # ------------------------------------------------------------------ matching

    def _running(self) -> Iterator[int]:
        """Yield the last scans, within the size of the buffer and the distance of its ends."""
        settings, count = self.settings, len(self.scans)
        for index in range(max(self._first_running, count - settings.scan_buffer_size), count):
            if self._distance(index, self.scans[-1]) <= settings.scan_buffer_maximum_scan_distance:
                yield index

    def _nearest(self, scan: MapScan) -> list[int]:
        """Return the scans of the map that are nearest to a scan."""
        order = sorted(range(len(self.scans)), key=lambda k: (self._distance(k, scan), k))
        return order[: max(self.settings.scan_buffer_size, 10)]

    def _reference(self, scan: MapScan) -> tuple[float, float]:
        """Return the position of a scan by which distances are measured."""
        pose = scan.sensor_pose
        if not self.settings.use_scan_barycenter:
            return pose.x, pose.y
        centre = pose.compose(PlanarPose(*scan.centre, 0.0))
        return centre.x, centre.y

    def _distance(self, index: int, scan: MapScan) -> float:
        (x, y), (u, v) = self._reference(self.scans[index]), self._reference(scan)
        return math.hypot(x - u, y - v)

    def _linked(self, start: int, scan: MapScan, most: float) -> list[int]:
        """Return scans within a distance of a scan that edges within this distance connect to the scan `start`."""
        seen, waiting = {start}, [start]
        while waiting:
            for index in self._links[waiting.pop()]:
                if index not in seen and self._distance(index, scan) <= most:
                    seen.add(index)
                    waiting.append(index)
        return sorted(seen)

    def _match(self, scan: MapScan, indices: Iterable[int]) -> None:
        """Give a scan the pose near its guess that agrees best with other scans."""
        if not self.settings.use_scan_matching:
            return
        self._use(scan, self._fine(scan.sensor_pose, scan.points, indices))

    def _match_in_large_space(self, scan: MapScan, indices: list[int]) -> None:
        guess = scan.sensor_pose
        found = self._loop_matcher.match(guess, scan.points, self._points(indices), is_penalised=False)
        if found.response > 0.0:
            found = self._fine(found.pose, scan.points, indices, is_penalised=False)
        self._use(scan, found)

    def _fine(self, guess: PlanarPose, points: Floats, indices: Iterable[int], is_penalised: bool = True) -> Match:
        """Return the match of points with other scans near a guess."""
        visible = self._visible(indices, guess)
        found = self._matcher.match(guess, points, visible, is_penalised)
        return found._replace(pose=refine(found.pose, points, visible))

    def _use(self, scan: MapScan, found: Match) -> None:
        self.response, self.covariance = found.response, found.covariance
        if found.response > self.settings.link_match_minimum_response_fine:
            scan.pose = found.pose.compose(scan.sensor.inverse())

    def _points(self, indices: Iterable[int]) -> Floats:
        """Return the points of scans in the map."""
        parts = [self.scans[k].sensor_pose.transform(self.scans[k].points) for k in indices]
        return np.concatenate(parts) if parts else np.zeros((0, 2))

    def _visible(self, indices: Iterable[int], sensor: PlanarPose) -> Floats:
        """Return the points of scans in the map on surfaces whose front a sensor sees: a thin wall has two sides."""
        parts = []
        for index in indices:
            scan = self.scans[index]
            pose = scan.sensor_pose
            points = pose.transform(scan.points)
            if len(points) > 2 * _NEIGHBOUR:
                padded = np.concatenate((points[-_NEIGHBOUR:], points, points[:_NEIGHBOUR]))
                along = padded[2 * _NEIGHBOUR :] - padded[: -2 * _NEIGHBOUR]
                front, side = (
                    along[:, 0] * (at.y - points[:, 1]) - along[:, 1] * (at.x - points[:, 0]) for at in (pose, sensor)
                )
                is_surface = np.hypot(along[:, 0], along[:, 1]) < _SURFACE
                points = points[~is_surface | ((front > 0.0) == (side > 0.0))]
            parts.append(points)
        return np.concatenate(parts) if parts else np.zeros((0, 2))

    # ------------------------------------------------------------------ loops

    def _close_loops(self, index: int) -> None:
        """Search the newest scans in each chain of scans that is near, but not linked."""
        settings = self.settings
        for chain in self._candidates(index):
            scan = self.scans[index]
            guess, query = scan.sensor_pose, self._query(index)
            coarse = self._loop_matcher.match(guess, query, self._points(chain), is_penalised=False)
            xx, _, yy, _ = coarse.covariance
            if coarse.response < settings.loop_match_minimum_response_coarse:
                continue
            if max(xx, yy) > settings.loop_match_maximum_variance_coarse:
                continue
            fine = self._fine(coarse.pose, query, chain, is_penalised=False)
            if fine.response < settings.loop_match_minimum_response_fine:
                continue
            covariance = coarse.covariance if max(xx, yy) > _CLEAR**2 else fine.covariance
            pose = fine.pose.compose(scan.sensor.inverse())
            nearest = min(
                chain, key=lambda k: (math.hypot(self.scans[k].pose.x - pose.x, self.scans[k].pose.y - pose.y), k)
            )
            self._close_loop(nearest, index, covariance, pose)

    def _candidates(self, index: int) -> list[list[int]]:
        """Return chains of consecutive scans near a scan that edges do not connect to it nearby."""
        settings, scan = self.settings, self.scans[index]
        most = settings.loop_search_maximum_distance
        linked = set(self._linked(index, scan, most))
        chains, chain = [], []
        for k in range(index):
            if k not in linked and self._distance(k, scan) <= most:
                chain.append(k)
                continue
            if len(chain) >= settings.loop_match_minimum_chain_size and k not in linked:
                chains.append(chain)
            chain = []
        return chains

    def _query(self, index: int) -> Floats:
        """Return the points of the newest scans near the last one, in the frame of its sensor, one in each small cell.

        One scan of a corridor is like every other one; several show its corners and niches.
        """
        scan = self.scans[index]
        first = max(self._first_running, index + 1 - self.settings.scan_buffer_size)
        near = [k for k in range(first, index + 1) if self._distance(k, scan) <= _QUERY_REACH]
        points = scan.sensor_pose.inverse().transform(self._points(near))
        cells = np.floor(points / _QUERY_CELL).astype(np.int64)
        _, kept = np.unique(cells, axis=0, return_index=True)
        return points[np.sort(kept)]

    def _close_loop(self, first: int, second: int, covariance: Covariance, pose: PlanarPose) -> None:
        """Add the edge of a loop and optimise all poses, unless that contradicts the edges."""
        self._connect(first, second, covariance, pose)
        poses = optimised([scan.pose for scan in self.scans], self.edges)
        if any(self._is_strained(edge, poses) for edge in self.edges):
            edge = self.edges.pop()
            self._links[edge.first].discard(edge.second)
            self._links[edge.second].discard(edge.first)
            return
        self.loops += 1
        self._use_poses(poses)

    @staticmethod
    def _is_strained(edge: Edge, poses: list[PlanarPose]) -> bool:
        x, y, turn = residual(edge, poses[edge.first], poses[edge.second])
        return math.hypot(x, y) > _LARGEST_STRAIN[0] or abs(turn) > _LARGEST_STRAIN[1]

    def _use_poses(self, poses: list[PlanarPose]) -> None:
        for scan, pose in zip(self.scans, poses, strict=True):
            scan.pose = pose

    # ------------------------------------------------------------------ map

    def occupancy(self) -> OccupancyMap:
        """Return the map: 100 for occupied cells, 0 for free ones, -1 for cells that few beams have crossed."""
        for index, scan in enumerate(self.scans):
            pose = scan.sensor_pose
            if index == len(self._drawn):
                self._draw(scan, pose, 1)
                self._drawn.append(pose)
            elif _has_moved(self._drawn[index], pose):
                self._draw(scan, self._drawn[index], -1)
                self._draw(scan, pose, 1)
                self._drawn[index] = pose
        return self._map.occupancy()

    def _draw(self, scan: MapScan, pose: PlanarPose, sign: int) -> None:
        ends, is_hit = scan.beams()
        self._map.add((pose.x, pose.y), pose.transform(ends), is_hit, sign)


def _has_moved(before: PlanarPose, after: PlanarPose) -> bool:
    """Return whether a scan has to be drawn anew."""
    far, turned = _STILL
    return math.hypot(after.x - before.x, after.y - before.y) > far or abs(after.yaw - before.yaw) > turned


SETTING_NAMES: Final = frozenset(
    [f.name for f in fields(MapperSettings) if f.name != "rules"] + [f.name for f in fields(SearchRules)]
)
"""Names of the parameters of slam_toolbox that the mapper has."""

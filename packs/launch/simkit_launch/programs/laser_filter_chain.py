"""laser_filters' chain of filters for laser scans."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from republisher import run
from sensor_msgs.msg import LaserScan

from simkit_launch.program_simulation import ros1_parameter

Parameters = Mapping[str, Any]
Filter = Callable[[Any, Parameters], object]


def within_range(scan: Any, params: Parameters) -> Any:
    """Replace the ranges outside two limits."""
    lower, upper = float(params.get("lower_threshold", 0.0)), float(params.get("upper_threshold", 100000.0))
    below = float(params.get("lower_replacement_value", math.nan))
    above = float(params.get("upper_replacement_value", math.nan))
    ranges = np.array(scan.ranges)
    scan.ranges = np.where(ranges <= lower, below, np.where(ranges >= upper, above, ranges)).tolist()
    return scan


def within_angles(scan: Any, params: Parameters) -> Any:
    """Cut a scan to a sector."""
    lower, upper = float(params["lower_angle"]), float(params["upper_angle"])
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    inside = np.flatnonzero((angles >= lower) & (angles <= upper))
    if len(inside):
        scan.ranges = np.array(scan.ranges)[inside].tolist()
        scan.intensities = np.array(scan.intensities)[inside].tolist() if len(scan.intensities) else []
        scan.angle_min, scan.angle_max = float(angles[inside[0]]), float(angles[inside[-1]])
    return scan


def without_angles(scan: Any, params: Parameters) -> Any:
    """Remove the ranges of a sector; the other ranges keep their places."""
    lower, upper = float(params["lower_angle"]), float(params["upper_angle"])
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    value = math.nan if params.get("replace_with_nan", False) else scan.range_max + 1.0
    scan.ranges = np.where((angles >= lower) & (angles <= upper), value, np.array(scan.ranges)).tolist()
    return scan


FILTERS: Mapping[str, Filter] = {
    "LaserScanRangeFilter": within_range,
    "LaserScanAngularBoundsFilter": within_angles,
    "LaserScanAngularBoundsFilterInPlace": without_angles,
}


class FilterChain(Node):
    """Node that publishes `scan` after its filters as `scan_filtered`."""

    def __init__(self) -> None:
        super().__init__(
            "scan_to_scan_filter_chain",
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
        )
        self._filters: list[tuple[Filter, Parameters]] = []
        for kind, params in self._described():
            plain = kind.rpartition("/")[2].rpartition("::")[2]
            if plain in FILTERS:
                self._filters.append((FILTERS[plain], params))
            else:
                known = ", ".join(FILTERS)
                self.get_logger().warning(f"the filter {kind} does not exist here and is left out; there are: {known}")
        self._publisher = self.create_publisher(LaserScan, "scan_filtered", 10)
        self.create_subscription(LaserScan, "scan", self._publish, qos_profile_sensor_data)

    def _described(self) -> list[tuple[str, Parameters]]:
        """Return type and parameters of each filter: `filter1`, `filter2`, … or the list of ROS 1."""
        listed = ros1_parameter(self.get_fully_qualified_name(), "scan_filter_chain")
        if listed:
            return [(str(each.get("type", "")), each.get("params", {})) for each in listed]
        described = []
        while True:
            values = self.get_parameters_by_prefix(f"filter{len(described) + 1}")
            if "type" not in values:
                return described
            params = {n.removeprefix("params."): p.value for n, p in values.items() if n.startswith("params.")}
            described.append((str(values["type"].value), params))

    def _publish(self, scan: Any) -> None:
        for function, params in self._filters:
            scan = function(scan, params)
        self._publisher.publish(scan)


def main() -> None:
    """Run the node."""
    rclpy.init()
    run(FilterChain())


if __name__ == "__main__":
    main()

"""Point clouds of laser scans."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from simkit_nodes.ros_modules.sensor_msgs_py.point_cloud2 import PointField, create_cloud

__all__ = ["LaserProjection"]


class LaserProjection:
    """Converter of laser scans."""

    LASER_SCAN_INVALID: Final = -1.0
    LASER_SCAN_MIN_RANGE: Final = -2.0
    LASER_SCAN_MAX_RANGE: Final = -3.0

    class ChannelOption:
        """Fields of the point cloud besides x, y and z."""

        NONE: Final = 0x00
        INTENSITY: Final = 0x01
        INDEX: Final = 0x02
        DISTANCE: Final = 0x04
        TIMESTAMP: Final = 0x08
        VIEWPOINT: Final = 0x10
        DEFAULT: Final = INTENSITY | INDEX

    def projectLaser(
        self, scan_in: Any, range_cutoff: float = -1.0, channel_options: int = ChannelOption.DEFAULT
    ) -> Any:
        """Return a `sensor_msgs.msg.PointCloud2` with the points of a scan, in the frame of the scan.

        Args:
            scan_in: `sensor_msgs.msg.LaserScan`.
            range_cutoff: largest distance [m]; that of the scan if it is negative.
            channel_options: sum of `ChannelOption`: further fields.
        """
        ranges = np.asarray(scan_in.ranges, np.float64)
        numbers = np.arange(len(ranges))
        angles = scan_in.angle_min + numbers * scan_in.angle_increment
        limit = scan_in.range_max if range_cutoff < 0 else min(range_cutoff, scan_in.range_max)
        is_valid = (ranges < limit) & (ranges >= scan_in.range_min)
        columns: dict[str, Any] = {"x": ranges * np.cos(angles), "y": ranges * np.sin(angles), "z": 0.0 * angles}
        options = self.ChannelOption
        if channel_options & options.INTENSITY and len(scan_in.intensities):
            columns["intensity"] = np.asarray(scan_in.intensities)
        if channel_options & options.INDEX:
            columns["index"] = numbers
        if channel_options & options.DISTANCE:
            columns["distances"] = ranges
        if channel_options & options.TIMESTAMP:
            columns["stamps"] = numbers * scan_in.time_increment
        if channel_options & options.VIEWPOINT:
            columns |= dict.fromkeys(("vp_x", "vp_y", "vp_z"), 0.0 * angles)
        fields = [
            PointField(
                name=name,
                offset=4 * number,
                datatype=PointField.INT32 if name == "index" else PointField.FLOAT32,
                count=1,
            )
            for number, name in enumerate(columns)
        ]
        rows = zip(*(column[is_valid].tolist() for column in columns.values()), strict=True)
        return create_cloud(scan_in.header, fields, rows)

"""Processor time of a costmap's update with a point cloud of 640 × 480 points.

python benchmarks/costmap_clouds.py [--rounds N]

A depth camera at the height of 0.6 m sees the floor, a wall 4 m away, and two boxes.
"""

from __future__ import annotations

import statistics
import time

import numpy as np
from measure import arguments

import simkit
from simkit import msgs
from simkit.sensors.point_cloud_messages import point_cloud

WORLD = """<sdf version="1.9"><world name="w"><plugin filename="libsimkit_costmap_2d.so" name="local_costmap">
<resolution>0.05</resolution><rolling_window>true</rolling_window><plugins>layer</plugins><layer>
<plugin>nav2_costmap_2d::{layer}</plugin>{options}<observation_sources>cloud</observation_sources><cloud><topic>/points
</topic><data_type>PointCloud2</data_type><min_obstacle_height>0.02</min_obstacle_height></cloud></layer></plugin>
</world></sdf>"""
LAYERS = {"VoxelLayer": "<z_voxels>16</z_voxels><z_resolution>0.05</z_resolution>", "ObstacleLayer": ""}
HEIGHT = 0.6  # [m] of the camera


def points() -> np.ndarray:
    """Return points in the frame of the camera, whose x axis looks ahead, as a structured array."""
    right, down = np.meshgrid(np.linspace(-0.577, 0.577, 640), np.linspace(-0.43, 0.43, 480))
    depth = np.where(down > 0, np.minimum(4.0, HEIGHT / np.maximum(down, 1e-3)), 4.0)
    depth = np.where((np.abs(right) < 0.2) & (down > -0.1), np.minimum(depth, 1.5), depth)
    depth = np.where((right > 0.3) & (down > 0), np.minimum(depth, 1.0), depth).ravel()
    table = np.zeros(depth.size, [("x", "<f4"), ("y", "<f4"), ("z", "<f4")])
    table["x"], table["y"], table["z"] = depth, -right.ravel() * depth, -down.ravel() * depth
    return table


def main() -> None:
    rounds, table = arguments(__doc__, rounds=15).rounds, points()
    for layer, options in LAYERS.items():
        with simkit.load(WORLD.format(layer=layer, options=options)) as sim:
            at = {"camera": HEIGHT, "base_footprint": 0.0}
            transforms = [
                {
                    "header": {"frame_id": "map"},
                    "child_frame_id": frame,
                    "transform": {"translation": {"z": height}, "rotation": {"w": 1.0}},
                }
                for frame, height in at.items()
            ]
            sim.advertise("/tf_static", "tf2_msgs/msg/TFMessage", latched=True).publish({"transforms": transforms})
            sim.run(0.1)
            publisher, taken = sim.advertise("/points", "sensor_msgs/msg/PointCloud2"), []
            for _ in range(rounds):
                publisher.publish(point_cloud(msgs.header(sim.time_ns, "camera"), table, 480, 640, True))
                begin = time.process_time()
                sim.plugins["local_costmap"]._update()  # no other part of a step
                taken.append(time.process_time() - begin)
            figures = f"median {statistics.median(taken) * 1e3:.0f} ms, least {min(taken) * 1e3:.0f} ms"
            print(f"an update of {layer} with {len(table)} points: {figures}")


if __name__ == "__main__":
    main()

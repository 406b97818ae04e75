"""Livox lidars of Gazebo Classic: `liblivox_laser_simulation.so` of ROS 1, `libros2_livox.so` of ROS 2."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from simkit import Params, SensorPlugin
from simkit.extend import Options, OptionsOf, SceneSensor, integer, text, without_effect

if TYPE_CHECKING:
    from simkit.sensors.rays.lidar import Lidar

_LAYOUTS = {0: "xyz", 1: "xyz", 2: "livox", 3: "livox_custom"}
_OLD_CLOUD = 0


class LivoxLaserOptions(Options):
    """Options of `LivoxLaser`."""

    samples: int = integer(0, minimum=0)
    downsample: int = integer(1)
    csv_file_name: str = text()
    ros_topic: str = text()
    topic: str = text()
    visualize: bool = without_effect()
    publish_pointcloud_type: int = integer(1, minimum=0, maximum=3)


class LivoxLaser(SensorPlugin):
    """Lidar with the scan pattern of a table: each scan has the next `<samples>` rows of `<csv_file_name>`.

    The plugin has the `<ray>` of its sensor. With `<downsample>` n, every n-th row is a ray. The rays of a scan are
    cast at one instant, as in Gazebo. The cloud is published on `<ros_topic>` or `<topic>`, in the frame that has the
    name of the sensor; a ray without a return is a point at the origin. `<publish_pointcloud_type>` is 0 for
    `PointCloud`, 1 (the default) for `PointCloud2` with positions, 2 for one with the fields of Livox's driver, 3 for
    its `CustomMsg`.
    """

    filenames = ("liblivox_laser_simulation.so", "libros2_livox.so")
    options = OptionsOf(LivoxLaserOptions)

    @classmethod
    def complete(cls, sensor: SceneSensor, params: Params) -> SceneSensor:
        options = LivoxLaserOptions(params)
        stride = max(options.downsample, 1)
        where, diagnostics = params.where, params.diagnostics

        def element(name: str, value: str = "", children: Sequence[Params] = ()) -> Params:
            return Params(name, value, children=children, where=where, diagnostics=diagnostics)

        ray = params.block("ray")
        own = [child for child in ray.children if child.name in ("scan", "range") and ray.child(child.name) is child]
        noise = ray.child("noise")
        if noise is not None:
            noise.mark_all_read()
            message = f"sensor {sensor.scoped!r}: <noise> in the plugin has no effect, as in Gazebo"
            diagnostics.note("SK-SENSOR-283", message, noise.where, "write it into the <ray> of the sensor")
        pattern = (
            element("samples", str(max(options.samples // stride, 1))),
            element("stride", str(stride)),
            element("file", options.csv_file_name),
            element("instantaneous", "true"),
        )
        added = [
            element("ray", children=own),
            element("scan_pattern", children=pattern),
            element("point_layout", _LAYOUTS[options.publish_pointcloud_type]),
        ]
        present = {"ray" if child.name == "lidar" else child.name for child in sensor.params.children}
        old = sensor.params
        children = (*old.children, *(child for child in added if child.name not in present))
        completed = Params(old.name, old.value, old.attributes, children, old.where, old.diagnostics)
        return replace(sensor, params=completed)

    def load(self, parent: Lidar, params: Params) -> None:
        if not hasattr(parent, "replaced_products"):
            self.refuse(parent, "ray")
            return
        topic = self.ros.topic(self.options.ros_topic or self.options.topic or "scan")
        product = "old_hits" if self.options.publish_pointcloud_type == _OLD_CLOUD else "points"
        parent.frame_id = parent.name
        parent.publish_on({product: topic})

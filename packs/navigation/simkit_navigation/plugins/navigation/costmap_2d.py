"""Plugin with a costmap, as Nav2's `nav2_costmap_2d`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.extend import Options, OptionsOf, boolean, integer, listens, number, offers, publishes, text, texts
from simkit_navigation.plugins.navigation.cost_grid import FREE, UNKNOWN, Cells, CostGrid
from simkit_navigation.plugins.navigation.costmap_layers import (
    DEFAULT_LAYERS,
    LAYERS,
    InflationLayerOptions,
    ObstacleLayerOptions,
    SourceOptions,
    StaticLayer,
    StaticLayerOptions,
)
from simkit_navigation.plugins.navigation.footprint import Footprint, read_footprint
from simkit_navigation.plugins.navigation.gradient_layer import GradientLayer, GradientLayerOptions
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, look_up
from simkit_navigation.plugins.navigation.update_window import (
    apply_layer,
    enabled_layers,
    keep_outside,
    window_of_layers,
)
from simkit_navigation.plugins.navigation.user_classes import ServerPlugin

if TYPE_CHECKING:
    from simkit import Model, Simulation

_MOST_CELLS: Final = 25_000_000
_CLEARS: Final = {
    "entirely": "nav2_msgs/srv/ClearEntireCostmap",
    "around": "nav2_msgs/srv/ClearCostmapAroundRobot",
    "except": "nav2_msgs/srv/ClearCostmapExceptRegion",
}


class CostmapOptions(Options):
    """Options of `Costmap2D`."""

    global_frame: str = text("map")
    robot_base_frame: str = text("base_footprint")
    update_frequency: float = number(5.0, "Hz", minimum=0.001, maximum=1000)
    publish_frequency: float = number(1.0, "Hz", minimum=0.001, maximum=1000)
    rolling_window: bool = boolean(False)
    width: float = number(5.0, "m", minimum=0.01)
    height: float = number(5.0, "m", minimum=0.01)
    resolution: float = number(0.1, "m", minimum=1e-3)
    origin_x: float = number(0.0, "m")
    origin_y: float = number(0.0, "m")
    robot_radius: float = number(0.1, "m", minimum=0)
    footprint: str = text("")
    track_unknown_space: bool = boolean(False)
    lethal_cost_threshold: int = integer(100, minimum=1, maximum=100)
    plugins: tuple[str, ...] = texts()


class Costmap2D(ServerPlugin):
    """Combines the costs of layers in a grid: the static map, obstacles in laser scans, and the inflation around both.

    Each name in `<plugins>` is a layer, with a block of parameters of the same name. Its `<plugin>` is a class of Nav2,
    or `file.py:Class`. Without `<rolling_window>`, the costmap has the size of the map as soon as there is one. The
    costs are published on `~/costmap` (`nav_msgs/msg/OccupancyGrid`) and `~/costmap_raw` (`nav2_msgs/msg/Costmap`).
    """

    filenames = ("libsimkit_costmap_2d.so",)
    names = ("simkit::Costmap2D", "nav2_costmap_2d::Costmap2DROS")
    options = OptionsOf(CostmapOptions)
    option_types = (
        StaticLayerOptions,
        ObstacleLayerOptions,
        SourceOptions,
        InflationLayerOptions,
        GradientLayerOptions,
    )
    endpoints = (
        publishes("~/costmap", "nav_msgs/msg/OccupancyGrid"),
        publishes("~/costmap_raw", "nav2_msgs/msg/Costmap"),
        publishes("~/published_footprint", "geometry_msgs/msg/PolygonStamped"),
        listens("map", "nav_msgs/msg/OccupancyGrid", named_by=("map_topic",)),
        listens("scan", "sensor_msgs/msg/LaserScan", named_by=("topic",)),
        offers("~/get_costmap", "nav2_msgs/srv/GetCostmap"),
        *(offers(f"~/clear_{extent}_<name>", type_name) for extent, type_name in _CLEARS.items()),
    )

    def load(self, parent: Simulation | Model, params: Params) -> None:
        options = self.options.read_all()
        self.after_step_rate = options.update_frequency
        self.sim.tf.open()  # so that the first look-up knows the transforms before it
        self.default_cost = UNKNOWN if options.track_unknown_space else FREE
        self.lethal_cost_threshold = options.lethal_cost_threshold
        self.footprint: Footprint = read_footprint(self, options.footprint, options.robot_radius)
        self.inscribed_radius = self.footprint.inscribed_radius
        known = {**LAYERS, "nav2_gradient_costmap_plugin::GradientLayer": GradientLayer}
        self.make_parts(options.plugins, DEFAULT_LAYERS, known, ("update_costs",), "on_initialize")
        self._disabled = [name for name in self.parts if not params.block(name).boolean("enabled", True)]
        size = options.width * options.height / options.resolution**2
        if size > _MOST_CELLS:
            params.error("SK-PARAM-002", f"the costmap has {size:.3g} cells; at most {_MOST_CELLS:.0e} are possible")
            return
        self.grid = self._empty_grid()
        self._robot: PlanarPose | None = None
        self._next_publication = 0.0
        self._costmap = self.advertise("~/costmap", "nav_msgs/msg/OccupancyGrid", latched=True)
        self._raw = self.advertise("~/costmap_raw", "nav2_msgs/msg/Costmap", latched=True)
        self._outline = self.advertise("~/published_footprint", "geometry_msgs/msg/PolygonStamped")
        name = self.ros.node
        self.offer(
            "~/get_costmap", "nav2_msgs/srv/GetCostmap", lambda _: {"map": self.grid.raw_message(self.sim.time_ns)}
        )
        for extent, type_name in _CLEARS.items():
            self.offer(f"~/clear_{extent}_{name}", type_name, self._clear)

    # ------------------------------------------------------------------ the grid

    def _empty_grid(self) -> CostGrid:
        """Return a grid without obstacles, with the size of the options or of the map."""
        options = self.options
        if not options.rolling_window:
            for layer in self.parts.values():
                if isinstance(layer, StaticLayer) and layer.map is not None:
                    known = layer.map
                    cells: Cells = np.full(known.cells.shape, self.default_cost, np.uint8)
                    return CostGrid(cells, known.resolution, known.origin, known.frame)
        rows, columns = (max(round(side / options.resolution), 1) for side in (options.height, options.width))
        cells = np.full((rows, columns), self.default_cost, np.uint8)
        origin = PlanarPose(options.origin_x, options.origin_y, 0.0)
        return CostGrid(cells, options.resolution, origin, options.global_frame)

    def after_step(self) -> None:
        self._update()
        if self.sim.time + 1e-9 >= self._next_publication:
            self._next_publication = self.sim.time + 1.0 / self.options.publish_frequency
            self._publish()

    def _update(self) -> None:
        """Compute the costs anew."""
        grid = self._empty_grid()
        robot = look_up(self.sim, grid.frame, self.options.robot_base_frame)
        if robot is None:
            return  # there is no transform yet
        if self.options.rolling_window:
            side = grid.resolution  # the window moves by whole cells, so that obstacles keep their cells
            rows, columns = grid.cells.shape
            x = (math.floor(robot.x / side) - columns // 2) * side
            y = (math.floor(robot.y / side) - rows // 2) * side
            grid.origin = PlanarPose(x, y, 0.0)
        layers = enabled_layers(self.parts, self._disabled)
        window = window_of_layers(layers.values(), grid, robot)
        keep_outside(grid, self.grid, window)
        for name, layer in layers.items():
            apply_layer(name, layer, grid, robot, window)
        self.grid, self._robot = grid, robot

    def _publish(self) -> None:
        now = self.sim.time_ns
        if self._costmap.wanted:
            self._costmap.publish(self.grid.occupancy_message(now))
        if self._raw.wanted:
            self._raw.publish(self.grid.raw_message(now))
        if self._robot is not None and self._outline.wanted:
            self._outline.publish(self.footprint.message(self._robot, self.grid.frame, now))

    def _clear(self, _: object) -> dict[str, object]:
        """Let the layers forget what they have seen; then update the costmap.

        In Nav2, two of the services clear a square around the robot, or everything outside of it. Here, the layers
        forget everything in all cases, because the next scan brings back what is still there.
        """
        for layer in self.parts.values():
            if callable(getattr(layer, "reset", None)):
                layer.reset()
        self._update()
        self._publish()
        return {}

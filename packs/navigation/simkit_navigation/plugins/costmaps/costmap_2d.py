"""Plugin with a costmap, as Nav2's `nav2_costmap_2d`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.extend import Options, OptionsOf, boolean, integer, listens, number, offers, publishes, text, texts
from simkit_navigation.plugins.costmaps.cost_grid import (
    FREE,
    UNKNOWN,
    Cells,
    CostGrid,
    Mask,
    changed_area,
    cost_table,
    update_messages,
)
from simkit_navigation.plugins.costmaps.costmap_filters import (
    BinaryFilterOptions,
    CostmapFilterOptions,
    KeepoutFilterOptions,
    SpeedFilterOptions,
)
from simkit_navigation.plugins.costmaps.costmap_layers import (
    DEFAULT_LAYERS,
    LAYERS,
    InflationLayerOptions,
    StaticLayer,
    StaticLayerOptions,
)
from simkit_navigation.plugins.costmaps.costmap_parameters import costmap_parameters
from simkit_navigation.plugins.costmaps.denoise_layer import DenoiseLayerOptions
from simkit_navigation.plugins.costmaps.footprint import Footprint, padded, read_footprint
from simkit_navigation.plugins.costmaps.gradient_layer import GradientLayer, GradientLayerOptions
from simkit_navigation.plugins.costmaps.observation_buffer import SourceOptions
from simkit_navigation.plugins.costmaps.obstacle_layer import ObstacleLayerOptions
from simkit_navigation.plugins.costmaps.range_sensor_layer import RangeSensorLayerOptions
from simkit_navigation.plugins.costmaps.update_window import (
    apply_layer,
    enabled_layers,
    keep_outside,
    window_of_layers,
)
from simkit_navigation.plugins.costmaps.voxel_layer import VoxelLayerOptions
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, look_up, pose_of_message
from simkit_navigation.plugins.navigation.user_classes import ServerPlugin

if TYPE_CHECKING:
    from simkit import Model, Simulation, msgs

_MOST_CELLS: Final = 25_000_000
_CLEARS: Final = {
    "entirely": "nav2_msgs/srv/ClearEntireCostmap",
    "around": "nav2_msgs/srv/ClearCostmapAroundRobot",
    "around_pose": "nav2_msgs/srv/ClearCostmapAroundPose",
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
    unknown_cost_value: int = integer(255, minimum=0, maximum=255)
    trinary_costmap: bool = boolean(True)
    use_maximum: bool = boolean(False)
    footprint_padding: float = number(0.0, "m", minimum=0)
    always_send_full_costmap: bool = boolean(True)
    map_vis_z: float = number(0.0, "m")
    transform_tolerance: float = number(0.3, "s", minimum=0)
    initial_transform_timeout: float = number(60.0, "s", minimum=0)
    plugins: tuple[str, ...] = texts()
    filters: tuple[str, ...] = texts()


class Costmap2D(ServerPlugin):
    """Combines the costs of layers in a grid: the static map, obstacles that sensors see, and inflation around both.

    Each name in `<plugins>` is a layer, with a block of parameters of the same name. Its `<plugin>` is a class of Nav2,
    or `file.py:Class`. The names in `<filters>` are layers that come after all others. Without `<rolling_window>`, the
    costmap has the size of the map as soon as there is one. The costs are published on `~/costmap`
    (`nav_msgs/msg/OccupancyGrid`) and `~/costmap_raw` (`nav2_msgs/msg/Costmap`).
    """

    filenames = ("libsimkit_costmap_2d.so",)
    names = ("simkit::Costmap2D", "nav2_costmap_2d::Costmap2DROS")
    options = OptionsOf(CostmapOptions)
    option_types = (
        StaticLayerOptions,
        ObstacleLayerOptions,
        SourceOptions,
        VoxelLayerOptions,
        RangeSensorLayerOptions,
        DenoiseLayerOptions,
        InflationLayerOptions,
        CostmapFilterOptions,
        KeepoutFilterOptions,
        SpeedFilterOptions,
        BinaryFilterOptions,
        GradientLayerOptions,
    )
    endpoints = (
        publishes("~/costmap", "nav_msgs/msg/OccupancyGrid"),
        publishes("~/costmap_raw", "nav2_msgs/msg/Costmap"),
        publishes("~/costmap_updates", "map_msgs/msg/OccupancyGridUpdate"),
        publishes("~/costmap_raw_updates", "nav2_msgs/msg/CostmapUpdate"),
        publishes("~/published_footprint", "geometry_msgs/msg/PolygonStamped"),
        publishes("~/voxel_grid", "nav2_msgs/msg/VoxelGrid"),
        publishes("speed_limit", "nav2_msgs/msg/SpeedLimit", named_by=("speed_limit_topic",)),
        publishes("binary_state", "std_msgs/msg/Bool", named_by=("binary_state_topic",)),
        listens("map", "nav_msgs/msg/OccupancyGrid", named_by=("map_topic",)),
        listens("scan", "sensor_msgs/msg/LaserScan", named_by=("topic",)),
        listens("filter_info", "nav2_msgs/msg/CostmapFilterInfo", named_by=("filter_info_topic",)),
        offers("~/get_costmap", "nav2_msgs/srv/GetCostmap"),
        *(offers(f"~/clear_{extent}_<name>", type_name) for extent, type_name in _CLEARS.items()),
    )

    @classmethod
    def translate_parameters(cls, values: Values, _: Values, /) -> NodeValues:
        return costmap_parameters(values)

    @property
    def node_names(self) -> tuple[str, ...]:
        space, node = self.ros.namespace, self.ros.node
        return (f"{space}/{node}/{node}", f"{space}/{node}")

    def load(self, parent: Simulation | Model, params: Params) -> None:
        options = self.options.read_all()
        self.after_step_rate = options.update_frequency
        self.sim.tf.open()  # so that the first look-up knows the transforms before it
        self.default_cost = UNKNOWN if options.track_unknown_space else FREE
        self.lethal_cost_threshold = options.lethal_cost_threshold
        self.map_costs = cost_table(
            options.lethal_cost_threshold, self.default_cost, options.unknown_cost_value, options.trinary_costmap
        )
        self.uses_maximum, self.is_rolling = options.use_maximum, options.rolling_window
        outline = read_footprint(self, options.footprint, options.robot_radius)
        self.footprint: Footprint = padded(outline, options.footprint_padding)
        self.inscribed_radius = self.footprint.inscribed_radius
        layers = options.plugins or tuple(DEFAULT_LAYERS)
        known = {**LAYERS, "nav2_gradient_costmap_plugin::GradientLayer": GradientLayer}
        self.make_parts((*layers, *options.filters), DEFAULT_LAYERS, known, ("update_costs",), "on_initialize")
        own = [name for name, layer in self.parts.items() if type(layer) not in LAYERS.values()]
        self._disabled = [name for name in own if not params.block(name).boolean("enabled", True)]
        size = options.width * options.height / options.resolution**2
        if size > _MOST_CELLS:
            params.error("SK-PARAM-002", f"the costmap has {size:.3g} cells; at most {_MOST_CELLS:.0e} are possible")
            return
        self.grid = self._empty_grid()
        self._robot: PlanarPose | None = None
        self._sent: CostGrid | None = None
        self._next_publication = 0.0
        self._costmap = self.advertise("~/costmap", "nav_msgs/msg/OccupancyGrid", latched=True)
        self._raw = self.advertise("~/costmap_raw", "nav2_msgs/msg/Costmap", latched=True)
        self._changes = self.advertise("~/costmap_updates", "map_msgs/msg/OccupancyGridUpdate")
        self._raw_changes = self.advertise("~/costmap_raw_updates", "nav2_msgs/msg/CostmapUpdate")
        self._outline = self.advertise("~/published_footprint", "geometry_msgs/msg/PolygonStamped")
        name = self.ros.node
        self.offer(
            "~/get_costmap", "nav2_msgs/srv/GetCostmap", lambda _: {"map": self.grid.raw_message(self.sim.time_ns)}
        )
        answers = (self._clear_all, self._clear_around, self._clear_around_pose, self._clear_except)
        for (extent, type_name), answer in zip(_CLEARS.items(), answers, strict=True):
            self.offer(f"~/clear_{extent}_{name}", type_name, answer)

    def report_once(self, cause: str, message: str) -> None:
        """Warn about a sensor, a mask or a parameter that cannot be used, once for each cause."""
        self._once.warn("SK-COSTMAP-001", cause, message)

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
            self._report_missing_transform(grid.frame)
            return
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

    def _report_missing_transform(self, frame: str) -> None:
        limit = self.options.initial_transform_timeout
        if self._robot is None and self.sim.time > limit:
            text = f"there is no transform from {self.options.robot_base_frame!r} to {frame!r} after {limit:g} s"
            self.report_once("transform", f"{text} (<initial_transform_timeout>); the costmap stays empty")

    def _publish(self) -> None:
        now, grid = self.sim.time_ns, self.grid
        area = None
        if not self.options.always_send_full_costmap and self._sent is not None:
            area = changed_area(self._sent, grid)
        if area is None:
            is_first = self._sent is None and not self.options.always_send_full_costmap
            if self._costmap.wanted or is_first:
                self._costmap.publish(grid.occupancy_message(now, self.options.map_vis_z))
            if self._raw.wanted or is_first:
                self._raw.publish(grid.raw_message(now))
        elif any(area) and (self._changes.wanted or self._raw_changes.wanted):
            shown, raw = update_messages(grid, area, now)
            self._changes.publish(shown)
            self._raw_changes.publish(raw)
        if not self.options.always_send_full_costmap:
            self._sent = CostGrid(grid.cells.copy(), grid.resolution, grid.origin, grid.frame)
        if self._robot is not None and self._outline.wanted:
            self._outline.publish(self.footprint.message(self._robot, self.grid.frame, now))

    # ------------------------------------------------------------------ services

    def _clear_all(self, _: object) -> dict[str, object]:
        """Let the layers forget what they have seen; then update the costmap."""
        for layer in self.parts.values():
            if callable(getattr(layer, "reset", None)):
                layer.reset()
        self.grid = self._empty_grid()
        return self._update_now()

    def _clear_around(self, request: msgs.Message) -> dict[str, object]:
        """Clear a square around the robot, whose side is the `reset_distance`."""
        if self._robot is not None:
            self._clear_square(self._robot.x, self._robot.y, request.reset_distance, is_outside=False)
        return self._update_now()

    def _clear_around_pose(self, request: msgs.Message) -> dict[str, object]:
        """Clear a square around a pose."""
        pose = pose_of_message(request.pose.pose)
        placed = look_up(self.sim, self.grid.frame, request.pose.header.frame_id)
        if pose is None or placed is None:
            text = (
                "a request to clear around a pose is ignored: its frame %r has no transform, or a number is not finite"
            )
            self.log.error(text, request.pose.header.frame_id)
            return {}
        pose = placed.compose(pose)
        self._clear_square(pose.x, pose.y, request.reset_distance, is_outside=False)
        return self._update_now()

    def _clear_except(self, request: msgs.Message) -> dict[str, object]:
        """Clear everything but a square around the robot."""
        if self._robot is not None:
            self._clear_square(self._robot.x, self._robot.y, request.reset_distance, is_outside=True)
        return self._update_now()

    def _clear_square(self, x: float, y: float, side: float, *, is_outside: bool) -> None:
        """Let the layers forget a square, or all outside of it, as Nav2's `ClearCostmapService::clearLayerRegion`."""
        grid = self.grid
        if not math.isfinite(side):
            return
        centre = grid.origin.inverse().transform(np.array([[x, y]]))[0].tolist()
        shape = grid.cells.shape
        ranges = []
        for place, count in zip(reversed(centre), shape, strict=True):
            low, high = ((place + sign * side / 2) / grid.resolution for sign in (-1, 1))
            first, last = (math.floor(min(max(end, 0.0), count - 1.0)) for end in (low, high))
            ranges.append(slice(first + 1, max(last, first + 1)))  # Nav2 leaves out the border of the square
        area: Mask = np.full(shape, is_outside, np.bool_)
        area[ranges[0], ranges[1]] = not is_outside
        for layer in self.parts.values():
            if callable(getattr(layer, "clear_area", None)):
                layer.clear_area(area)

    def _update_now(self) -> dict[str, object]:
        self._update()
        self._publish()
        return {}

"""Filters of a costmap, whose areas come from a mask: keep-out zones, speed limits, and switches.

A filter receives a `nav2_msgs/msg/CostmapFilterInfo`, then the mask on the topic that this message names. The formulas
are those of Nav2's `costmap_filters`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, msgs
from simkit.extend import Options, SharedByCopies, boolean, integer, number, text
from simkit_navigation.plugins.costmaps.cost_grid import INSCRIBED, LETHAL, UNKNOWN, Cells, CostGrid, grid_of_map
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, look_up

if TYPE_CHECKING:
    from simkit_navigation.plugins.costmaps.costmap_node import CostmapNode

_INFO: Final = "nav2_msgs/msg/CostmapFilterInfo"
_MASK: Final = "nav_msgs/msg/OccupancyGrid"
_KEEPOUT, _SPEED_PERCENT, _SPEED_ABSOLUTE, _BINARY = 0, 1, 2, 3  # nav2_costmap_2d/costmap_filters/filter_values.hpp
_NO_LIMIT: Final = 0.0
_BYTES: Final = np.arange(256, dtype=np.int64)
_COSTS: Final[Cells] = np.where(_BYTES <= 100, (_BYTES * LETHAL + 50) // 100, UNKNOWN).astype(np.uint8)
"""Cost by occupancy: 254 % of it, rounded; a byte above 100 is unknown."""


class CostmapFilterOptions(Options):
    """Options of all filters."""

    enabled: bool = boolean(True)
    filter_info_topic: str = text("")
    transform_tolerance: float = number(0.1, "s", minimum=0)


class _OpenTopics(SharedByCopies):
    """Topics of masks to which a filter has subscribed; a restore does not close them."""

    def __init__(self) -> None:
        self.names: set[str] = set()


class CostmapFilter:
    """Base class of filters: receives the information and the mask."""

    kinds: tuple[int, ...] = ()
    """Types of `CostmapFilterInfo` that the filter can use."""

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        self._node, self._name = node, type(self).__name__
        self._common = CostmapFilterOptions(params).read_all()
        self._is_enabled = self._common.enabled
        self._info: msgs.Message | None = None
        self._masks: dict[str, CostGrid] = {}  # newest mask by topic, with the occupancy as unsigned bytes
        self._open = _OpenTopics()
        self._read(params)
        if not self._common.filter_info_topic:
            node.report_once(f"filter {self._name}", f"a {self._name} without <filter_info_topic> does nothing")
            return
        node.receive(self._common.filter_info_topic, _INFO, "filter_info_topic", self.on_info)
        node.offer(f"~/{params.name}/toggle_filter", "std_srvs/srv/SetBool", self._toggle)

    def _read(self, params: Params) -> None:
        """Read the parameters of the filter."""

    def _toggle(self, request: msgs.Message) -> dict[str, object]:
        self._is_enabled = bool(request.data)
        return {"success": True, "message": "Enabled" if self._is_enabled else "Disabled"}

    def on_info(self, message: msgs.Message) -> None:
        """Use the mask of a topic."""
        if message.type not in self.kinds:
            expected = " or ".join(map(str, self.kinds))
            text = f"a filter info of the type {message.type} is ignored; {self._name} expects {expected}"
            self._node.report_once(f"type of {self._name}", text)
            return
        self._info = message
        self._subscribe()

    def _subscribe(self) -> None:
        assert self._info is not None
        topic = self._info.filter_mask_topic
        if topic and topic not in self._open.names:
            self._open.names.add(topic)
            self._node.receive(topic, _MASK, "filter_mask_topic", _MaskReceiver(self, topic))

    def on_mask(self, topic: str, message: msgs.OccupancyGrid) -> None:
        """Store a mask."""
        grid = grid_of_map(message, _BYTES.astype(np.uint8))
        if grid is None:
            self._node.report_once(
                f"mask {topic}", f"the mask on {topic} is empty, or its size, resolution or origin is not valid"
            )
        else:
            self._masks[topic] = grid

    def _mask(self) -> CostGrid | None:
        if self._info is None or not self._is_enabled:
            return None
        self._subscribe()  # after a restore in another process, nothing is subscribed
        return self._masks.get(self._info.filter_mask_topic)

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Apply the mask."""
        mask = self._mask()
        if mask is not None:
            self._apply(mask, grid, robot)

    def _apply(self, mask: CostGrid, grid: CostGrid, robot: PlanarPose) -> None:
        """Apply a mask to the costs, or react to the pose of the robot in it."""

    def reset(self) -> None:
        """Keep the mask, which does not come from what the robot sees."""

    def _occupancy(self, mask: CostGrid, grid: CostGrid, robot: PlanarPose) -> tuple[int | None, bool]:
        """Return the occupancy of the mask at the robot, -1 if unknown, and whether a transform is known.

        The occupancy is None outside of the mask.
        """
        placed = look_up(self._node.sim, mask.frame, grid.frame)
        if placed is None:
            text = f"{self._name}: there is no transform from {grid.frame!r} to the frame {mask.frame!r} of the mask"
            self._node.report_once(f"frame of {self._name}", text)
            return None, False
        pose = placed.compose(robot)
        cell = mask.to_cell(pose.x, pose.y)
        if cell is None:
            return None, True
        value = int(mask.cells[cell])
        return (value if value <= 100 else -1), True


class _MaskReceiver(SharedByCopies):
    """Callback that passes masks of a topic on to a filter."""

    def __init__(self, owner: CostmapFilter, topic: str) -> None:
        self._owner, self._topic = owner, topic

    def __call__(self, message: msgs.Message) -> None:
        self._owner.on_mask(self._topic, message)


class KeepoutFilterOptions(Options):
    """Options of `KeepoutFilter`."""

    override_lethal_cost: bool = boolean(False)
    lethal_override_cost: int = integer(252)


class KeepoutFilter(CostmapFilter):
    """Costs of a mask, such as zones that the robot must not enter (`nav2_costmap_2d::KeepoutFilter`)."""

    kinds = (_KEEPOUT,)

    def _read(self, params: Params) -> None:
        self._options = KeepoutFilterOptions(params).read_all()

    def on_info(self, message: msgs.Message) -> None:
        super().on_info(message)
        if message.base != 0.0 or message.multiplier != 1.0:
            text = "base and multiplier of the filter info should be 0 and 1; a KeepoutFilter does not use them"
            self._node.report_once("base of KeepoutFilter", text)

    def _apply(self, mask: CostGrid, grid: CostGrid, robot: PlanarPose) -> None:
        costs = CostGrid(_COSTS[mask.cells], mask.resolution, mask.origin, mask.frame)
        placed = look_up(self._node.sim, grid.frame, mask.frame)
        if placed is None:
            self._occupancy(mask, grid, robot)  # reports it
            return
        if mask.frame == grid.frame and mask.origin == grid.origin and mask.cells.shape == grid.cells.shape:
            found = costs.cells
        else:
            rows, columns = np.indices(grid.cells.shape).reshape(2, -1)
            found = costs.seen_from(grid.frame, placed).costs(grid.centres(rows, columns)).reshape(grid.cells.shape)
        is_written = (found != UNKNOWN) & ((found > grid.cells) | (grid.cells == UNKNOWN))
        if self._options.override_lethal_cost:
            occupancy, _ = self._occupancy(mask, grid, robot)
            if occupancy is not None and occupancy >= 0 and _COSTS[occupancy] >= INSCRIBED:
                most = min(max(self._options.lethal_override_cost, 0), INSCRIBED - 1)
                found = np.full(grid.cells.shape, most, np.uint8)
        np.copyto(grid.cells, found, where=is_written)


class SpeedFilterOptions(Options):
    """Options of `SpeedFilter`."""

    speed_limit_topic: str = text("speed_limit")


class SpeedFilter(CostmapFilter):
    """Speed limits of a mask (`nav2_costmap_2d::SpeedFilter`), as `nav2_msgs/msg/SpeedLimit`.

    The limit is base + multiplier · occupancy, in per cent or m/s. Occupancy 0 is no limit, which has the value 0.
    """

    kinds = (_SPEED_PERCENT, _SPEED_ABSOLUTE)

    def _read(self, params: Params) -> None:
        topic = SpeedFilterOptions(params).read_all().speed_limit_topic
        self._limit = _NO_LIMIT
        self._limits = self._node.advertise(topic, "nav2_msgs/msg/SpeedLimit")

    def _apply(self, mask: CostGrid, grid: CostGrid, robot: PlanarPose) -> None:
        occupancy, _ = self._occupancy(mask, grid, robot)
        if occupancy is None:
            return
        if occupancy < 0:
            self._node.report_once("unknown speed", "SpeedFilter: an unknown cell of the mask has no speed limit")
            return
        info = self._info
        assert info is not None
        is_percentage = info.type == _SPEED_PERCENT
        limit = _NO_LIMIT
        if occupancy > 0:
            limit = float(occupancy * info.multiplier + info.base)
            if not 0.0 <= limit <= (100.0 if is_percentage else math.inf):
                text = f"the speed limit {limit:g} {'%' if is_percentage else 'm/s'} is out of range; there is no limit"
                self._node.report_once("range of speed", f"SpeedFilter: {text}")
                limit = _NO_LIMIT
        if limit != self._limit:
            self._limit = limit
            header = msgs.header(self._node.sim.time_ns, grid.frame)
            self._limits.publish({"header": header, "percentage": is_percentage, "speed_limit": limit})


class BinaryFilterOptions(Options):
    """Options of `BinaryFilter`."""

    default_state: bool = boolean(False)
    binary_state_topic: str = text("binary_state")
    flip_threshold: float = number(50.0)


class BinaryFilter(CostmapFilter):
    """Switch that a mask changes (`nav2_costmap_2d::BinaryFilter`), as `std_msgs/msg/Bool`.

    The state differs from `<default_state>` where base + multiplier · occupancy is above `<flip_threshold>`.
    """

    kinds = (_BINARY,)

    def _read(self, params: Params) -> None:
        self._options = BinaryFilterOptions(params).read_all()
        self._state: bool | None = None  # before the first message
        self._states = self._node.advertise(self._options.binary_state_topic, "std_msgs/msg/Bool")

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Publish the state if it changes, and the default state at first."""
        if self._state is None:
            self._change(self._options.default_state)
        super().update_costs(grid, robot)

    def _apply(self, mask: CostGrid, grid: CostGrid, robot: PlanarPose) -> None:
        occupancy, is_placed = self._occupancy(mask, grid, robot)
        info = self._info
        assert info is not None
        if not is_placed or (occupancy is not None and occupancy < 0):
            return
        is_flipped = occupancy is not None and info.base + occupancy * info.multiplier > self._options.flip_threshold
        state = self._options.default_state is not is_flipped
        if state is not self._state:
            self._change(state)

    def _change(self, state: bool) -> None:
        self._state = state
        self._states.publish({"data": state})

"""Nodes that call services, and nodes that read topics (`nav2_behavior_tree/plugins/action`)."""

from __future__ import annotations

from typing import Any, ClassVar, Final

from simkit_navigation.behavior_trees.navigator import PendingCall
from simkit_navigation.behavior_trees.tree_node import FAILURE, RUNNING, SUCCESS, Ports, TreeNode

_SERVICE: Final = ("service_name", "server_timeout")


class ServiceNode(TreeNode):
    """Node that calls a service, and runs until there is a response.

    Attributes:
        call: call that waits for its response.
    """

    service: ClassVar[str] = ""
    """Name of the service, unless the port `service_name` has another one."""

    def prepare(self) -> None:
        self.call: PendingCall | None = None

    def request(self) -> dict[str, object]:
        """Return the request."""
        return {}

    def on_start(self) -> None:
        """Do what comes before a request."""

    def take_response(self, response: Any) -> str:
        """Write the values of a response to the ports, and return the status."""
        return SUCCESS

    def clear(self) -> None:
        self.call = None

    def tick(self) -> str:
        if self.call is None:
            self.set_status(RUNNING)
            self.on_start()
            self.call = self.tree.call_service(self.text("service_name") or self.service, self.request())
            if self.call is None:
                return FAILURE
        if not self.call.is_done:
            return RUNNING
        call, self.call = self.call, None
        return FAILURE if call.error is not None else self.take_response(call.response)


class ClearEntireCostmap(ServiceNode):
    """Clears a costmap."""

    ports: ClassVar[Ports] = (*_SERVICE, "plugins")
    service = "global_costmap/clear_entirely_global_costmap"

    def on_start(self) -> None:
        self.tree.count_recovery()


class ClearCostmapAroundRobot(ClearEntireCostmap):
    """Clears a costmap near the robot."""

    ports: ClassVar[Ports] = (*ClearEntireCostmap.ports, "reset_distance")
    service = "local_costmap/clear_around_local_costmap"

    def request(self) -> dict[str, object]:
        return {"reset_distance": self.number("reset_distance", 1.0)}


class ClearCostmapExceptRegion(ClearCostmapAroundRobot):
    """Clears a costmap beyond a square around the robot."""

    service = "local_costmap/clear_except_local_costmap"


class ClearCostmapAroundPose(ClearCostmapAroundRobot):
    """Clears a costmap near a pose."""

    ports: ClassVar[Ports] = (*ClearCostmapAroundRobot.ports, "pose")
    service = "local_costmap/clear_around_pose_local_costmap"

    def request(self) -> dict[str, object]:
        pose = self.input("pose")
        return super().request() if pose is None else {**super().request(), "pose": pose}


class ReinitializeGlobalLocalization(ServiceNode):
    """Spreads the particles of AMCL over the map."""

    ports: ClassVar[Ports] = _SERVICE
    service = "reinitialize_global_localization"


class IsPathValid(ServiceNode):
    """Succeeds if no pose of `path` is in an obstacle."""

    ports: ClassVar[Ports] = (
        *(*_SERVICE, "path", "max_cost", "consider_unknown_as_obstacle", "layer_name", "footprint"),
        *("stop_at_first_collision", "max_lookahead_distance", "collision_poses"),
    )
    service = "is_path_valid"

    def request(self) -> dict[str, object]:
        path = self.input("path")
        return {} if path is None else {"path": path}

    def take_response(self, response: Any) -> str:
        path, indices = self.input("path"), response.invalid_pose_indices
        poses = () if path is None else path.poses
        self.output("collision_poses", [poses[index] for index in indices if 0 <= index < len(poses)])
        return SUCCESS if response.is_valid and poses else FAILURE


class ToggleCollisionMonitor(ServiceNode):
    """Switches the collision monitor on or off."""

    ports: ClassVar[Ports] = (*_SERVICE, "enable")
    service = "collision_monitor/toggle"

    def request(self) -> dict[str, object]:
        return {"enable": self.boolean("enable", True)}


class GoalsInCosts(ServiceNode):
    """Asks a costmap for the costs of poses."""

    ports: ClassVar[Ports] = (
        *(*_SERVICE, "input_goals", "output_goals", "cost_threshold", "use_footprint", "consider_unknown_as_obstacle"),
        *("input_waypoint_statuses", "output_waypoint_statuses", "nb_goals_to_consider"),
    )
    service = "global_costmap/get_cost_global_costmap"

    def _poses(self) -> list[Any]:
        return list(self.input("input_goals") or ())

    def request(self) -> dict[str, object]:
        return {"use_footprint": self.boolean("use_footprint", True), "poses": self._poses()}

    def _is_free(self, cost: float) -> bool:
        is_ignored = cost == 255 and not self.boolean("consider_unknown_as_obstacle", False)
        return is_ignored or cost < self.number("cost_threshold", 254.0)


class RemoveInCollisionGoals(GoalsInCosts):
    """Removes the goals that are in obstacles."""

    def tick(self) -> str:
        if not self._poses():
            self.output("output_goals", [])
            return SUCCESS
        return super().tick()

    def take_response(self, response: Any) -> str:
        poses = self._poses()
        if not getattr(response, "success", True):
            self.output("output_goals", poses)
            return FAILURE
        self.output(
            "output_goals", [pose for pose, cost in zip(poses, response.costs, strict=False) if self._is_free(cost)]
        )
        return SUCCESS


class CheckPoseOccupancy(GoalsInCosts):
    """Succeeds if a pose is in an obstacle."""

    ports: ClassVar[Ports] = (*GoalsInCosts.ports, "pose")

    def _poses(self) -> list[Any]:
        pose = self.input("pose")
        return [] if pose is None else [pose]

    def take_response(self, response: Any) -> str:
        is_known = getattr(response, "success", True) and len(response.costs) > 0
        return SUCCESS if is_known and not self._is_free(response.costs[0]) else FAILURE


# ---------------------------------------------------------------------- selectors


class Selector(TreeNode):
    """Writes the newest text of a topic, or a default, to a port."""

    what: ClassVar[str] = ""

    def prepare(self) -> None:
        self.topic = self.inputs.get("topic_name", f"{self.what}_selector")
        self.selected = ""
        self.tree.open_topic(self.topic, "std_msgs/msg/String")

    def tick(self) -> str:
        message = self.tree.latest(self.topic)
        default = f"default_{self.what}"
        self.selected = message.data if message is not None else self.selected or self.text(default)
        if not self.selected and default not in self.inputs:
            return FAILURE
        self.output(f"selected_{self.what}", self.selected)
        return SUCCESS


def _selector(what: str) -> type[Selector]:
    ports = (f"selected_{what}", f"default_{what}", "topic_name")
    name = "".join(word.title() for word in what.split("_")) + "Selector"
    return type(
        name, (Selector,), {"__doc__": f"Selects the {what}.", "what": what, "ports": ports, "__module__": __name__}
    )


PlannerSelector = _selector("planner")
ControllerSelector = _selector("controller")
SmootherSelector = _selector("smoother")
GoalCheckerSelector = _selector("goal_checker")
ProgressCheckerSelector = _selector("progress_checker")
PathHandlerSelector = _selector("path_handler")

SERVICE_NODES: Final = {
    **{
        node.__name__: node
        for node in (
            *(ClearEntireCostmap, ClearCostmapAroundRobot, ClearCostmapExceptRegion, ClearCostmapAroundPose),
            *(ReinitializeGlobalLocalization, IsPathValid, ToggleCollisionMonitor, RemoveInCollisionGoals),
            *(CheckPoseOccupancy, PlannerSelector, ControllerSelector, SmootherSelector, GoalCheckerSelector),
            *(ProgressCheckerSelector, PathHandlerSelector),
        )
    },
    "ValidatePath": IsPathValid,
    "clearEntirelyCostmapServiceRequest": ClearEntireCostmap,
    "globalLocalizationServiceRequest": ReinitializeGlobalLocalization,
}
"""Classes by their name in a file."""

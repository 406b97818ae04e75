"""Server of Nav2 that publishes the information about a costmap filter: its type, its mask, and a line of numbers."""

import sys

import rclpy
from nav2_msgs.msg import CostmapFilterInfo
from node_support import ServerNode, run
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, QoSProfile

DEFAULTS = {
    "filter_info_topic": "costmap_filter_info",
    "type": 0,
    "mask_topic": "filter_mask",
    "base": 0.0,
    "multiplier": 1.0,
}
"""Parameters and their defaults."""


class CostmapFilterInfoServer(ServerNode):
    """Node that publishes a `CostmapFilterInfo` (latched) when it becomes active."""

    def __init__(self):
        super().__init__("costmap_filter_info_server")
        for name, default in DEFAULTS.items():
            self.declare_parameter(name, default)
        self._publisher = self._info = None

    def on_configure(self, state):
        """Read the parameters, and open the topic."""
        super().on_configure(state)
        values = {name: self.get_parameter(name).value for name in DEFAULTS}
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._publisher = self.create_publisher(CostmapFilterInfo, values["filter_info_topic"], qos)
        self._info = CostmapFilterInfo(
            type=values["type"],
            filter_mask_topic=values["mask_topic"],
            base=float(values["base"]),
            multiplier=float(values["multiplier"]),
        )
        self._info.header.stamp = self.get_clock().now().to_msg()
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        """Publish the information."""
        super().on_activate(state)
        self._publisher.publish(self._info)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        """Close the topic."""
        super().on_cleanup(state)
        self.destroy_publisher(self._publisher)
        return TransitionCallbackReturn.SUCCESS


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    run(CostmapFilterInfoServer())


if __name__ == "__main__":
    main()

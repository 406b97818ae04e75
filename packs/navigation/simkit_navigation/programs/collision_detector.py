"""Collision detector of Nav2: says in which zones around the robot there are points of obstacles."""

import sys

import rclpy
from collision_sources import ZoneNode
from nav2_msgs.msg import CollisionDetectorState
from node_support import run, warn
from rclpy.lifecycle import TransitionCallbackReturn

from simkit_navigation.plugins.navigation.collision_zones import points_of


class CollisionDetector(ZoneNode):
    """Node that publishes `collision_detector_state` while it is active."""

    def __init__(self):
        super().__init__("collision_detector")

    def on_configure(self, state):
        """Read the zones and the sources, and open the topics."""
        super().on_configure(state)
        self.configure_zones()
        acting = [name for name, zone in self.zones.items() if zone.action != "none"]
        if acting:
            text = f"the action_type of {', '.join(acting)} is not 'none', which a collision detector does not support"
            warn(self, "SK-NAV-004", text)
            self.close_zones()
            return TransitionCallbackReturn.FAILURE
        self._state = self.create_publisher(CollisionDetectorState, "collision_detector_state", 10)
        self._timer = self.create_timer(1.0 / float(self.value("frequency", 10.0)), self._detect)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        """Close the topics."""
        super().on_cleanup(state)
        self.close_zones()
        self.destroy_timer(self._timer)
        self.destroy_publisher(self._state)
        return TransitionCallbackReturn.SUCCESS

    def _detect(self):
        if not self._is_active:
            return
        points = {name: found for name, found in self.points_by_source().items() if found is not None}
        self.publish_points(points)
        zones = list(self.zones.values())
        hits = [zone.is_hit(points_of(zone, points)) for zone in zones]
        self._state.publish(CollisionDetectorState(polygons=[zone.name for zone in zones], detections=hits))
        self.publish_zones((0.0, 0.0, 0.0))


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    run(CollisionDetector())


if __name__ == "__main__":
    main()

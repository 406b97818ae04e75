import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class WallFollower(Node):
    """Program of a reader for ROS 2."""

    def __init__(self):
        super().__init__("wall_follower")
        self.commands = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.drive)
        self.get_logger().info("follows the wall")

    def drive(self):
        """Drive ahead."""
        command = Twist()
        command.linear.x = 0.1
        self.commands.publish(command)


def main():
    """Run the node until Ctrl-C."""
    rclpy.init()
    rclpy.spin(WallFollower())


if __name__ == "__main__":
    main()

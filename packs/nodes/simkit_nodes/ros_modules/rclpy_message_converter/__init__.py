"""Messages as dictionaries and JSON, as the ROS 2 package `rclpy_message_converter`."""

__all__: list[str] = []

"""Functions for messages of `sensor_msgs`, as the ROS 2 package `sensor_msgs_py`."""

__all__: list[str] = []

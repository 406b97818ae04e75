"""Commands for Nav2, as the ROS 2 package `nav2_simple_commander`."""

__all__: list[str] = []

"""Navigation of the TurtleBot 4, as the ROS 2 package `turtlebot4_navigation`."""

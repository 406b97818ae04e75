"""Launch files of ROS 1 and ROS 2, executed without ROS."""

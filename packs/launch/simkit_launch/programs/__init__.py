"""Programs that simkit runs in place of known executables of ROS packages, such as `robot_state_publisher`."""

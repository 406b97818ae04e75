"""Topics, services, actions and live parameters within the process, with the types of ROS 2."""

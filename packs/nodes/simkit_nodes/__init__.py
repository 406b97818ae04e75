"""Pack nodes: programs for ROS run in lock-step with a simulation, without ROS."""

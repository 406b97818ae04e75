"""Navigation of mobile robots, with the names, topics, actions and parameters of ROS 2's Nav2."""

"""Pack turtlesim: the turtles of ROS 2, with their messages, model and world."""

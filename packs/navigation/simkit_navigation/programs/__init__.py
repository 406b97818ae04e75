"""Programs that stand for nodes of ROS; each runs as a program of its own."""

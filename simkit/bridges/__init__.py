"""Give other processes access to a running simulation: sockets, a window, later ROS 2 and the browser."""

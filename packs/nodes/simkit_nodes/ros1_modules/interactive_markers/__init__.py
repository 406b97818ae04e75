"""Markers that people move, as the ROS 1 package `interactive_markers`."""

"""Plugins that bring a robot to goals and waypoints, and behaviours such as turning in place."""

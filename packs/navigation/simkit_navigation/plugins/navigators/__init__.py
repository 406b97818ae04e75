"""Plugins that bring a robot to goals and waypoints."""

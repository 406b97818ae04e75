"""Plugins of turtlesim."""

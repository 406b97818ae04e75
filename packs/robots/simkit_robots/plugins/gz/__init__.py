"""Plugins of Gazebo for the robots of the SubT challenge."""

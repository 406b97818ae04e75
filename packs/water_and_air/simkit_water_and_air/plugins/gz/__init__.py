"""Plugins for water and air by their names in Gazebo Sim."""

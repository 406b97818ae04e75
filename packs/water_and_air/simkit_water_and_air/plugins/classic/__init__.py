"""Plugins for water and air by their names in Gazebo Classic and the projects around it."""

"""Plugins of uuv_simulator and dave for underwater vehicles in Gazebo Classic."""

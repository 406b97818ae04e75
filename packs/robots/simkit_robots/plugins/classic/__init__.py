"""Plugins of Gazebo Classic for Kobuki, Create 3, the sensors of hector_gazebo, and RealSense."""

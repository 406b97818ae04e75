"""Plugins of Gazebo Classic, in ROS 2's and ROS 1's spellings."""

"""Plugins of Gazebo Classic, one kind per file, in the spellings of ROS 2 and of ROS 1.

Code shared with the corresponding plugin of gz is in `drives`, `joints` or `simkit/plugins`. Code shared by
several kinds of Classic is here: `camera_settings`, and `server_services` with its tables of services. A kind of gz is
imported only as a base class.
"""

"""Plugins of Gazebo Classic, one kind a file, in the spellings of ROS 2 and of ROS 1.

What a kind shares with its twin of gz lies in `drives`, `joints`, `fluids` or beside this folder; what several kinds
of Classic share lies here (`camera_settings`, `server_services` with the tables of its services). No kind of gz is
imported but as a base.
"""

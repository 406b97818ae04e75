"""Systems of gz-sim, one kind in each file.

A system is loaded as a plugin of a world file, by the name of its library or its class. It has the same topics and
commands as in Gazebo. Code that a system shares with its Gazebo Classic counterpart is in `drives` and `joints`.
"""

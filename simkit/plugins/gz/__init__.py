"""Systems of gz-sim, one kind a file.

A system enters as the plugin of a file, by its library or its class; it leaves topics and commands as in Gazebo. What a
system shares with its twin of Gazebo Classic lies in `drives`, `joints` and `fluids`, never here.
"""

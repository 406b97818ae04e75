"""Shared code of the plugins that command joints: one axis, a PID, servos, trajectories and kinematic trees.

A plugin passes target values; the modules compute efforts within the limits of each joint. Only `JointCommander` opens
a topic.
"""

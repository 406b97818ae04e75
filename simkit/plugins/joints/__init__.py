"""Shared code of the plugins that command joints: one axis, a PID, servos, trajectories and kinematic trees.

A plugin hands in target values; the modules return efforts within the limits of each joint. No module opens a topic,
except `JointCommander`.
"""

"""URDF with Gazebo's extensions: one file for each concept of the format.

A `<robot>` enters as `Params`; one model of the scene leaves. What stands in `<gazebo>` is read by the readers of
SDF.
"""

"""Loader of URDF with Gazebo's extensions, with one module for each concept of the format.

The input is a `<robot>` element as `Params`; the output is one model of the scene. The readers of SDF read the content
of `<gazebo>`.
"""

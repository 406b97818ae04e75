"""URDF, with Gazebo's extensions: one file per concept of the format."""

from simkit.loaders.urdf.elements import ELEMENTS

__all__ = ["ELEMENTS"]

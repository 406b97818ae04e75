"""Homogeneous matrices, quaternions and Euler angles; the same as `tf.transformations`."""

from __future__ import annotations

from simkit_nodes.ros1_modules.tf import transformations
from simkit_nodes.ros1_modules.tf.transformations import *  # noqa: F403 - the module has the same names

__all__ = list(transformations.__all__)

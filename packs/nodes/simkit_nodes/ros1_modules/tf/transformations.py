"""Homogeneous matrices, quaternions and Euler angles."""

from __future__ import annotations

from simkit_nodes import transformations
from simkit_nodes.transformations import *  # noqa: F403 - the module has the same names

__all__ = list(transformations.__all__)

"""Tests of ROS 1 packages: a program runs the tests of a `unittest.TestCase`."""

from __future__ import annotations

from simkit_nodes.ros1_modules.rostest import unitrun

__all__ = ["unitrun"]

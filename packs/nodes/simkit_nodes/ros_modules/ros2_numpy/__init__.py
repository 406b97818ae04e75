"""Messages as NumPy arrays and back, as the packages `ros2_numpy` and `ros_numpy`."""

from __future__ import annotations

from simkit_nodes.message_arrays import msgify, numpify

__all__ = ["msgify", "numpify"]

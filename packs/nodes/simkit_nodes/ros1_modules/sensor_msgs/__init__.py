"""Package of messages, which has the module `point_cloud2` in ROS 1."""

from __future__ import annotations

from typing import Final

IS_OF_INTERFACES: Final = True

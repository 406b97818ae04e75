"""Parts that rclpy implements in C."""

from __future__ import annotations

__all__: list[str] = []

"""Text of a launch description."""

from __future__ import annotations

from typing import Any

__all__ = ["LaunchIntrospector"]


class LaunchIntrospector:
    """Writer of launch descriptions as text."""

    def format_launch_description(self, launch_description: Any) -> str:
        """Return a line for each item of a launch description."""
        lines = [str(launch_description)]

        def add(items: Any, level: int) -> None:
            for item in items:
                lines.append(f"{'    ' * level}{item.describe()}")
                add(item.describe_sub_entities(), level + 1)

        add(launch_description.entities, 1)
        return "\n".join(lines)

"""Definitions of actions, in the `.action` form of ROS 2: the goal, `---`, the result, `---`, the feedback.

They are published interfaces: field names, types and order are theirs. An action of type `<package>/action/<Name>` has
the messages `<package>/action/<Name>_Goal`, `…_Result` and `…_Feedback`.
"""

from __future__ import annotations

from simkit.msgs import control, motions

MESSAGES: dict[str, str] = {
    **control.MESSAGES,
    **motions.MESSAGES,
}
"""What the actions are made of and the store lacks."""

ACTIONS: dict[str, str] = {
    **control.ACTIONS,
    "example_interfaces/action/Fibonacci": """
int32 order
---
int32[] sequence
---
int32[] sequence
""",
    **motions.ACTIONS,
}

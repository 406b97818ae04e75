"""Base of Fetch's controllers: each starts with its first goal, unless another one has a goal for its joints."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

from simkit import Params
from simkit.plugins.ros_parameter_files import Entry
from simkit_control.plugins.ros2_control.controller import Controller

if TYPE_CHECKING:
    from simkit.extend import GoalHandle
    from simkit.runtime.communication.action_server import Action

_REFUSED: Final = "Cannot execute, unable to start controller."


class RobotController(Controller):
    """Controller whose actions have the controller's own name, and which starts with its first goal.

    Attributes:
        autostart: true if the controller is active from the start.
    """

    autostart = False

    @property
    def has_goal(self) -> bool:
        """True while a goal is active, so that no other controller may take the joints."""
        return getattr(self, "_goal", None) is not None

    def act(
        self,
        action: str,
        type_name: str,
        on_goal: Callable[[GoalHandle], None],
        on_cancel: Callable[[GoalHandle], bool | None] | None = None,
    ) -> Action:
        def start_and_accept(goal: GoalHandle) -> None:
            if self.manager.request_start(self.name):
                on_goal(goal)
            else:
                goal.reject(_REFUSED)

        return super().act(f"/{self.plugin.ros.topic(self.name).lstrip('/')}", type_name, start_and_accept, on_cancel)

    @property
    def manager(self) -> Any:
        """Controller manager of Fetch."""
        return self.plugin.manager  # type: ignore[attr-defined]

    def rename(self, values: Mapping[str, object]) -> None:
        """Replace the parameters by those that the base class reads."""
        original = self.params
        self.autostart = original.boolean("autostart", self.autostart)
        entry = _entry(values, original)
        self.params = entry.block(self.name, original.diagnostics)


def _entry(value: object, params: Params) -> Entry:
    if isinstance(value, Mapping):
        return Entry(params.where, below={name: _entry(item, params) for name, item in value.items()})
    if isinstance(value, (list, tuple)):
        return Entry(params.where, items=[_entry(item, params) for item in value])
    text = str(value).lower() if isinstance(value, bool) else str(value)
    return Entry(params.where, text, is_text=isinstance(value, str))

"""Reports that a running controller makes once each, however often there is cause."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from simkit.control.controller import Controller


class Reported:
    """Reports of a controller that are made once each; a handle, without state that a reset forgets."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._said: set[str] = set()

    def warn(self, code: str, what: str, message: str, hint: str = "") -> None:
        """A warning at the controller's place in the YAML, once for each `what`."""
        if what in self._said:
            return
        self._said.add(what)
        controller = self._controller
        controller.sim.reports.warning(
            code, f"controller {controller.name!r}: {message}", controller.params.where, hint
        )

    def __deepcopy__(self, memo: dict[int, Any]) -> Reported:
        return self

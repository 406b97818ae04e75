"""Parameter server of ROS 1 in a running simulation, as programs in processes of their own use it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from simkit.live import LiveError
from simkit_nodes.ros1_parameters import ParameterServer, parameter_value


class SharedParameterServer(ParameterServer):
    """Parameter server of a simulation in another process, which the programs of all terminals share.

    Args:
        ask: function that sends a request to the simulation and returns its answer.
    """

    def __init__(self, ask: Callable[..., object]) -> None:
        super().__init__()
        self._ask_simulation = ask

    def get(self, name: str) -> Any:
        """Return a copy of a value.

        Raises:
            KeyError: there is no such parameter.
        """
        found = self._ask("get", name)
        if not found:
            raise KeyError(name)
        return found[0]

    def set(self, name: str, value: object) -> None:
        """Set a value; a dictionary replaces all parameters below the name.

        Raises:
            TypeError: a parameter cannot have such a value.
            OverflowError: an integer has more than 32 bits.
        """
        self._ask("set", name, value=parameter_value(value))

    def add(self, name: str, value: object) -> None:
        """Set a value; a dictionary sets all parameters below the name, and others there stay, as `rosparam load`."""
        self._ask("add", name, value=parameter_value(value))

    def delete(self, name: str) -> None:
        """Delete a value with all values below it.

        Raises:
            KeyError: there is no such parameter.
        """
        if not self._ask("delete", name):
            raise KeyError(name)

    def search(self, node: str, name: str) -> str | None:
        """Return the global name of a parameter in the innermost namespace around a node that has its first part."""
        found: str | None = self._ask("search", name, node=node)[0]
        return found

    def names(self) -> list[str]:
        """Return the names of all values that are no dictionaries."""
        return list(self._ask("names", "/"))

    def _ask(self, action: str, name: str, **args: object) -> Any:
        try:
            return self._ask_simulation("parameter_server", action=action, name=name, **args)
        except LiveError as error:
            raise TypeError(str(error)) from None

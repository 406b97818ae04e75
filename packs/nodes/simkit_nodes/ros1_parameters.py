"""Parameter server of ROS 1: a tree of values by name, which all programs share."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from datetime import datetime
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import InputError
from simkit_nodes.ros1_names import SEP, is_global, is_legal_name, is_private

if TYPE_CHECKING:
    from simkit_nodes.host import Host

SERVER: Final = "ROS 1 parameters"
"""Name of the parameter server among the objects that all programs share."""
_VALUES: Final = (bool, int, float, str, bytes, datetime)
_INTEGERS: Final = range(-(2**31), 2**31)


class ParameterServer:
    """Values by their global names; a name with values below it is a dictionary.

    Args:
        values: pairs of a global name and its first value, besides those of every server; a later one replaces an
            earlier one.
    """

    def __init__(self, values: Iterable[tuple[str, object]] = ()) -> None:
        self._root: dict[str, Any] = {
            "rosdistro": "noetic\n",
            "rosversion": "1.16.0\n",
            "use_sim_time": True,
        }
        for name, value in values:
            self.add(name, value)

    def get(self, name: str) -> Any:
        """Return a copy of a value.

        Raises:
            KeyError: there is no such parameter.
        """
        value: Any = self._root
        for part in _parts(name):
            if not isinstance(value, dict) or part not in value:
                raise KeyError(name)
            value = value[part]
        return parameter_value(value)

    def set(self, name: str, value: object) -> None:
        """Set a value; a dictionary replaces all parameters below the name.

        Raises:
            TypeError: a parameter cannot have such a value.
            OverflowError: an integer has more than 32 bits.
        """
        value = parameter_value(value)
        *parents, last = _parts(name) or [""]
        if not last:
            if not isinstance(value, dict):
                raise TypeError("cannot set root of parameter tree to non-dictionary")
            self._root = value
            return
        folder = self._root
        for part in parents:
            if not isinstance(folder.get(part), dict):
                folder[part] = {}
            folder = folder[part]
        folder[last] = value

    def add(self, name: str, value: object) -> None:
        """Set a value; a dictionary sets all parameters below the name, and others there stay, as `rosparam load`."""
        if isinstance(value, Mapping) and value:
            for key, item in value.items():
                self.add(f"{name}{SEP}{key}", item)
        else:
            self.set(name, value)

    def delete(self, name: str) -> None:
        """Delete a value with all values below it.

        Raises:
            KeyError: there is no such parameter.
        """
        *parents, last = _parts(name) or [""]
        folder: Any = self._root
        for part in parents:
            folder = folder.get(part) if isinstance(folder, dict) else None
        if not isinstance(folder, dict) or last not in folder:
            raise KeyError(name)
        del folder[last]

    def has(self, name: str) -> bool:
        """Check whether there is a value or a value below a name."""
        try:
            self.get(name)
        except KeyError:
            return False
        return True

    def search(self, node: str, name: str) -> str | None:
        """Return the global name of a parameter in the innermost namespace around a node that has its first part.

        Args:
            node: full name of the node.
            name: name of the parameter.
        """
        if is_global(name):
            return name if self.has(name) else None
        parts, folders = _parts(name), _parts(node)
        for count in range(len(folders), -1, -1):
            prefix = folders[:count]
            if parts and self.has(SEP + SEP.join([*prefix, parts[0]])):
                return SEP + SEP.join([*prefix, *parts])
        return None

    def names(self) -> list[str]:
        """Return the names of all values that are no dictionaries."""
        return list(_leaves(self._root, ""))


def parameter_value(value: object) -> Any:
    """Return a copy of a value in the form in which a parameter has it: a tuple becomes a list.

    Raises:
        TypeError: a parameter cannot have such a value.
        OverflowError: an integer has more than 32 bits.
    """
    if isinstance(value, Mapping):
        if not all(isinstance(key, str) for key in value):
            raise TypeError("dictionary key must be string")
        return {key: parameter_value(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [parameter_value(item) for item in value]
    if type(value) not in _VALUES:
        if value is None:
            raise TypeError("cannot marshal None unless allow_none is enabled")
        raise TypeError(f"cannot marshal {type(value)} objects")
    if type(value) is int and value not in _INTEGERS:
        raise OverflowError("int exceeds XML-RPC limits")
    return value


def _parts(name: str) -> list[str]:
    return [part for part in name.split(SEP) if part]


def _leaves(folder: dict[str, Any], prefix: str) -> Iterator[str]:
    for name, value in folder.items():
        if isinstance(value, dict):
            yield from _leaves(value, f"{prefix}/{name}")
        else:
            yield f"{prefix}/{name}"


def parameter_server(host: Host) -> ParameterServer:
    """Return the parameter server of the programs of a host; it begins with the parameters of the run."""
    server = host.graph.shared.get(SERVER)
    if server is None:
        server = host.graph.shared[SERVER] = ParameterServer(host.graph.run_parameters)
    assert isinstance(server, ParameterServer)
    return server


def set_run_parameters(host: Host, values: Mapping[str, object]) -> None:
    """Set parameters that exist before the programs of a host start, and again after a reset.

    Args:
        host: host of the programs.
        values: values by global name; dictionaries are namespaces.

    Raises:
        InputError: SK-NODE-066 a name or a value is not allowed.
    """
    added = ParameterServer()
    for name, value in values.items():
        try:
            if not is_legal_name(name) or is_private(name) or not _parts(name):
                raise TypeError("a name has letters, digits and _ between slashes")
            added.add(name, value)
        except (TypeError, OverflowError) as error:
            text = f"parameter {name!r} of the parameter server: {error}"
            help_ = "a value is a bool, an integer of 32 bits, a number, a text, or a list or mapping of these"
            raise InputError("SK-NODE-066", text, help=help_) from None
    server = parameter_server(host)
    for name, value in values.items():
        host.graph.run_parameters.append((name, value))
        server.add(name, value)

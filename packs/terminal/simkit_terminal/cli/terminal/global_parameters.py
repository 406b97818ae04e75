"""Parameters by one global name, as `rosparam` has them: those of nodes, and those of the parameter server of ROS 1."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from simkit.cli.terminal.output import JsonObject, JsonValue, not_found_error
from simkit.cli.terminal.topic_sources import connection_name
from simkit.errors import InputError
from simkit.input_file import read_failure, read_input_text
from simkit.yaml_reader import NotYaml, read_yaml
from simkit_terminal.cli.terminal.named_endpoints import LIST_PARAMETERS, parameter_nodes
from simkit_terminal.cli.terminal.parameter_values import parameter_value, plain_value

if TYPE_CHECKING:
    from simkit.live import Client

Place = tuple[str, str]
"""Node and name of a parameter."""


class GlobalParameters:
    """Parameters of a running simulation by global names such as `/turtlesim/background_r`.

    A name that belongs to a node is the parameter of this node. A name without a namespace may also be the parameter
    of the only node that has it. Every other name is one of the parameter server.

    Args:
        client: connection to the simulation.

    Attributes:
        nodes: names of the parameters of each node.
    """

    def __init__(self, client: Client) -> None:
        self._client = client
        self.nodes = {
            node: set(client.call(node + LIST_PARAMETERS, {}).result.names) for node in parameter_nodes(client)
        }

    def place_of(self, name: str) -> Place | None:
        """Return node and name of the parameter of a node; None for a name of the parameter server.

        Raises:
            InputError: SK-CLI-034 several nodes have a parameter of the name.
        """
        parts = [part for part in name.split("/") if part]
        for count in range(len(parts) - 1, 0, -1):
            node, rest = "/" + "/".join(parts[:count]), ".".join(parts[count:])
            if rest in self.nodes.get(node, ()):
                return node, rest
        owners = [node for node, names in self.nodes.items() if len(parts) == 1 and parts[0] in names]
        if len(owners) > 1:
            text = f"several nodes have a parameter {parts[0]!r}: {', '.join(owners)}"
            raise InputError("SK-CLI-034", text, help=f"name the node: {owners[0]}/{parts[0]}")
        return (owners[0], parts[0]) if owners else None

    def value(self, name: str) -> JsonValue:
        """Return a value, or all values below a namespace as a dictionary.

        Raises:
            InputError: SK-CLI-034 there is no such parameter.
        """
        place = self.place_of(name)
        if place is not None:
            values = self._client.call(f"{place[0]}/get_parameters", {"names": [place[1]]}).values
            return plain_value(values[0])
        found = self._client.ask("parameter_server", action="get", name=name)
        tree = self._tree_of_nodes(name)
        if not tree:
            if not found:
                raise not_found_error("parameter", name, self.names(), "SK-CLI-034", connection_name(self._client))
            return found[0]
        return _merged(found[0] if found and isinstance(found[0], dict) else {}, tree)

    def names(self) -> list[str]:
        """Return all names, sorted."""
        of_nodes = [f"{node}/{name.replace('.', '/')}" for node, names in self.nodes.items() for name in names]
        of_server: list[str] = self._client.ask("parameter_server", action="names", name="/")
        return sorted({*of_nodes, *of_server})

    def set(self, name: str, value: JsonValue) -> str:
        """Set a value; return the reason why the node rejected it, or an empty text."""
        place = self.place_of(name)
        if place is None:
            self._client.ask("parameter_server", action="set", name=name, value=value)
            return ""
        converted = parameter_value(value)
        if converted is None:
            return f"{value!r} is not a value of a parameter of a node"
        request = {"parameters": [{"name": place[1], "value": converted}]}
        result = self._client.call(f"{place[0]}/set_parameters", request).results[0]
        return "" if result.successful else str(result.reason) or "no reason was given"

    def delete(self, name: str) -> bool:
        """Delete a value of the parameter server with all values below it; return False if there is none."""
        return bool(self._client.ask("parameter_server", action="delete", name=name))

    def _tree_of_nodes(self, namespace: str) -> JsonObject:
        """Return the parameters of the nodes below a namespace, as nested dictionaries."""
        prefix = [part for part in namespace.split("/") if part]
        tree: JsonObject = {}
        for node, names in self.nodes.items():
            parts = [part for part in node.split("/") if part]
            if parts[: len(prefix)] != prefix or not names:
                continue
            ordered = sorted(names)
            values = self._client.call(f"{node}/get_parameters", {"names": ordered}).values
            for name, value in zip(ordered, values, strict=True):
                path: list[str] = parts[len(prefix) :] + str(name).split(".")
                branch = tree
                for part in path[:-1]:
                    branch = branch.setdefault(part, {})
                branch[path[-1]] = plain_value(value)
        return tree


def read_parameter_tree(path: Path) -> list[tuple[str, JsonValue]]:
    """Read a file of `rosparam dump`; return the names below its namespace, and their values.

    Raises:
        InputError: SK-CLI-041 the file is invalid.
    """
    try:
        root = read_yaml(read_input_text(path))
    except (OSError, UnicodeDecodeError) as error:
        raise InputError("SK-CLI-041", f"{path} cannot be read: {read_failure(error)}") from None
    except NotYaml as error:
        raise InputError("SK-CLI-041", f"{path} is not YAML: {error}") from None
    if not isinstance(root, dict) or not root:
        raise InputError("SK-CLI-041", f"{path} is not a mapping of names to values")
    return _leaves(root, "")


def _leaves(block: dict[object, JsonValue], prefix: str) -> list[tuple[str, JsonValue]]:
    found: list[tuple[str, JsonValue]] = []
    for key, value in block.items():
        name = f"{prefix}/{str(key).strip('/')}"
        found += _leaves(value, name) if isinstance(value, dict) and value else [(name, value)]
    return found


def _merged(one: JsonObject, other: JsonObject) -> JsonObject:
    """Return two trees as one; values of the second replace those of the first."""
    result = dict(one)
    for key, value in other.items():
        known = result.get(key)
        result[key] = _merged(known, value) if isinstance(known, dict) and isinstance(value, dict) else value
    return result

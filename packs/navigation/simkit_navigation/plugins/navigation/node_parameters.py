"""Parameters of a navigation plugin in a parameter file of Nav2: `--params-file`, or `<ros>` of the plugin."""

from __future__ import annotations

from contextlib import suppress
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar

from simkit import Params, Plugin
from simkit.diagnostics import Where
from simkit.plugins.ros_parameter_block import ParameterBlock

if TYPE_CHECKING:
    from simkit import Simulation


class NodeParameters(Plugin):
    """Plugin that does the work of a node of Nav2, and reads the parameters of this node.

    A value of a parameter file replaces the element of the same name in the world.

    Attributes:
        executable: executable of the node, a row of `SERVER_NODES`; "" for a costmap.
    """

    executable: ClassVar[str] = ""

    @property
    def node_names(self) -> tuple[str, ...]:
        """Full names of the nodes whose parameters the plugin has."""
        space, node = self.ros.namespace, self.ros.node
        return (f"{space}/{node}",) if self.executable else (f"{space}/{node}/{node}", f"{space}/{node}")

    def join_simulation(self, sim: Simulation) -> None:
        """Connect the plugin to its simulation, and read its parameter files."""
        super().join_simulation(sim)
        values, places = self._values_of(self.node_names)
        if not values:
            return
        tables = _tables()
        if self.executable:
            row = tables.SERVER_NODES[self.executable]
            costmap = f"{self.ros.namespace}/{row.costmap}"
            of_costmap = self._values_of((f"{costmap}/{row.costmap}", costmap))[0] if row.costmap else {}
            plugin = row.plugins(values, of_costmap)[-1]
        else:
            plugin = tables.costmap_plugin(self.ros.node, values)
        unused: list[str] = []
        of_file = plugin.params(places, unused, self.params.diagnostics)
        in_world = {child.name for child in self.params.children}
        # a default of Nav2, which is not in the file, replaces no element
        used = [child for child in of_file.children if child.name in values or child.name not in in_world]
        names = {child.name for child in used}
        others = [child for child in self.params.children if child.name not in names]
        where, diagnostics = next(iter(places.values())), self.params.diagnostics
        self.params = Params(
            self.params.name, self.params.value, self.params.attributes, [*used, *others], self.where,
            diagnostics,
        )  # fmt: skip
        for sentence in plugin.told:
            diagnostics.warning("SK-NAV-001", f"plugin {self.name!r}: {sentence}", where)
        if unused:
            text = f"plugin {self.name!r}: no effect here: {tables.shortened(unused)}"
            diagnostics.warning("SK-NAV-002", text, places.get(unused[0], where))

    def _values_of(self, names: tuple[str, ...]) -> tuple[dict[str, object], dict[str, Where]]:
        """Return the values of the first node that has some, and their places by names with dots."""
        builder = self.sim.engine.structure.builder
        for name in names:
            block = self.ros.values_of_node(name, None, builder)
            if block is not None:
                places: dict[str, Where] = {}
                return _tables().nested(_plain(block, "", places)), places
        return {}, {}


def _tables() -> Any:
    """Return the module with the tables of nodes, which imports the classes of all plugins."""
    return import_module("simkit_navigation.nav2_parameters")


def _plain(block: ParameterBlock, prefix: str, places: dict[str, Where]) -> dict[str, object]:
    """Return the values of a block as Python values; blocks are dictionaries, and lists are lists."""
    values: dict[str, object] = {}
    for child in block.children:
        form, where = block.forms[child.name]
        places.setdefault(f"{prefix}{child.name}", where)
        if isinstance(child, ParameterBlock) and form == "block":
            values[child.name] = _plain(child, f"{prefix}{child.name}.", places)
        elif form == "list":
            items = values.setdefault(child.name, [])
            assert isinstance(items, list)
            items.append(_value(child.value))
        else:
            values[child.name] = _value(child.value)
    for name, (form, where) in block.forms.items():
        if form == "list" and name not in values:
            values[name], places[f"{prefix}{name}"] = [], where
    return values


def _value(text: str) -> bool | float | str:
    """Return a value in the type that the tables of nodes expect."""
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        with suppress(ValueError):
            return kind(text)
    return text

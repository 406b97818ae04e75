"""Parameters of a navigation plugin in a parameter file of Nav2: `--params-file`, or `<ros>` of the plugin."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, ClassVar

from simkit import Params, Plugin
from simkit.extend import Where
from simkit.plugins.ros_parameter_block import ParameterBlock
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values, nested, shortened

if TYPE_CHECKING:
    from simkit import Simulation


class NodeParameters(Plugin):
    """Plugin that does the work of a node of Nav2, and reads the parameters of this node.

    A value of a parameter file replaces the element of the same name in the world.

    Attributes:
        costmap: name of the costmap whose parameters the plugin needs, too; empty without one.
    """

    costmap: ClassVar[str] = ""

    @classmethod
    def translate_parameters(cls, values: Values, costmap: Values, /) -> NodeValues:  # noqa: ARG003  subclasses use it
        """Return the parameters of a node of Nav2 as those of the plugin.

        Args:
            values: parameters of the node; blocks are dictionaries.
            costmap: parameters of its costmap.
        """
        return NodeValues(dict(values))

    def join_simulation(self, sim: Simulation) -> None:
        """Connect the plugin to its simulation, and read its parameter files."""
        super().join_simulation(sim)
        values, places = self._values_of(self.node_names)
        if not values:
            return
        costmap = f"{self.ros.namespace}/{self.costmap}"
        of_costmap = self._values_of((f"{costmap}/{self.costmap}", costmap))[0] if self.costmap else {}
        translated = self.translate_parameters(values, of_costmap)
        unused: list[str] = []
        of_file = translated.elements(type(self), places, unused, self.params.diagnostics)
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
        for sentence in translated.told:
            diagnostics.warning("SK-NAV-001", f"plugin {self.name!r}: {sentence}", where)
        if unused:
            text = f"plugin {self.name!r}: no effect here: {shortened(unused)}"
            diagnostics.warning("SK-NAV-002", text, places.get(unused[0], where))

    def _values_of(self, names: tuple[str, ...]) -> tuple[dict[str, object], dict[str, Where]]:
        """Return the values of the first node that has some, and their places by names with dots."""
        builder = self.sim.engine.structure.builder
        for name in names:
            block = self.ros.values_of_node(name, None, builder)
            if block is not None:
                places: dict[str, Where] = {}
                return nested(_plain(block, "", places)), places
        return {}, {}


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

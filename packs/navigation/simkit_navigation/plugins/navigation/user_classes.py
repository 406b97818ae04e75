"""Classes that do a part of the work of a navigation server: those of simkit, and those that users write."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from simkit import Params, Plugin
from simkit.extend import SharedByCopies
from simkit.msgs import Message
from simkit.plugins.attribute_state import copy_attributes, restore_attributes
from simkit.plugins.discovery.user_plugins import find_user_class, find_user_class_by_name
from simkit.scene import ScenePlugin
from simkit_navigation.plugins.navigation.node_parameters import NodeParameters
from simkit_navigation.plugins.navigation.node_values import split_names

if TYPE_CHECKING:
    from simkit import Subscription


class _Parts(SharedByCopies):
    """Objects by name, which a restore keeps."""

    def __init__(self) -> None:
        self.by_name: dict[str, Any] = {}


class ServerPlugin(NodeParameters):
    """Plugin whose work is done by objects of selectable classes.

    A snapshot contains the attributes of these objects. A restore keeps the objects, because callbacks refer to them.
    """

    parent_kind = ("world", "model")
    _parts = _Parts()  # of a plugin whose `load` has failed

    def make_parts(
        self,
        names: tuple[str, ...],
        defaults: Mapping[str, str],
        known: Mapping[str, type[object]],
        methods: tuple[str, ...],
        begin: str,
        replaced: Mapping[str, tuple[str, str]] = MappingProxyType({}),
    ) -> None:
        """Create an object for each name of a list of Nav2, such as `<planner_plugins>`.

        The block of parameters with the name contains `<plugin>`: `file.py:Class`, or a name of C++ such as
        `my_package::MyPlanner`. A class in a file under the plugin paths, whose attribute `names` has the name of C++,
        comes before a class of simkit. A class that is not found, or that lacks one of the methods, is reported as an
        error.

        Args:
            names: elements with the names of the list; empty for those of `defaults`.
            defaults: class by name, for blocks without `<plugin>`.
            known: classes of simkit by their name in Nav2.
            methods: methods that the class must have.
            begin: method that receives the plugin and the block of parameters, if the class has it.
            replaced: names of classes of Nav2 that simkit does not have; for each one the name of the class that
                replaces it, and what the replacement changes.
        """
        self._parts = _Parts()
        for name in split_names(names) or defaults:
            block = self.params.block(name)
            wanted = block.text("plugin", "") or defaults.get(name, "")
            cls = _class(self, ScenePlugin(name, wanted, self.scoped, block, block.where), known, replaced)
            if cls is None:
                continue
            missing = [method for method in methods if not callable(getattr(cls, method, None))]
            if missing:
                self.params.error("SK-PLUGIN-008", f"{name}: the class {wanted!r} has no method {missing[0]!r}")
                continue
            part = self._parts.by_name[name] = cls()
            if callable(getattr(part, begin, None)):
                getattr(part, begin)(self, block)

    def find_class(
        self, name: str, wanted: str, block: Params, known: Mapping[str, type[object]]
    ) -> type[object] | None:
        """Return a class of a user or of simkit, by the rules of `make_parts`; None after an error.

        Args:
            name: name of the block of parameters.
            wanted: name of the class.
            block: block of parameters.
            known: classes of simkit by their name in Nav2.
        """
        return _class(self, ScenePlugin(name, wanted, self.scoped, block, block.where), known, {})

    def receive(self, topic: str, type_name: str, parameter: str, callback: Callable[[Message], None]) -> Subscription:
        """Call a function with each message of a type; messages of another type are ignored after a warning.

        Args:
            topic: name of the topic, expanded and remapped as in ROS.
            type_name: type of the messages.
            parameter: parameter with the name of the topic.
            callback: function called with each message.
        """
        return self.subscribe(topic, partial(self._pass_on, type_name, parameter, callback))

    def _pass_on(self, type_name: str, parameter: str, callback: Callable[[Message], None], message: Message) -> None:
        if self._once.has_type(message, type_name, parameter):
            callback(message)

    @property
    def parts(self) -> dict[str, Any]:
        """Objects by name."""
        return self._parts.by_name

    def get_state(self) -> dict[str, object]:
        self._part_states = {
            name: dict(copy_attributes(part, (), self._report_uncopied)) for name, part in self.parts.items()
        }
        return super().get_state()

    def set_state(self, state: Mapping[str, object]) -> None:
        super().set_state(state)
        for name, part in self.parts.items():
            restore_attributes(part, (), self._part_states[name])


def _class(
    node: Plugin,
    named: ScenePlugin,
    known: Mapping[str, type[object]],
    replaced: Mapping[str, tuple[str, str]],
) -> type[object] | None:
    """Return a class of a user or of simkit; None after an error."""
    wanted, diagnostics = named.filename.replace("/", "::"), node.params.diagnostics
    if ":" in named.filename.replace("::", ""):
        return find_user_class(named, node.plugin_paths, diagnostics)
    found = find_user_class_by_name(named, node.plugin_paths, diagnostics) or known.get(wanted)
    if found is None and wanted in replaced:
        other, change = replaced[wanted]
        text = f"{node.name}: {named.name}: {other} replaces {wanted}; {change}"
        diagnostics.warning("SK-NAV-001", text, named.where)
        return known[other]
    if found is None:
        diagnostics.error(
            "SK-PLUGIN-008",
            f"plugin {node.name!r}: <{named.name}><plugin>: found {named.filename!r}",
            named.where,
            f"write file.py:Class, or one of {', '.join(known)}; or give a class in a file under a plugin path the "
            f'attribute names = ("{wanted}",)',
        )
    return found

"""Topic names as in a ROS node: namespace, remapping, `~/private` names."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.not_deep_copied import SharedByCopies

_RULE = re.compile(r"^(?P<from>[^=]+?):=(?P<to>.+)$")


def is_ros_1(params: Params, names: Iterable[str]) -> bool:
    """Check whether a plugin's parameters are those of ROS 1: one of `names` occurs, and there is no `<ros>` block."""
    return not params.has("ros") and any(params.has(name) for name in names)


class RosNames(SharedByCopies):
    """Names of a ROS node.

    Args:
        node: name of the node; `~/x` becomes `<namespace>/<node>/x`.
        namespace: namespace such as `tb3` or `/tb3`; may be empty.
        remappings: target name by source name; all names are expanded before they are compared.
        params: parameters of the plugin; invalid names are reported at their line.
    """

    def __init__(
        self,
        node: str,
        namespace: str = "",
        remappings: Mapping[str, str] = MappingProxyType({}),
        params: Params | None = None,
    ) -> None:
        self.node = node
        self._params = params
        self.namespace = "/" + namespace.strip("/") if namespace.strip("/") else ""
        self._rules = {self._expand(a): self._expand(b) for a, b in remappings.items()}

    @classmethod
    def from_params(cls, params: Params, node: str) -> RosNames:
        """Read the `<ros>` block of ROS 2 plugins, or `<robotNamespace>` of ROS 1 plugins."""
        remappings: dict[str, str] = {}
        namespace = params.text("robotNamespace", "")
        ros = params.child("ros")
        if ros is None:
            return cls(node, namespace, params=params)
        namespace = ros.text("namespace", namespace)
        for element in ros.all("remapping") + ros.all("argument"):
            for word in element.value.split():
                rule = _RULE.match(word)
                if rule is None:
                    if word not in {"--ros-args", "-r", "--remap"}:
                        allowed = "from:=to" if element.name == "remapping" else "a remapping from:=to"
                        element.error(
                            "SK-PARAM-002", f"found <{element.name}>{word}</{element.name}>; expected {allowed}"
                        )
                    continue
                source, target = rule["from"], rule["to"]
                if source in {"__ns", "__node", "__name"}:
                    namespace, node = (target, node) if source == "__ns" else (namespace, target)
                else:
                    remappings[source.removeprefix(node + ":")] = target
        return cls(node, namespace, remappings, params)

    def topic(self, name: str) -> str:
        """Return the absolute, remapped topic of `name` (`odom`, `/odom` or `~/odom`) without invalid characters."""
        full = self._expand(name)
        full = self._rules.get(full, full)
        clean = valid_topic(full)
        if clean.strip("/") == full.strip("/"):
            return full
        if self._params is not None:
            allowed = "expected letters, digits and _ / . : -"
            message = f"plugin {self.node!r}: found a topic {full!r}, {allowed}; {clean!r} is used instead"
            self._params.diagnostics.warning("SK-PLUGIN-012", message, self._params.where)
        return clean

    def _expand(self, name: str) -> str:
        if name == "~" or name.startswith("~/"):
            return f"{self.namespace}/{self.node}{name[1:]}"
        return name if name.startswith("/") else f"{self.namespace}/{name}"

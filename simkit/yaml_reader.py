"""Reader for YAML files of users: returns plain values, or raises NotYaml with the reason."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import SimkitError

if TYPE_CHECKING:
    import yaml

_DEEPEST: Final = 100
_MOST: Final = 1_000_000  # values; repeated aliases expand a short text to very many values
_MOST_DIGITS: Final = 1000  # the largest float has 309
# possessive quantifiers: the time is proportional to the length, also for a million digits
_EXPONENT: Final = re.compile(r"[-+]?(?:[0-9]++\.?[0-9]*+|\.[0-9]++)[eE][-+]?[0-9]+$")
_SEXAGESIMAL: Final = re.compile(r"[-+]?[0-9][0-9_]*(?::[0-5]?[0-9])+(?:\.[0-9_]*)?$")


class NotYaml(SimkitError):
    """Invalid YAML; the message has the reason.

    Attributes:
        line: line of the text, counted from 1; None if it is unknown.
    """

    def __init__(self, why: str, line: int | None = None) -> None:
        super().__init__(why)
        self.line = line


def read_yaml(text: str) -> Any:
    """Return the values of a YAML text.

    Numbers follow YAML 1.2 and ROS: `1e-3` is a number (a text in YAML 1.1), and `12:30` is a text (750 in YAML 1.1).

    Raises:
        NotYaml: the text is not YAML, a value does not fit its tag, or a value contains itself.
    """
    root = compose_nodes(text)
    return None if root is None else node_value(root)


def compose_nodes(text: str) -> Any:
    """Return the root node of a text; nodes know their lines. An empty text gives None.

    Raises:
        NotYaml: the text is not YAML.
    """
    import yaml

    try:
        return yaml.compose(text, Loader=yaml_loader())
    except yaml.YAMLError as error:
        raise _yaml_error(error) from None
    except RecursionError:
        raise NotYaml("the text is nested too deeply") from None


def node_value(node: yaml.Node) -> Any:
    """Return the value of a node.

    Raises:
        NotYaml: a value does not fit its tag, a value contains itself, or aliases expand to too many values.
    """
    import yaml

    try:
        value = yaml_loader()("").construct_document(node)
        _check_size(value)
    except yaml.YAMLError as error:
        raise _yaml_error(error) from None
    except RecursionError:
        raise NotYaml("the text is nested too deeply") from None
    except (ValueError, LookupError, TypeError, AttributeError, OverflowError) as error:  # it does not fit its tag
        reason = error.args[0] if error.args else ""
        raise NotYaml(f"a value does not fit its type: {str(reason).partition(';')[0]:.200}") from None
    return value


def finite_number(value: object) -> float | None:
    """Return a value as a float; None unless the value is a finite number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        return float(value) if math.isfinite(value) else None
    except OverflowError:  # a whole number of hundreds of digits
        return None


def yaml_loader() -> type[yaml.SafeLoader]:
    """Return PyYAML's safe loader with the number rules of `read_yaml` and a size limit for merges (`<<`)."""
    import yaml

    class Reader(yaml.SafeLoader):
        """Subclass of the loader, so that its number rules do not change PyYAML's own loader."""

        _merged = 0

        def flatten_mapping(self, node: yaml.MappingNode) -> None:
            super().flatten_mapping(node)
            self._merged += len(node.value)
            if self._merged > _MOST:
                message = f"the text expands to more than {_MOST} values"
                raise yaml.constructor.ConstructorError(None, None, message, node.start_mark)

        def construct_yaml_int(self, node: yaml.ScalarNode) -> int:
            # Python refuses to print an integer of more than 4300 digits, so that no message could show it
            if len(node.value) > _MOST_DIGITS:
                message = f"an integer has more than {_MOST_DIGITS} digits"
                raise yaml.constructor.ConstructorError(None, None, message, node.start_mark)
            return super().construct_yaml_int(node)

    Reader.add_constructor("tag:yaml.org,2002:int", Reader.construct_yaml_int)
    Reader.add_implicit_resolver("tag:yaml.org,2002:float", _EXPONENT, list("-+.0123456789"))
    for sign, known in Reader.yaml_implicit_resolvers.items():
        if sign in "-+0123456789":
            known.insert(0, ("tag:yaml.org,2002:str", _SEXAGESIMAL))
    return Reader


def _yaml_error(error: object) -> NotYaml:
    mark = getattr(error, "problem_mark", None)
    why = getattr(error, "problem", None) or str(error).splitlines()[0]
    return NotYaml(why, None if mark is None else mark.line + 1)


def _check_size(root: object) -> None:
    """Raise an error if a tree is too large or too deep; a value that contains itself is too deep."""
    count, left = 0, [(root, 0)]
    while left:
        value, depth = left.pop()
        below = value.values() if isinstance(value, dict) else value if isinstance(value, (list, tuple, set)) else ()
        count += 1 + len(below)
        if depth > _DEEPEST:
            raise RecursionError
        if count > _MOST:
            raise NotYaml(f"the text expands to more than {_MOST} values")
        left.extend((item, depth + 1) for item in below)

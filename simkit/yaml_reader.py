"""Read YAML that a user wrote: return plain values, or say why the text is not valid."""

from __future__ import annotations

import math
import re
from typing import Any, Final

from simkit.errors import SimkitError

_DEEPEST: Final = 100
_MOST: Final = 1_000_000  # values; aliases that are used again and again make much out of little
_EXPONENT: Final = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)[eE][-+]?[0-9]+$")
_SEXAGESIMAL: Final = re.compile(r"[-+]?[0-9][0-9_]*(?::[0-5]?[0-9])+(?:\.[0-9_]*)?$")


class NotYaml(SimkitError):
    """A text is no YAML; the message says why.

    Attributes:
        line: of the text, counted from 1; None where that is not known.
    """

    def __init__(self, why: str, line: int | None = None) -> None:
        super().__init__(why)
        self.line = line


def read_yaml(text: str) -> Any:
    """The values that a text stands for.

    Numbers are those of YAML 1.2 and of ROS too, where YAML 1.1 has a text: `1e-3`. `12:30` is a text, not 750.

    Raises:
        NotYaml: it is none, or has a value that does not fit its tag, or holds itself.
    """
    root = compose_nodes(text)
    return None if root is None else node_value(root)


def compose_nodes(text: str) -> Any:
    """The root of the nodes of a text, which know their lines; None of an empty one.

    Raises:
        NotYaml: it is no YAML.
    """
    import yaml

    try:
        return yaml.compose(text, Loader=yaml_loader())
    except yaml.YAMLError as error:
        raise _yaml_error(error) from None
    except RecursionError:
        raise NotYaml("it is nested too deep") from None


def node_value(node: Any) -> Any:
    """Return the value of a node.

    Raises:
        NotYaml: a value does not fit its tag, holds itself, or much is made out of little.
    """
    import yaml

    try:
        found = yaml_loader()("").construct_document(node)
        _check_size(found)
    except yaml.YAMLError as error:
        raise _yaml_error(error) from None
    except RecursionError:
        raise NotYaml("it is nested too deep") from None
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError) as error:  # a tag's, of its value
        said = error.args[0] if error.args else ""
        raise NotYaml(f"a value is not what it looks like: {str(said).partition(';')[0]:.200}") from None
    return found


def finite_number(value: Any) -> float | None:
    """A value as a number; None where it is no number that is finite."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        return float(value) if math.isfinite(value) else None
    except OverflowError:  # a whole number of hundreds of digits
        return None


def yaml_loader() -> Any:
    """PyYAML's safe loader with those numbers, and an end to what merges (`<<`) make out of little."""
    import yaml

    class Reader(yaml.SafeLoader):
        """Loader of its own, so that its rules for numbers stay here."""

        _merged = 0

        def flatten_mapping(self, node: Any) -> None:
            super().flatten_mapping(node)
            self._merged += len(node.value)
            if self._merged > _MOST:
                message = f"it stands for more than {_MOST} values"
                raise yaml.constructor.ConstructorError(None, None, message, node.start_mark)

    Reader.add_implicit_resolver("tag:yaml.org,2002:float", _EXPONENT, list("-+.0123456789"))
    for sign, known in Reader.yaml_implicit_resolvers.items():
        if sign in "-+0123456789":
            known.insert(0, ("tag:yaml.org,2002:str", _SEXAGESIMAL))
    return Reader


def _yaml_error(error: Any) -> NotYaml:
    mark = getattr(error, "problem_mark", None)
    why = getattr(error, "problem", None) or str(error).splitlines()[0]
    return NotYaml(why, None if mark is None else mark.line + 1)


def _check_size(root: Any) -> None:
    """Raises where a tree is too deep, which one that holds itself is as well, or too large."""
    count, left = 0, [(root, 0)]
    while left:
        value, depth = left.pop()
        below = value.values() if isinstance(value, dict) else value if isinstance(value, (list, tuple, set)) else ()
        count += 1 + len(below)
        if depth > _DEEPEST:
            raise RecursionError
        if count > _MOST:
            raise NotYaml(f"it stands for more than {_MOST} values")
        left.extend((one, depth + 1) for one in below)

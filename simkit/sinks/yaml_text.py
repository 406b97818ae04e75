"""YAML that somebody has written: read to plain values, or told why not, whatever stands in it."""

from __future__ import annotations

import re
from typing import Any, Final

from simkit.errors import SimkitError

_DEEPEST: Final = 100
_MOST: Final = 1_000_000  # values; aliases that are used again and again make much out of little
_EXPONENT: Final = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)[eE][-+]?[0-9]+$")


class NotYaml(SimkitError):
    """A text is no YAML; the message says why."""


def read_yaml(text: str) -> Any:
    """The values that a text stands for.

    Numbers are those of YAML 1.2 and of ROS too, where YAML 1.1 has a text: `1e-3`.

    Raises:
        NotYaml: it is none, or has a value that does not fit its tag, or holds itself.
    """
    import yaml

    try:
        found = yaml.load(text, loader())
        _weigh(found)
    except yaml.YAMLError as error:
        raise NotYaml(getattr(error, "problem", None) or str(error).splitlines()[0]) from None
    except RecursionError:
        raise NotYaml("it is nested too deep") from None
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError) as error:  # a tag's, of its value
        said = error.args[0] if error.args else ""
        raise NotYaml(f"a value is not what it looks like: {str(said).partition(';')[0]:.200}") from None
    return found


def loader() -> Any:
    """PyYAML's safe loader with those numbers."""
    import yaml

    class Reader(yaml.SafeLoader):
        """Of its own, so that what it takes as a number stays here."""

    Reader.add_implicit_resolver("tag:yaml.org,2002:float", _EXPONENT, list("-+.0123456789"))
    return Reader


def _weigh(root: Any) -> None:
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

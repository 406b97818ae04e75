"""Message classes by name, for annotations and `isinstance`: `from simkit.msgs import LaserScan`.

Type checkers and editors read the fields of every class from the file `message_classes.pyi` next to this module.
`python -m simkit.msgs.message_class_stubs` generates that file.
"""

from __future__ import annotations

from simkit.msgs.message_types import class_names, message_class

__getattr__ = message_class


def __dir__() -> list[str]:
    return list(class_names())

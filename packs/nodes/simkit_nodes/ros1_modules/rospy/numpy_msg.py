"""Messages of rospy with NumPy arrays."""

from __future__ import annotations

from functools import cache
from typing import Any, Final

import numpy as np

__all__ = ["numpy_msg"]

_DTYPES: Final = {"char": "uint8", "byte": "int8", "bool": "bool"}


@cache
def numpy_msg(msg_type: type[Any]) -> type[Any]:
    """Return a class of a message whose sequences of numbers are NumPy arrays when it arrives."""
    arrays = {}
    for name, kind in zip(msg_type.__slots__, msg_type._slot_types, strict=True):
        item = kind.partition("[")[0]
        if kind.endswith("]") and (item in _DTYPES or item.startswith(("int", "uint", "float"))):
            arrays[name] = np.dtype(_DTYPES.get(item, item))

    def of_message(cls: type[Any], message: object) -> Any:
        result = cls()
        for name in msg_type.__slots__:
            value = getattr(message, name)
            if name in arrays:
                from_bytes = isinstance(value, bytes)
                value = np.frombuffer(value, arrays[name]) if from_bytes else np.array(value, arrays[name])
            setattr(result, name, value)
        return result

    name = f"Numpy_{msg_type._type.replace('/', '__')}"
    members = {"__slots__": msg_type.__slots__, "of_message": classmethod(of_message)}
    return type(name, (msg_type,), members)

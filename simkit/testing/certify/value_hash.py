"""Short hashes of whatever a plugin remembers: of values alone, never of addresses or of the order of sets."""

from __future__ import annotations

import hashlib
import math
from collections import deque
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

_MAX_DEPTH: Final = 24
_PLAIN: Final = (type(None), bool, int, str, bytes, complex)
_OWN_NAMES: Final = ("scoped", "topic", "name")


def short_hash(content: bytes) -> int:
    """A hash of 64 bits."""
    return int.from_bytes(hashlib.blake2b(content, digest_size=8).digest(), "little")


def value_hash(value: object) -> int:
    """A hash of a value and of all that is in it; equal for equal values of two processes."""
    return _update_hash(value, {}, 0)


def attribute_hashes(state: Mapping[str, object]) -> dict[str, int]:
    """The hash of each attribute."""
    return {str(name): value_hash(value) for name, value in state.items()}


def short_value_text(value: object) -> str:
    """A value as a report says it, where it is short; else empty."""
    if isinstance(value, (bool, int, float, str, np.number)):
        text = repr(value.item() if isinstance(value, np.number) else value)
        return text if len(text) <= 60 else text[:57] + "..."
    if isinstance(value, (tuple, list)) and len(value) <= 6:
        parts = [short_value_text(part) for part in value]
        return f"({', '.join(parts)})" if all(parts) else ""
    if isinstance(value, np.ndarray) and 0 < value.size <= 6:
        return short_value_text(tuple(value.ravel().tolist()))
    return ""


def _update_hash(value: Any, seen: dict[int, tuple[int, object]], depth: int) -> int:
    kind = type(value)
    if kind is float:
        return short_hash(b"f" + (b"nan" if math.isnan(value) else value.hex().encode()))
    if kind in _PLAIN:
        return short_hash(f"{kind.__name__}:{value!r}".encode("utf-8", "backslashreplace"))
    if isinstance(value, np.ndarray) and value.dtype != object:
        return short_hash(f"{value.dtype.str}{value.shape}".encode() + np.ascontiguousarray(value).tobytes())
    if isinstance(value, np.generic):
        return short_hash(value.dtype.str.encode() + value.tobytes())
    if id(value) in seen or depth > _MAX_DEPTH:
        return short_hash(f"again {seen.get(id(value), (-1,))[0]}".encode())
    seen[id(value)] = len(seen), value  # and it stays: another may not come to lie where it lay
    return _update_hash_of_items(value, seen, depth + 1)


def _update_hash_of_items(value: Any, seen: dict[int, tuple[int, object]], depth: int) -> int:
    name = type(value).__name__
    if isinstance(value, Mapping):
        pairs = sorted((_update_hash(key, {}, depth), _update_hash(item, seen, depth)) for key, item in value.items())
        return short_hash(f"{name}{pairs}".encode())
    if isinstance(value, (set, frozenset)):
        return short_hash(f"{name}{sorted(_update_hash(item, {}, depth) for item in value)}".encode())
    if isinstance(value, np.ndarray) or _is_row(value):
        return short_hash(f"{name}{[_update_hash(item, seen, depth) for item in value]}".encode())
    if isinstance(value, np.random.Generator):
        return _update_hash(value.bit_generator.state, seen, depth)
    if _is_handle(value):
        named = next((getattr(value, n) for n in _OWN_NAMES if isinstance(getattr(value, n, None), str)), "")
        return short_hash(f"{name} {named}".encode())
    own = _attributes(value)
    if own is None:
        return short_hash(f"{name} {getattr(value, '__qualname__', '')}".encode())
    parts = [(key, _update_hash(item, seen, depth)) for key, item in sorted(own.items())]
    return short_hash(f"{name}{parts}".encode())


def _is_row(value: object) -> bool:

    return isinstance(value, (list, tuple, deque))


def _is_handle(value: object) -> bool:
    """What stands for itself when a state is copied: links, publishers, plugins, the simulation."""
    copy = getattr(type(value), "__deepcopy__", None)
    return copy is not None and getattr(copy, "__module__", "").startswith("simkit.")


def _attributes(value: object) -> dict[str, object] | None:
    """What an object has; None of functions, modules, classes and what is made in C."""
    if callable(value) and hasattr(value, "__qualname__"):
        return None
    slots = [slot for cls in type(value).__mro__ for slot in _texts(vars(cls).get("__slots__", ()))]
    found = {slot: getattr(value, slot) for slot in slots if hasattr(value, slot) and slot not in ("__dict__",)}
    if hasattr(value, "__dict__") and not isinstance(value, type):
        found.update(vars(value))
    elif not slots:
        return None
    return found


def _texts(slots: Any) -> tuple[str, ...]:
    return (slots,) if isinstance(slots, str) else tuple(slots)

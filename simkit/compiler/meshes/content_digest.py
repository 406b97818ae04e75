"""Hash of the content of assets, which names equal assets equally."""

from __future__ import annotations

import hashlib
from functools import lru_cache

import numpy as np

# cached, because NumPy needs ten times as long to format a type as to hash it
_text_of_type = lru_cache(maxsize=64)(str)


def content_digest(*values: object) -> str:
    """Return a hash of arrays and other values, 20 hexadecimal digits."""
    digest = hashlib.sha1(usedforsecurity=False)
    for value in values:
        if isinstance(value, np.ndarray):
            digest.update(f"{_text_of_type(value.dtype)}{value.shape}".encode())
            digest.update(np.ascontiguousarray(value).data)
        else:
            digest.update(repr(value).encode())
        digest.update(b"|")
    return digest.hexdigest()[:20]

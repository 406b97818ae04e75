"""Reader of JSON from untrusted files, with limits on depth, number of values and digits.

A list of a million empty lists has 3 MB of text and takes 64 MB of memory, and deeply nested JSON overflows the stack
of its reader.
"""

from __future__ import annotations

import json
from typing import Any, Final

MAX_DEPTH: Final = 100
MAX_VALUES: Final = 5_000_000


def parse_json(data: bytes | str) -> Any:
    """Parse JSON.

    Raises:
        ValueError: the text is not JSON, or exceeds a limit; the message completes "it is not JSON: ...".
    """
    text = data if isinstance(data, bytes) else data.encode("utf-8", "surrogatepass")
    if text.count(b",") + text.count(b"[") + text.count(b"{") > MAX_VALUES:
        raise ValueError(f"it has more than {MAX_VALUES} values")
    try:
        document = json.loads(data)
    except RecursionError:
        raise _too_deep() from None
    except (json.JSONDecodeError, UnicodeDecodeError):
        raise
    except ValueError:  # Python refuses to convert so many digits, in a text that names its own functions
        raise ValueError("it has an integer of more than 4300 digits") from None
    level = [document]
    for _ in range(MAX_DEPTH):
        level = [
            value
            for container in level
            if isinstance(container, (dict, list))
            for value in (container.values() if isinstance(container, dict) else container)
            if isinstance(value, (dict, list))
        ]
        if not level:
            return document
    raise _too_deep()


def _too_deep() -> ValueError:
    return ValueError(f"it is nested deeper than {MAX_DEPTH}")

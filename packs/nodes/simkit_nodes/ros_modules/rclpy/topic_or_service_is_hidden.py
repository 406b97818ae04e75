"""Check for hidden names."""

from __future__ import annotations

__all__ = ["HIDDEN_TOPIC_PREFIX", "TOPIC_SEPARATOR_STRING", "topic_or_service_is_hidden"]

HIDDEN_TOPIC_PREFIX = "_"
TOPIC_SEPARATOR_STRING = "/"


def topic_or_service_is_hidden(name: str) -> bool:
    """Check whether a part of the name of a topic or service begins with an underscore."""
    return any(part.startswith(HIDDEN_TOPIC_PREFIX) for part in name.split(TOPIC_SEPARATOR_STRING) if part)

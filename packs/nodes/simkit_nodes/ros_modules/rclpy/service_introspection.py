"""State of the introspection of a service."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["ServiceIntrospectionState"]


class ServiceIntrospectionState(IntEnum):
    """Part of the requests and responses that introspection publishes; simkit publishes nothing."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2

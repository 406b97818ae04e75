"""Quality-of-service profiles as rosbag2 writes them."""

from __future__ import annotations

from typing import Any

_FOREVER = {"sec": 9223372036, "nsec": 854775807}


def profile(latched: bool) -> dict[str, Any]:
    """What a publisher offers: reliable, and transient local where the last message is kept (`/tf_static`)."""
    return {
        "history": "keep_last",
        "depth": 1 if latched else 10,
        "reliability": "reliable",
        "durability": "transient_local" if latched else "volatile",
        "deadline": dict(_FOREVER),
        "lifespan": dict(_FOREVER),
        "liveliness": "automatic",
        "liveliness_lease_duration": dict(_FOREVER),
        "avoid_ros_namespace_conventions": False,
    }


def as_yaml(profiles: list[dict[str, Any]]) -> str:
    """The text that belongs into a channel's metadata."""
    import yaml

    # Anchors would be valid YAML, but some readers of bags do not know them.
    plain = [{k: dict(v) if isinstance(v, dict) else v for k, v in p.items()} for p in profiles]
    return str(yaml.safe_dump(plain, sort_keys=False)).strip()

"""Whose a leaf is: `models[robot].links[wheel].collisions[tyre].geometry.radius` is the `geometry.radius` of a part."""

from __future__ import annotations

from functools import lru_cache

from simkit.golden.leaves import split_path

_PARTS = frozenset(
    ("models", "links", "joints", "collisions", "visuals", "sensors", "lights", "frames", "plugins", "actors", "files")
)


@lru_cache(maxsize=65536)
def parted(path: str) -> tuple[str, str]:
    """A path's beginning that names a part of the world, and the rest of it: what of the part."""
    at = 0
    while True:
        end = _part_end(path, at)
        if end == at:
            break
        at = end
    return path[:at].rstrip("."), path[at:]


def _part_end(path: str, at: int) -> int:
    """Where a step that names a part ends; `at` where there is none."""
    opened = path.find("[", at)
    if opened < 0 or path[at:opened] not in _PARTS:
        return at
    closed = path.find("]", opened)
    if closed < 0:
        return at
    return closed + 2 if path[closed + 1 : closed + 2] == "." else closed + 1


@lru_cache(maxsize=65536)
def scoped(owner: str) -> str:
    """The scoped name of a part that a path names; empty for the world."""
    return "::".join(key for _, key in split_path(owner))


def kind_of(owner: str) -> str:
    """What a part is: model, link, …; "world" for the world."""
    found = split_path(owner)
    return found[-1][0].removesuffix("s") if found else "world"


def above(owner: str) -> str:
    """The path of the part that a part belongs to; empty for the world."""
    closed = owner.rfind("].")
    return owner[: closed + 1] if closed >= 0 else ""


def is_within(owner: str, outer: str) -> bool:
    """Whether a part is another one, or belongs to it."""
    return not outer or owner == outer or owner.startswith(outer + ".")

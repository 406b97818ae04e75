"""Visibility of visuals to a sensor: its `<visibility_mask>` against the `<visibility_flags>` of the visuals."""

from __future__ import annotations

from typing import Final

from simkit.compiler.name_map import NameMap
from simkit.params import Params

ALL_VISIBLE: Final = 0xFFFFFFFF
"""Mask that hides nothing."""


def read_visibility_mask(block: Params) -> int:
    """Read `<visibility_mask>`: decimal or hexadecimal, from -1 to 4294967295."""
    text = block.text("visibility_mask", str(ALL_VISIBLE))
    try:
        mask = int(text, 0) if text.isascii() and "_" not in text else -2
    except ValueError:
        mask = -2
    if not -1 <= mask <= ALL_VISIBLE:
        allowed = f"expected a whole number from -1 (all) to {ALL_VISIBLE}"
        message = f"found <visibility_mask>{text}</visibility_mask>, {allowed}"
        block.block("visibility_mask").error("SK-PARAM-002", message)
        return ALL_VISIBLE
    return mask & ALL_VISIBLE


def hidden_geoms(mask: int, names: NameMap) -> list[int]:
    """Return the ids of the geoms of visuals that have no bit in common with a mask.

    Args:
        mask: visibility mask of a sensor.
        names: name map of a compiled model.
    """
    geoms: list[int] = []
    for link in names.links.values():
        hidden = {visual.scoped for visual in link.scene.visuals if not visual.visibility_flags & mask}
        if hidden:
            geoms += [geom for geom in link.visuals if names.geom_owner(geom)[1] in hidden]
    return geoms

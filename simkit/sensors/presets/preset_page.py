"""Text of presets: the page of all presets, and the description of one."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path

from simkit.sensors.presets import presets
from simkit.sensors.presets.preset import Preset, outline

_TEXTS = Path(__file__).with_name("preset_page.toml")
"""Introduction of the page, and the titles of its sections in order."""


def presets_page() -> str:
    """Return the text of `docs/sensors/presets.md`."""
    texts = tomllib.loads(_TEXTS.read_text(encoding="utf-8"))
    titles = texts["titles"]
    kinds = {preset.kind for preset in presets()}
    order = [kind for kind in titles if kind in kinds] + sorted(kinds - set(titles))
    sections = ("\n" + "\n".join(_section(kind, titles.get(kind, kind))) + "\n" for kind in order)
    return "".join((texts["introduction"], *sections))


def _section(kind: str, title: str) -> Iterator[str]:
    yield f"## {title}\n"
    yield "| preset | Hz | gives | losses, sweep, timing | source, remarks |"
    yield "|---|---|---|---|---|"
    first_with: dict[str, str] = {}
    for preset in presets():
        if preset.kind == kind:
            rate = f"{preset.rate:g}" if preset.rate else ""
            beside = f"`{outline(preset.beside)}`" if preset.beside else ""
            block = f"`{outline(preset.settings[preset.block])}`"
            first = first_with.setdefault(_source(preset), preset.name)
            source = _source(preset) if first == preset.name else f"as {first}"
            yield f"| {_names(preset)} | {rate} | {block} | {beside} | {source} |"


def _names(preset: Preset) -> str:
    also = f" ({', '.join(preset.aliases)})" if preset.aliases else ""
    maker = "" if preset.name.startswith(preset.maker) else f"{preset.maker} "
    return f"{maker}**{preset.name}**{also}"


def _source(preset: Preset) -> str:
    remark = f"; {preset.remark}" if preset.remark else ""
    doubt = f"; *unconfirmed*: {', '.join(preset.unconfirmed)}" if preset.unconfirmed else ""
    return preset.source + remark + doubt


def describe_preset(preset: Preset) -> str:
    """Return the description of one preset, line by line."""
    lines = [f"{preset.name} ({preset.maker}), {' / '.join(preset.sensor_kinds)}"]
    if preset.aliases:
        lines.append(f"also:   {', '.join(preset.aliases)}")
    lines += [f"gives:  {outline(preset.elements)}", f"source: {preset.source}"]
    if preset.remark:
        lines.append(f"note:   {preset.remark}")
    if preset.unconfirmed:
        lines.append(f"unconfirmed: {', '.join(preset.unconfirmed)}")
    return "\n".join(lines)

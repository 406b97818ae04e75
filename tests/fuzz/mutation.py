"""Real files with a few things wrong: bytes, numbers, names, whole elements, and pieces of other files."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence

ODD_NUMBERS = (
    "0", "-0", "-1", "1", "nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "1e400", "0x10", "1,5", "1e", "", " ",
    "true", "one", "999999999999", "-2147483649", "1 2", "1 2 3 4 5 6 7", "0 0 0", "\u0661", "1e9", "1e-9",
    "4294967296",
)  # fmt: skip
ODD_NAMES = (
    "", " ", "world", "__model__", "__root__", "a::b", "::", "a/b", "../x", "\u00fc\U0001f916", "x" * 5000, "base_link",
    "link", "%s", "{}", "${x}", "$(find x)", "model://", "package://", "file:///etc/passwd", "http://a/b", "a\tb",
    "/dev/zero", ".", "..", "/", "&#10;", "&#27;[2J", "&#0;", "&lt;", "~", "*", "\u202e",
)  # fmt: skip
NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?(?![\w.])")
QUOTED = re.compile(rb"\"[^\"<>]*\"|'[^'<>]*'")
ELEMENT = re.compile(rb"<(\w+)(?:\s[^<>]*)?>[^<>]*</\1>|<\w+(?:\s[^<>]*)?/>")
BLOCK = re.compile(
    rb"<(plugin|sensor|joint|light|collision|visual|surface|axis|limit|dynamics|mimic|inertial|geometry|frame|gazebo|"
    rb"transmission|population|include|model|link|noise|material)\b(?:[^<>]*[^/<>])?>.*?</\1>",
    re.DOTALL,
)
TAG = re.compile(rb"</?\w[^<>]*>")
WORD = re.compile(rb">([a-z_A-Z]\w*(?:::\w+)*)<|\"([a-z_A-Z][\w:]*)\"")
HOLDERS = re.compile(rb"<(?:world|model|link|robot|joint|sensor|gazebo|worldbody|body|collision|visual)\b[^<>]*[^/<>]>")


class Mutator:
    """Changes XML texts.

    Args:
        library: texts whose blocks (a sensor, a joint, a plugin) are put into others.
    """

    def __init__(self, library: Sequence[bytes] = ()) -> None:
        self._blocks = sorted({m.group() for text in library for m in BLOCK.finditer(text) if len(m.group()) < 4000})
        self._words = sorted({w for text in library for pair in WORD.findall(text) for w in pair if w and len(w) < 60})

    def mutated(self, content: bytes, chance: random.Random) -> bytes:
        """The content with mostly one mutation, sometimes up to five."""
        for _ in range(chance.choice((1, 1, 1, 1, 2, 2, 3, 5))):
            content = chance.choice(self._kinds())(content, chance)
        return content

    def _kinds(self) -> tuple[Callable[[bytes, random.Random], bytes], ...]:
        gentle = (_scaled, _scaled, _scaled, _scaled, _swap, _swap, _element, _element, _block, _block)
        rough = (_bytes, _cut, _repeat, replaced_number, replaced_number, replaced_number, _name, _name, _tag)
        ours = (self._splice, self._splice, self._splice, self._word, self._word) if self._blocks else ()
        return (*gentle, *rough, *ours)

    def _splice(self, content: bytes, chance: random.Random) -> bytes:
        """A block of another file stands inside an element that might hold one."""
        places = [m.end() for m in HOLDERS.finditer(content)]
        if not places:
            return content
        place = chance.choice(places)
        return content[:place] + chance.choice(self._blocks) + content[place:]

    def _word(self, content: bytes, chance: random.Random) -> bytes:
        """One word of the formats stands where another stood: a joint's type, a kind of sensor, a link's name."""
        found = list(WORD.finditer(content))
        if not found:
            return content
        one = chance.choice(found)
        start, end = one.span(1) if one.group(1) else one.span(2)
        return content[:start] + chance.choice(self._words) + content[end:]


def shuffled_bytes(content: bytes, chance: random.Random) -> bytes:
    """One to four mutations that know nothing of the format, for meshes and pictures; headers are hit more often."""
    for _ in range(chance.randint(1, 4)):
        kind = chance.randrange(6)
        if kind <= 1:
            content = _bytes(content, chance)
        elif kind == 2:
            content = _cut(content, chance)
        elif kind == 3:
            content = _repeat(content, chance)
        elif kind == 4 and content:
            at = chance.randrange(min(len(content), 200))
            content = (
                content[:at] + chance.choice((b"\xff" * 4, b"\0" * 4, b"\x7f" * 4, b"\0\0\xc0\x7f")) + content[at + 4 :]
            )
        else:
            content = replaced_number(content, chance)
    return content


def _bytes(content: bytes, chance: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(chance.randint(1, 8)):
        if changed:
            changed[chance.randrange(len(changed))] = chance.randrange(256)
    return bytes(changed)


def _cut(content: bytes, chance: random.Random) -> bytes:
    start = chance.randrange(len(content) + 1)
    return content[:start] + content[start + chance.randint(1, max(1, len(content) // 4)) :]


def _repeat(content: bytes, chance: random.Random) -> bytes:
    start = chance.randrange(len(content) + 1)
    piece = content[start : start + chance.randint(1, 200)]
    return content[:start] + piece * chance.randint(2, 20) + content[start:]


def replaced_number(content: bytes, chance: random.Random) -> bytes:
    """Return the content with one number replaced by an odd one."""
    return _replaced(content, NUMBER, lambda _: chance.choice(ODD_NUMBERS).encode(), chance)


def _scaled(content: bytes, chance: random.Random) -> bytes:
    """A number becomes another that might stand there."""
    factor = chance.choice((-1.0, 0.0, 1e-9, 1e-3, 0.1, 0.5, 2.0, 3.0, 10.0, 1e3, 1e6, 1e9))
    return _replaced(content, NUMBER, lambda old: f"{float(old) * factor:.9g}".encode(), chance)


def _name(content: bytes, chance: random.Random) -> bytes:
    return _replaced(content, QUOTED, lambda _: b'"' + chance.choice(ODD_NAMES).encode() + b'"', chance)


def _swap(content: bytes, chance: random.Random) -> bytes:
    """One quoted text stands where another stood: names of the wrong kind, duplicates, circles."""
    others = QUOTED.findall(content)
    return _replaced(content, QUOTED, lambda _: chance.choice(others), chance) if others else content


def _element(content: bytes, chance: random.Random) -> bytes:
    """A small element goes, comes twice, or stands somewhere else."""
    return _moved(content, list(ELEMENT.finditer(content)), chance)


def _block(content: bytes, chance: random.Random) -> bytes:
    """The same with a whole block: a link, a joint, a sensor."""
    return _moved(content, list(BLOCK.finditer(content)), chance)


def _moved(content: bytes, found: list[re.Match[bytes]], chance: random.Random) -> bytes:
    if not found:
        return content
    one = chance.choice(found)
    kind = chance.randrange(3)
    if kind == 0:
        return content[: one.start()] + content[one.end() :]
    if kind == 1:
        return content[: one.end()] + one.group() * chance.randint(1, 5) + content[one.end() :]
    place = chance.choice(found).start()
    return content[:place] + one.group() + content[place:]


def _tag(content: bytes, chance: random.Random) -> bytes:
    others = TAG.findall(content)
    return _replaced(content, TAG, lambda _: chance.choice(others), chance) if others else content


def _replaced(content: bytes, what: re.Pattern[bytes], by: Callable[[bytes], bytes], chance: random.Random) -> bytes:
    found = list(what.finditer(content))
    if not found:
        return content
    one = chance.choice(found)
    return content[: one.start()] + by(one.group()) + content[one.end() :]

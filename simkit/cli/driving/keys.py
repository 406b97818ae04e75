"""What a terminal sends, as keys: characters by themselves, arrows and the like by name."""

from __future__ import annotations

from typing import Final

UP, DOWN, LEFT, RIGHT = "up", "down", "left", "right"
_LONGEST: Final = 32  # [bytes] of a sequence: what is longer is none
_ESCAPE: Final = 0x1B
_ARROWS: Final = {"A": UP, "B": DOWN, "C": RIGHT, "D": LEFT}
_OF_WINDOWS: Final = {"H": UP, "P": DOWN, "M": RIGHT, "K": LEFT}


class KeyDecoder:
    """Splits what comes from a terminal into keys; a sequence may come in pieces.

    Arrows with a modifier count as arrows; other keys that are sequences (Home, F5, the mouse, the marks around what is
    pasted) are none.
    """

    def __init__(self) -> None:
        self._rest = b""

    def decode(self, data: bytes) -> list[str]:
        """The keys in `data`, after what was left of the data before."""
        data, self._rest = self._rest + data, b""
        keys: list[str] = []
        at = 0
        while at < len(data):
            if data[at] != _ESCAPE:
                if data[at] < 0x80:  # the rest of Unicode is no command
                    keys.append(chr(data[at]))
                at += 1
                continue
            end = _end_of_sequence(data, at)
            if end is None:
                if len(data) - at < _LONGEST:
                    self._rest = data[at:]
                    break
                end = at + 1
            elif chr(data[end - 1]) in _ARROWS and end - at > 2:
                keys.append(_ARROWS[chr(data[end - 1])])
            at = end
        return keys


def _end_of_sequence(data: bytes, at: int) -> int | None:
    """Where the sequence that begins at `at` ends; None where more is to come (ECMA-48: CSI, SS3)."""
    if at + 1 >= len(data):
        return None
    kind = data[at + 1]
    if kind == ord("O"):
        return at + 3 if at + 2 < len(data) else None
    if kind != ord("["):
        return at + 1  # the key Esc, and then another
    for end in range(at + 2, min(len(data), at + _LONGEST)):
        if 0x40 <= data[end] <= 0x7E:
            return end + 1
        if not 0x20 <= data[end] <= 0x3F:
            return end  # broken off
    return None


def windows_keys(characters: str) -> list[str]:
    """The keys of what `msvcrt.getwch` gave: an arrow is two characters, the first of them "\\x00" or "\\xe0"."""
    keys: list[str] = []
    found = iter(characters)
    for character in found:
        if character not in "\x00\xe0":
            keys.append(character)
        elif (name := _OF_WINDOWS.get(next(found, ""))) is not None:
            keys.append(name)
    return keys

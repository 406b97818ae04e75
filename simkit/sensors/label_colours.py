"""The colours of coloured label maps: those of Gazebo, which draws them from a generator seeded with the number."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Final

Colour = tuple[int, int, int]

BACKGROUND: Final[Colour] = (0, 0, 0)
_FACTOR, _MODULUS = 16807, 2147483647
_BUCKET: Final = (_MODULUS - 2) // 256


def colours_of(numbers: Iterable[int]) -> dict[int, Colour]:
    """A colour for each number, no two the same and none black.

    Gazebo draws a number's red, green and blue one after the other from C++'s `default_random_engine`, seeded with
    that number, through `uniform_int_distribution` from 0 to 255 (gz-rendering, Ogre2SegmentationMaterialSwitcher.cc):
    with GNU's library Lehmer's generator with the factor 16807, in 256 equal parts. Where two numbers give one colour,
    the later goes on drawing.
    """
    taken = {BACKGROUND}
    found: dict[int, Colour] = {}
    for number in numbers:
        if number in found:
            continue
        draws = _draws(number)
        colour = BACKGROUND
        while colour in taken:
            red, green, blue = islice(draws, 3)
            colour = red, green, blue
        taken.add(colour)
        found[number] = colour
    return found


def _draws(seed: int) -> Iterator[int]:
    """Numbers from 0 to 255."""
    state = seed % _MODULUS or 1
    while True:
        state = state * _FACTOR % _MODULUS
        part = (state - 1) // _BUCKET
        if part < 256:
            yield part

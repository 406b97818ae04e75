"""Keys from a terminal: what its bytes mean, and how the terminal is left."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import suppress

import pytest

from simkit.cli.terminal.keyboard import KeyDecoder, windows_keys
from tests.cli.terminals import open_terminal


def keys(*pieces: bytes) -> list[str]:
    decoder = KeyDecoder()
    return [key for piece in pieces for key in decoder.decode(piece)]


@pytest.mark.parametrize("data", [b"w\x1b[A\x1bOB\x1b[C\x1b[Dx", b"w\x1b[1;5A\x1b[B\x1bOC\x1b[1;2Dx"])
def test_arrows_have_names_in_both_modes_of_a_terminal_and_with_a_modifier(data: bytes) -> None:
    assert keys(data) == ["w", "up", "down", "right", "left", "x"]


def test_a_sequence_may_come_in_pieces() -> None:
    assert keys(b"a\x1b", b"[", b"A", b"b") == ["a", "up", "b"]
    assert keys(*(bytes([one]) for one in b"\x1b[1;5D")) == ["left"]


@pytest.mark.parametrize(
    "data",
    [b"\x1b[3~", b"\x1bOP", b"\x1b[15~", b"\x1b[<0;12;7M", b"\x1b[H", "äé".encode(), b"\xff\xfe", b"\x1b[200~"],
    ids=["delete", "F1", "F5", "mouse", "home", "letters beyond ASCII", "no text", "paste"],
)
def test_other_escape_sequences_are_ignored(data: bytes) -> None:
    assert keys(data + b"w") == ["w"]


def test_a_sequence_without_an_end_is_given_up() -> None:
    assert keys(b"\x1b[" + b"1" * 100, b"w")[-1] == "w"
    decoder = KeyDecoder()
    for _ in range(100):
        decoder.decode(b"\x1b[1;")
        assert len(decoder._rest) < 32


def test_every_key_of_a_flood_counts() -> None:
    assert keys(b"w" * 5000 + b"\x1b[A") == ["w"] * 5000 + ["up"]


def test_arrows_of_windows_are_two_characters() -> None:
    assert windows_keys("w\xe0H\x00K\xe0Sx\xe0") == ["w", "up", "left", "x"]


# ---------------------------------------------------------------------- a terminal

needs_terminals = pytest.mark.skipif(sys.platform == "win32", reason="its terminals are others")


@pytest.fixture
def terminal() -> Iterator[tuple[int, int]]:
    """The far and the near end of one."""
    far, near = open_terminal()
    yield far, near
    for end in (far, near):
        with suppress(OSError):
            os.close(end)


@needs_terminals
def test_keys_come_one_by_one_unseen_and_the_terminal_is_left_as_it_was(terminal: tuple[int, int]) -> None:
    import termios

    from simkit.cli.terminal.keyboard import Keyboard

    far, near = terminal
    before = termios.tcgetattr(near)
    with Keyboard(near) as keyboard:
        assert keyboard.read() == []
        os.write(far, b"w\x1b[A")
        assert keyboard.read() == ["w", "up"]
        modes = termios.tcgetattr(near)[3]
        assert not modes & (termios.ICANON | termios.ECHO)
        assert modes & termios.ISIG  # Ctrl-C and Ctrl-Z mean what they do
        os.write(far, b"ls\n")  # pressed after the end of a run, as it were
    assert termios.tcgetattr(near) == before
    os.set_blocking(near, False)
    with pytest.raises(BlockingIOError):
        os.read(near, 100)


@needs_terminals
def test_an_exception_restores_the_terminal(terminal: tuple[int, int]) -> None:
    import termios

    from simkit.cli.terminal.keyboard import Keyboard

    before = termios.tcgetattr(terminal[1])
    with pytest.raises(ValueError, match="wheel"), Keyboard(terminal[1]):
        raise ValueError("the wheel fell off")
    assert termios.tcgetattr(terminal[1]) == before


@needs_terminals
def test_a_terminal_that_goes_away_is_lost_and_no_fault(terminal: tuple[int, int]) -> None:
    from simkit.cli.terminal.keyboard import Keyboard

    with Keyboard(terminal[1]) as keyboard:
        assert not keyboard.is_lost
        os.close(terminal[0])
        assert keyboard.read() == []
        assert keyboard.is_lost
        assert keyboard.read() == []


def test_a_stream_without_a_terminal_has_no_keyboard() -> None:
    from simkit.cli.terminal.keyboard import open_keyboard

    reading, writing = os.pipe()
    with os.fdopen(reading) as stream:
        assert open_keyboard(stream) is None
    os.close(writing)
    assert open_keyboard(stream) is None  # closed
    assert open_keyboard(None) is None

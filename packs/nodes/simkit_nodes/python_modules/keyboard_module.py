"""Module `keyboard` of a program: it gets the keys of the program's input."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from simkit_nodes.host import current_program
from simkit_nodes.python_modules.pynput_module import KeyCode, key_of
from simkit_nodes.tasks import Task

__all__ = [
    "KEY_DOWN",
    "KEY_UP",
    "KeyboardEvent",
    "add_hotkey",
    "is_pressed",
    "on_press",
    "read_event",
    "read_key",
    "wait",
]

KEY_DOWN, KEY_UP = "down", "up"


class KeyboardEvent:
    """Key that was pressed."""

    event_type = KEY_DOWN

    def __init__(self, name: str) -> None:
        self.name = name


def _name(text: str) -> str:
    key = key_of(text)
    return str(key.char) if isinstance(key, KeyCode) else str(key.name)


def read_key(suppress: bool = False) -> str:
    """Wait for a key and return its name."""
    return _name(current_program().stdin.read_key())


def read_event(suppress: bool = False) -> KeyboardEvent:
    """Wait for a key and return its event."""
    return KeyboardEvent(read_key())


def wait(hotkey: str | None = None, suppress: bool = False, trigger_on_release: bool = False) -> None:
    """Wait for a key of a name."""
    while read_key() != hotkey:
        pass


def is_pressed(hotkey: str) -> bool:
    """Return whether the next key of the input has this name; the key is then taken from the input."""
    program = current_program()
    program.host.poll()
    text = program.stdin.next_key
    if not text or _name(text) != hotkey:
        return False
    program.stdin.read_key()
    return True


def on_press(callback: Callable[[KeyboardEvent], object], suppress: bool = False) -> Task:
    """Call a function for each key."""

    def run() -> None:
        while True:
            callback(read_event())

    task: Task = current_program().host.start_thread(run, "keyboard")
    return task


def add_hotkey(hotkey: str, callback: Callable[..., object], args: tuple[Any, ...] = (), **options: object) -> Task:
    """Call a function for a key of a name."""
    return on_press(lambda event: callback(*args) if event.name == hotkey else None)

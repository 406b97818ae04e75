"""Modules `pynput` and `pynput.keyboard` of a program: listeners get the keys of the program's input."""

from __future__ import annotations

import enum
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

from simkit_nodes.python_modules import program_module

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram


class KeyCode:
    """Key with a character."""

    def __init__(self, vk: int | None = None, char: str | None = None) -> None:
        self.vk, self.char, self.is_dead = vk, char, False

    @classmethod
    def from_char(cls, char: str) -> KeyCode:
        """Return the key of a character."""
        return cls(char=char)

    @classmethod
    def from_vk(cls, vk: int) -> KeyCode:
        """Return the key of a number."""
        return cls(vk=vk)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, KeyCode) and (self.vk, self.char) == (other.vk, other.char)

    def __hash__(self) -> int:
        return hash((self.vk, self.char))

    def __repr__(self) -> str:
        return f"{self.char!r}" if self.char else f"<{self.vk}>"


_KEYS: Final = """
alt alt_l alt_r alt_gr backspace caps_lock cmd cmd_l cmd_r ctrl ctrl_l ctrl_r delete down end enter esc home insert left
f1 f2 f3 f4 f5 f6 f7 f8 f9 f10 f11 f12 menu num_lock page_down page_up pause print_screen right scroll_lock shift
shift_l shift_r space tab up
"""

Key = enum.Enum("Key", _KEYS.split())  # type: ignore[misc]

_BY_TEXT: Final = {
    "\x1b[A": "up",
    "\x1b[B": "down",
    "\x1b[C": "right",
    "\x1b[D": "left",
    "\x1b": "esc",
    "\n": "enter",
    "\r": "enter",
    " ": "space",
    "\t": "tab",
    "\x7f": "backspace",
}


def key_of(text: str) -> Any:
    """Return the key of a character, or of the characters that a terminal sends for a key."""
    name = _BY_TEXT.get(text)
    return KeyCode.from_char(text) if name is None else Key[name]


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Provide listeners for the keyboard, as threads of the program."""
    if module.__name__ == "pynput":
        module.keyboard = program_module(program, "pynput.keyboard")  # type: ignore[attr-defined]
        return
    threading = program_module(program, "threading")

    class Listener(threading.Thread):  # type: ignore[misc, name-defined]
        """Thread that calls functions for each key."""

        def __init__(
            self,
            on_press: Callable[[Any], object] | None = None,
            on_release: Callable[[Any], object] | None = None,
            suppress: bool = False,
            **options: object,
        ) -> None:
            super().__init__(daemon=True)
            self._functions = on_press, on_release
            self.running = False

        def run(self) -> None:
            """Call the functions for each key, until one returns False."""
            self.running = True
            while self.running:
                text = program.stdin.read_key()
                if not text:
                    break
                results = [function(key_of(text)) for function in self._functions if function is not None]
                if False in results:
                    break
            self.running = False

        def stop(self) -> None:
            """End the thread after the present key."""
            self.running = False

        def wait(self) -> None:
            """Do nothing: the thread is ready as soon as it has started."""

        def __enter__(self) -> Any:
            self.start()
            return self

        def __exit__(self, *_: object) -> None:
            self.stop()

    vars(module).update(Key=Key, KeyCode=KeyCode, Listener=Listener)

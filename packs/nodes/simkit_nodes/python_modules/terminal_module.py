"""Modules `termios`, `fcntl`, `getpass` and `msvcrt` of a program: they leave the real terminal and its keys alone."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Replace the functions that change the terminal or read the keyboard."""
    stdin = program.stdin

    def is_standard_input(file: object) -> bool:
        return file == 0 or file is stdin

    def except_for_input(name: str, result: object) -> Callable[..., object]:
        function = getattr(module, name)

        def call(file: object, *args: object) -> Any:
            return result if is_standard_input(file) else function(file, *args)

        return call

    names: dict[str, Any] = {}
    if module.__name__ == "getpass":
        names = {"getpass": lambda prompt="Password: ", stream=None: program.read_input(prompt)}
    elif module.__name__ == "termios":
        names = {name: except_for_input(name, None) for name in ("tcdrain", "tcflow", "tcflush", "tcsendbreak")}
        names["tcsetattr"] = except_for_input("tcsetattr", None)
        tcgetattr = module.tcgetattr

        def attributes(file: object) -> list[Any]:
            if not is_standard_input(file):
                return list(tcgetattr(file))
            return [0, 0, 0, 0, 0, 0, [b"\x00"] * 32]

        names["tcgetattr"] = attributes
    elif module.__name__ == "fcntl":
        names = {name: except_for_input(name, 0) for name in ("fcntl", "flock", "ioctl", "lockf")}
    else:
        names = {
            "kbhit": lambda: stdin.has_input,
            "getch": lambda: stdin.read(1).encode(),
            "getche": lambda: stdin.read(1).encode(),
            "getwch": lambda: stdin.read(1),
            "getwche": lambda: stdin.read(1),
        }
    vars(module).update(names)

"""Commands that install simkit or one of its extras, for messages."""

from __future__ import annotations

from typing import Final

REPOSITORY: Final = "https://github.com/simkit-robotics/simkit"


def install_command(extra: str = "", option: str = "") -> str:
    """Return the command that installs simkit from its repository; no package index has the distribution yet.

    Args:
        extra: name of the extra to install with it; empty for none.
        option: option of `pip install`; empty for none.
    """
    extras = f"[{extra}]" if extra else ""
    # double quotes are quotes in every shell, also on Windows
    return f'pip install {option + " " if option else ""}"simkit-robotics{extras} @ git+{REPOSITORY}"'

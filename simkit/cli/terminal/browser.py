"""Opening of a page in the user's browser."""

from __future__ import annotations

import atexit
import html
import tempfile
import threading
import webbrowser
from contextlib import suppress
from pathlib import Path
from typing import Final

_REDIRECT_LIFE: Final = 60.0  # [s] for which the file that leads a browser to the page exists


def open_browser(address: str) -> None:
    """Open a page in a browser, by a file that only this user can read and that is removed soon.

    Every user of the machine can read the arguments of a program, so the address with its token must not be one.
    """
    text = f'<!doctype html><meta http-equiv="refresh" content="0; url={html.escape(address)}"><title>simkit</title>'
    with tempfile.NamedTemporaryFile("w", prefix="simkit-", suffix=".html", delete=False) as file:  # its mode is 0600
        file.write(text)
    path = Path(file.name)

    def remove() -> None:
        with suppress(OSError):
            path.unlink()

    atexit.register(remove)
    timer = threading.Timer(_REDIRECT_LIFE, remove)
    timer.daemon = True
    timer.start()
    with suppress(webbrowser.Error):
        webbrowser.open(path.as_uri())

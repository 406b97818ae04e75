"""Module `cv2` of a program: nothing is shown in windows, and a wait for a key is a wait for simulated time."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

import cv2 as _python

from simkit_nodes.host import current_program
from simkit_nodes.python_modules import program_module

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram

__all__ = [
    "VideoCapture",
    "createButton",
    "createTrackbar",
    "destroyAllWindows",
    "destroyWindow",
    "displayOverlay",
    "displayStatusBar",
    "getTrackbarPos",
    "getWindowImageRect",
    "getWindowProperty",
    "imshow",
    "moveWindow",
    "namedWindow",
    "pollKey",
    "resizeWindow",
    "selectROI",
    "setMouseCallback",
    "setTrackbarMax",
    "setTrackbarMin",
    "setTrackbarPos",
    "setWindowProperty",
    "setWindowTitle",
    "startWindowThread",
    "waitKey",
    "waitKeyEx",
]

_CONTRIBUTED: Final = ("CascadeClassifier", "HOGDescriptor", "ximgproc", "xfeatures2d")
_CONTRIBUTED_HINT: Final = (
    "OpenCV 5 has it only with its contributed modules: "
    "pip uninstall opencv-python-headless && pip install opencv-contrib-python-headless"
)
_FRAME: Final = 1.0 / 30.0  # [s] after which a wait without a time limit goes on; nobody sees the picture


def waitKey(delay: int = 0) -> int:
    """Wait for a key at most for a duration [ms] of simulated time; return its code, or -1 without a key."""
    current_program().stdin.wait_for_key(delay * 1e-3 if delay > 0 else _FRAME)
    return pollKey()


def pollKey() -> int:
    """Return the code of a key of the program's input; -1 without a key."""
    stdin = current_program().stdin
    return ord(stdin.read(1)) if stdin.has_key else -1


waitKeyEx = waitKey


def imshow(window: str, image: object) -> None:
    """Show nothing.

    Raises:
        cv2.error: there is no picture.
    """
    if image is None or getattr(image, "size", 1) == 0:
        raise _python.error(f"the picture for the window {window!r} is empty")


def _do_nothing(*args: object, **options: object) -> None:
    """Do nothing: there is no window."""


namedWindow = destroyWindow = moveWindow = resizeWindow = setWindowProperty = setWindowTitle = _do_nothing
setMouseCallback = setTrackbarMax = setTrackbarMin = displayOverlay = displayStatusBar = createButton = _do_nothing
destroyAllWindows = _do_nothing


def VideoCapture(source: Any = None, *args: Any, **options: Any) -> _python.VideoCapture:
    """Return the film of a file. A camera of this machine stays closed: what it sees is no part of the run.

    This is a function because an object of a class derived from one of OpenCV damages the memory at its end.
    """
    return (
        _python.VideoCapture()
        if source is None or _is_camera(source)
        else _python.VideoCapture(source, *args, **options)
    )


def _is_camera(source: object) -> bool:
    return isinstance(source, int) or (isinstance(source, str) and source.startswith("/dev/"))


def startWindowThread() -> int:
    """Start no thread."""
    return 0


def _trackbars() -> dict[tuple[str, str], int]:
    bars: dict[tuple[str, str], int] = current_program().data.setdefault(__name__, {})
    return bars


def createTrackbar(name: str, window: str, value: int | None = 0, count: int = 0, on_change: object = None) -> None:
    """Store the value of a slider that nobody moves."""
    _trackbars()[name, window] = value or 0


def setTrackbarPos(name: str, window: str, position: int) -> None:
    """Store the value of a slider."""
    _trackbars()[name, window] = position


def getTrackbarPos(name: str, window: str) -> int:
    """Return the value of a slider; -1 if there is none."""
    return _trackbars().get((name, window), -1)


def getWindowProperty(window: str, prop: int) -> float:
    """Return 1, as for a window that is open."""
    return 1.0


def getWindowImageRect(window: str) -> tuple[int, int, int, int]:
    """Return the place of a window, which has no size."""
    return 0, 0, 0, 0


def selectROI(*args: object, **options: object) -> tuple[int, int, int, int]:
    """Return an empty rectangle: nobody selects one."""
    return 0, 0, 0, 0


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Give the program its own `cv2.aruco`, which an OpenCV that a user has built may lack, and hints."""
    vars(module)["hints"] = dict.fromkeys(_CONTRIBUTED, _CONTRIBUTED_HINT)
    if hasattr(module, "aruco"):
        program_module(program, "cv2.aruco")

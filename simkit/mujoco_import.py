"""First import of MuJoCo: independent of a renderer and of the working directory, with a check for damage."""

from __future__ import annotations

import errno
import os
import re
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from importlib.abc import Loader
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Final, cast

from simkit.errors import InstallationError
from simkit.memory_error import check_memory_limit, find_memory_error

if TYPE_CHECKING:
    import mujoco as mujoco

REQUIREMENT: Final = "mujoco>=4.0,<5"
"""Version of MuJoCo that simkit needs, as in `pyproject.toml`."""

REINSTALL: Final = f"python -m pip install --force-reinstall '{REQUIREMENT}'"
_LIBRARY: Final = re.compile(r"\.(so|dylib|dll|pyd)(\.[\d.]+)?$")
_VERSION: Final = re.compile(r"\d+\.\d+\.\d+")
_is_checked = False


def import_mujoco() -> None:
    """Import MuJoCo; retry without a renderer if the import fails because of `MUJOCO_GL`.

    MuJoCo opens the library of the renderer when it is imported. An unknown value or a missing library would end a run
    that draws nothing. A run that draws gets the reason from `simkit.sensors.cameras.rendering.gl_context`.

    The engine's warnings are then written neither to the terminal nor to a log file in the working directory, unless
    another warning callback is already installed. The warnings of a simulation are among its diagnostics.

    Raises:
        InstallationError: SK-CORE-005 MuJoCo is missing, damaged, or has another version.
    """
    global _is_checked
    if "mujoco" not in sys.modules:
        check_memory_limit()
    try:
        mujoco = _import()
        version = str(mujoco.__version__)
        if version.split(".")[0] == "4" and mujoco.get_mju_user_warning() is None:
            mujoco.set_mju_user_warning(ignore_warning)
    except ModuleNotFoundError as error:
        if error.name != "mujoco":
            raise _installation_error(f"MuJoCo cannot be imported ({_first_line(error)})") from error
        raise _installation_error("MuJoCo is not installed") from None
    except Exception as error:
        if too_little := find_memory_error(error):
            raise too_little from error
        # the exception depends on the damage: ImportError, OSError, AttributeError, …
        repair = REINSTALL
        if os.strerror(errno.EMFILE) in str(error):
            repair = "allow more open files: ulimit -n 1024"
        raise _installation_error(f"MuJoCo cannot be imported ({_first_line(error)})", repair) from error
    if _is_checked:
        return
    if version.split(".")[0] != "4":
        raise _installation_error(f"MuJoCo {version} is installed, but simkit needs {REQUIREMENT}")
    damage = _damage(Path(mujoco.__file__ or "").parent, version)
    if damage:
        raise damage
    _is_checked = True


def _import() -> Any:
    with nullcontext() if "mujoco" in sys.modules else _safe_path():
        _defer_glfw()
        try:
            import mujoco
        except Exception:
            # the exception depends on the driver: RuntimeError, ImportError, AttributeError
            renderer = os.environ.get("MUJOCO_GL")
            if not renderer:
                raise
            os.environ["MUJOCO_GL"] = "disable"
            try:
                import mujoco
            finally:
                os.environ["MUJOCO_GL"] = renderer
    return mujoco


class _DeferredModule(ModuleType):
    """Module that is executed when one of its names is read first; Python's `LazyLoader` executes it at `import`."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") and name != "__all__":
            raise AttributeError(name)
        with _DEFERRED_LOCK:
            if type(self) is _DeferredModule:
                loader = self.__loader__
                assert isinstance(loader, Loader)
                self.__class__ = cast(Any, ModuleType)
                try:
                    with _safe_path():
                        loader.exec_module(self)
                except BaseException:
                    self.__class__ = _DeferredModule
                    raise
        return getattr(self, name)


_DEFERRED_LOCK: Final = threading.RLock()


def _defer_glfw() -> None:
    """Load GLFW at its first use instead of with MuJoCo.

    GLFW starts a Python process to look for its library, which takes a third of the time of `import mujoco`. Only
    windows need it.
    """
    if "glfw" in sys.modules or "mujoco" in sys.modules:
        return
    spec = find_spec("glfw")
    if spec is None or spec.loader is None or spec.submodule_search_locations is None:
        return
    module = _DeferredModule("glfw")
    module.__spec__, module.__loader__, module.__file__ = spec, spec.loader, spec.origin
    module.__package__, module.__path__ = "glfw", spec.submodule_search_locations
    sys.modules["glfw"] = module


@contextmanager
def _safe_path() -> Iterator[None]:
    """Start Python processes that import nothing from the working directory.

    MuJoCo imports GLFW, which looks for its library in a new Python process. There, a file `types.py` of the user would
    replace the module of the standard library, and its error would be printed.
    """
    before = os.environ.get("PYTHONSAFEPATH")
    os.environ["PYTHONSAFEPATH"] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ["PYTHONSAFEPATH"]
        else:
            os.environ["PYTHONSAFEPATH"] = before


def _damage(package: Path, version: str) -> InstallationError | None:
    """Return an error if libraries of the package are missing, or if files of another version lie beside it."""
    records = [record for name in ("mujoco", "mujoco_core") for record in package.parent.glob(f"{name}-*.dist-info")]
    foreign = [record for record in records if not record.name.partition("-")[2].startswith(version)]
    libraries = [(file, _VERSION.search(file.name)) for file in package.glob("libmujoco.*")]
    foreign += [
        file for file, library_version in libraries if library_version is not None and library_version[0] != version
    ]
    if foreign:
        names = ", ".join(file.name for file in foreign)
        text = f"MuJoCo {version} in {package.parent} is mixed with files of another version ({names})"
        listed = " ".join(f"'{file}'" for file in dict.fromkeys((package, *records)))
        return _installation_error(text, f"rm -r {listed} && {REINSTALL}")
    missing = [name for record in records for name in _listed_libraries(record) if not (package.parent / name).exists()]
    if missing:
        names = ", ".join(missing[:3]) + (f" and {len(missing) - 3} more" if len(missing) > 3 else "")
        return _installation_error(f"MuJoCo {version} in {package.parent} is incomplete: {names} is missing")
    return None


def _listed_libraries(record: Path) -> list[str]:
    """Return the shared libraries that a package has installed; empty if its list is missing."""
    try:
        lines = (record / "RECORD").read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return []
    return [name for line in lines if _LIBRARY.search(name := line.partition(",")[0])]


def _installation_error(problem: str, repair: str = REINSTALL) -> InstallationError:
    return InstallationError(problem, help=repair)


def _first_line(error: Exception) -> str:
    """Return the first line of a message, without a sentence that introduces the next line."""
    line = next(iter(str(error).strip().splitlines()), type(error).__name__)
    return line.rpartition(". ")[0] if line.endswith(":") and ". " in line else line


def ignore_warning(_text: str) -> None:
    """Ignore a warning of the engine."""


def __getattr__(name: str) -> Any:
    """Return `mujoco`, so that `from simkit.mujoco_import import mujoco` uses the import above."""
    if name != "mujoco":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import_mujoco()
    import mujoco

    return mujoco

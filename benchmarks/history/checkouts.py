"""Commits in folders of their own, and the processes that measure them with the packages of this environment."""

from __future__ import annotations

import contextlib
import importlib.metadata
import json
import os
import platform
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]


def git(*arguments: str) -> str:
    """Return what a git command prints."""
    return subprocess.run(
        ["git", "-C", str(ROOT), *arguments], check=True, capture_output=True, text=True
    ).stdout.strip()


class Checkout:
    """One commit in a folder.

    Attributes:
        commit: its hash.
        folder: its files.
        environment: variables of a process that imports it.
    """

    def __init__(self, commit: str, folder: Path, metadata: Path) -> None:
        self.commit, self.folder = commit, folder
        packs = sorted(file.parent for file in folder.glob("packs/*/pack.toml"))
        tables = [tomllib.loads((pack / "pack.toml").read_text(encoding="utf-8")) for pack in packs]
        info = metadata / "simkit_robotics-0.dist-info"  # packs are found by the entry points of an installed simkit
        info.mkdir(parents=True)
        lines = "".join(f"{table['name']} = {table['package']}\n" for table in tables)
        (info / "entry_points.txt").write_text(f"[simkit.packs]\n{lines}", encoding="utf-8")
        (info / "METADATA").write_text("Metadata-Version: 2.1\nName: simkit-robotics\nVersion: 0\n", encoding="utf-8")
        self.environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(map(str, (metadata, folder, *packs))),
            "SIMKIT_MEASURED": str(folder),
            "SIMKIT_CACHE_DIR": str(metadata / "cache"),
            "PYTHONPYCACHEPREFIX": str(metadata / "modules"),
        }
        self.environment.pop("PYTHONDONTWRITEBYTECODE", None)


@contextlib.contextmanager
def checked_out(*names: str) -> Iterator[list[Checkout]]:
    """Check commits out into temporary folders, and remove these at the end."""
    with tempfile.TemporaryDirectory() as temporary:
        folders = [Path(temporary, str(number), "checkout") for number in range(len(names))]
        try:
            found = []
            for name, folder in zip(names, folders, strict=True):
                commit = git("rev-parse", f"{name}^{{commit}}")
                git("worktree", "add", "--detach", "--quiet", str(folder), commit)
                found.append(Checkout(commit, folder, folder.parent / "metadata"))
            yield found
        finally:
            for folder in folders:
                if folder.exists():
                    git("worktree", "remove", "--force", str(folder))


class Failed(Exception):
    """A case that a commit cannot run."""


class Worker:
    """Process that measures one case of one checkout; a context manager."""

    def __init__(self, checkout: Checkout, case: str) -> None:
        self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115 (closed in __exit__)
        self._process = subprocess.Popen(
            [sys.executable, str(FOLDER / "worker.py"), case],
            env=checkout.environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors, text=True,
        )  # fmt: skip

    def __enter__(self) -> Worker:
        try:
            self._answer()
        except Failed:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        assert self._process.stdin
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        self._process.wait()
        self._errors.close()

    def times(self, rounds: int) -> list[list[list[float]]]:
        """Return the times of both sides, by part."""
        assert self._process.stdin
        print(json.dumps(rounds), file=self._process.stdin, flush=True)
        answer: list[list[list[float]]] = self._answer()
        return answer

    def _answer(self) -> Any:
        assert self._process.stdout
        line = self._process.stdout.readline()
        if not line:
            self._process.wait()
            self._errors.seek(0)
            raise Failed((self._errors.read().strip().splitlines() or ["no answer"])[-1])
        return json.loads(line)


def fingerprint() -> dict[str, str | int]:
    """Return what the times depend on: processor, number of cores, versions."""
    model = platform.machine()
    with contextlib.suppress(OSError), open("/proc/cpuinfo", encoding="utf-8") as file:
        model = next((line.partition(":")[2].strip() for line in file if line.startswith("model name")), model)
    return {
        "processor": model,
        "cores": os.cpu_count() or 1,
        "python": platform.python_version(),
        **{name: importlib.metadata.version(name) for name in ("mujoco", "numpy")},
    }

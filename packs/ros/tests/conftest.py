"""Runs with a bridge, and nodes of a real rclpy in an environment of its own that the session makes."""

from __future__ import annotations

import json
import os
import platform
import re
import subprocess
import sys
import tempfile
import textwrap
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).parent
ROOT = FOLDER.parents[2]
DOMAIN = 1 + os.getpid() % 100
"""Domain of this process's tests; higher ones use ports that the system gives to others."""
TIMEOUT = 90.0
WHEELS = ("rclpy", "rmw-fastrtps-cpp", "common-interfaces")


@pytest.fixture(scope="session", params=["jazzy", "kilted"])
def ros_python(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A Python with rclpy. SIMKIT_TEST_ROS_VENVS keeps the environments in a folder for the next session."""
    if os.environ.get("SIMKIT_TEST_ROS") != "1":
        pytest.skip("SIMKIT_TEST_ROS=1 makes environments with rclpy (2 × 266 MB) and runs these tests")
    if (sys.platform, platform.machine()) != ("linux", "x86_64"):
        pytest.skip("the wheels of rclpy are for Linux on x86-64 only")
    kept = os.environ.get("SIMKIT_TEST_ROS_VENVS")
    folder = (Path(kept) if kept else tmp_path_factory.mktemp("ros")) / request.param
    python = folder / "bin" / "python"
    if not (folder / "is_complete").exists():
        wheels = [f"ros-{request.param}-{name}" for name in WHEELS]
        subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
        subprocess.run([str(python), "-m", "pip", "install", "-q", *wheels, "rosbags"], check=True, timeout=600)
        (folder / "is_complete").touch()
    return python


class Run:
    """A running `simkit`, with what it has printed."""

    def __init__(self, arguments: list[str], environment: dict[str, str]) -> None:
        command = [sys.executable, "-m", "simkit", *arguments]
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, cwd=ROOT
        )
        self.lines: list[str] = []
        self._news = threading.Condition()
        self._thread = threading.Thread(target=self._read)
        self._thread.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            with self._news:
                self.lines.append(line.rstrip())
                self._news.notify_all()
        with self._news:
            self.lines.append("")
            self._news.notify_all()

    @property
    def text(self) -> str:
        return "\n".join(self.lines)

    def until(self, pattern: str) -> re.Match[str]:
        """The first match in what the run has printed."""

        def found() -> bool:
            return re.search(pattern, self.text) is not None or (bool(self.lines) and self.lines[-1] == "")

        with self._news:
            self._news.wait_for(found, TIMEOUT)
            match = re.search(pattern, self.text)
        assert match is not None, f"no {pattern!r} in:\n{self.text}"
        return match

    def end(self) -> int:
        """The exit code, once the run has ended by itself."""
        code = self.process.wait(TIMEOUT)
        self._thread.join()
        return code

    def bridge(self) -> int:
        """The process of the bridge."""
        pid = self.process.pid
        (child,) = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        return int(child)

    def __enter__(self) -> Run:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.wait()
        self._thread.join()
        assert self.process.stdout is not None
        self.process.stdout.close()


@pytest.fixture(autouse=True)
def sockets(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of their own for the sockets of simulations, with a short path."""
    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp") as folder:
        monkeypatch.setenv("XDG_RUNTIME_DIR", folder)
        monkeypatch.setattr(tempfile, "tempdir", folder)
        monkeypatch.delenv("SIMKIT_SIM", raising=False)
        yield Path(folder) / "simkit"


@pytest.fixture
def simkit_command() -> Callable[..., Run]:
    """`with simkit_command("ros", "lab") as run:`."""
    return lambda *arguments: Run(list(arguments), dict(os.environ))


@pytest.fixture
def bridge_options(ros_python: Path) -> list[str]:
    """Options of a bridge for the tests' Python and domain."""
    return ["--ros-python", str(ros_python), "--ros-domain", str(DOMAIN)]


@pytest.fixture
def simkit_run(bridge_options: list[str]) -> Callable[..., Any]:
    """`with simkit_run("turtlebot3_world", "--duration", "5") as run:`, with a bridge that is open."""

    @contextmanager
    def start(*arguments: str, with_ros: bool = True) -> Iterator[Run]:
        ros = ["--ros", *bridge_options] if with_ros else []
        with Run(["run", *ros, *arguments], dict(os.environ)) as run:
            if with_ros:
                run.until(r"ROS 2: .* in domain")
            yield run

    return start


def ros_environment() -> dict[str, str]:
    """The environment of a node of ROS."""
    found = {k: v for k, v in os.environ.items() if not k.startswith(("_ROS", "PYTHON"))}
    found["PYTHONPATH"] = f"{FOLDER}{os.pathsep}{FOLDER.parent}{os.pathsep}{ROOT}"
    return found | {"ROS_DOMAIN_ID": str(DOMAIN), "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}


@pytest.fixture
def ros_node(ros_python: Path) -> Callable[[str], Any]:
    """`ros_node(code)`: what the code of a ROS node tells, with the settings that ROS has by default."""

    def run(code: str) -> Any:
        command = [str(ros_python), str(FOLDER / "ros_client.py"), textwrap.dedent(code)]
        found = subprocess.run(command, capture_output=True, text=True, env=ros_environment(), timeout=TIMEOUT)
        answers = [line for line in found.stdout.splitlines() if line.startswith("answer ")]
        assert answers, found.stdout + found.stderr
        return json.loads(answers[-1].removeprefix("answer "))

    return run

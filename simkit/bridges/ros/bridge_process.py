"""Bridge process of a simulation: its options, its environment, its start and its end."""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Final

from simkit.bridges.ros.ros_names import is_namespace
from simkit.bridges.ros.ros_python import INSTALL_HELP, find_python
from simkit.errors import InputError

_FOLDER: Final = Path(__file__).parent
_START_TIMEOUT: Final = 60.0  # [s]; the first import of rclpy on a slow disk takes several seconds
_END_TIMEOUT: Final = 5.0  # [s] for passing on the last messages
_POLL: Final = 0.02  # [s] between two looks at a bridge that starts
_MOST_DOMAIN: Final = 232
_LEAVES_LOOPBACK: Final = ("ROS_STATIC_PEERS", "ROS_LOCALHOST_ONLY", "ROS_DISCOVERY_SERVER")


@dataclass(frozen=True)
class RosOptions:
    """Options of the bridge.

    Attributes:
        python: Python with rclpy; None for the first that is found.
        domain: number of the ROS domain; None for `ROS_DOMAIN_ID`, else 0.
        namespace: namespace of all names in ROS; empty for none.
        uses_network: True to reach other machines; otherwise no socket leaves 127.0.0.1.
        arguments: arguments of ROS, such as `("-r", "/scan:=/lidar")`.
    """

    python: Path | None = None
    domain: int | None = None
    namespace: str = ""
    uses_network: bool = False
    arguments: tuple[str, ...] = ()

    def check(self) -> None:
        """Validate the options.

        Raises:
            InputError: SK-ROS-003 the domain or the namespace is invalid.
        """
        if self.domain is not None and not 0 <= self.domain <= _MOST_DOMAIN:
            text = f"SK-ROS-003 --ros-domain: found {self.domain}; expected a number from 0 to {_MOST_DOMAIN}"
            raise InputError(text, "SK-ROS-003")
        if self.namespace and not is_namespace(self.namespace):
            text = (
                f"SK-ROS-003 --ros-namespace: found {self.namespace!r}; expected letters, digits and _ between slashes"
            )
            raise InputError(text, "SK-ROS-003")

    def environment(self) -> dict[str, str]:
        """Return the environment variables of the bridge process."""
        found = dict(os.environ)
        # ROS from PyPI starts each Python a second time, with its libraries; this mark may be of another environment
        found.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None)
        found["RMW_IMPLEMENTATION"] = "rmw_fastrtps_cpp"
        if self.domain is not None:
            found["ROS_DOMAIN_ID"] = str(self.domain)
        variables = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")  # Jazzy, Kilted
        if self.uses_network:
            if not any(name in found for name in variables):
                found.update(dict.fromkeys(variables, str(_FOLDER / "network.xml")))
            return found
        for name in _LEAVES_LOOPBACK:
            found.pop(name, None)
        found.update(dict.fromkeys(variables, str(_FOLDER / "loopback.xml")))
        # with LOCALHOST, rmw_fastrtps_cpp would add a transport that uses all addresses
        return {**found, "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "SKIP_DEFAULT_XML_FILE": "1"}


class RosBridge:
    """Bridge process; a context manager that waits for the end of the process.

    Args:
        options: options of the bridge.
        report: callback for a line to the user.

    Raises:
        InputError: SK-ROS-001 there is no Python with rclpy; SK-ROS-003 an option is invalid.
    """

    def __init__(self, options: RosOptions, report: Callable[[str], None]) -> None:
        options.check()
        self._options, self._report = options, report
        self._python = find_python(options.python)
        self._process: subprocess.Popen[bytes] | None = None
        self._lines: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()
        self._errors: deque[str] = deque(maxlen=20)
        self._last: dict[str, Any] = {}
        self._is_over = False

    def start(
        self,
        socket: Path,
        serve: Callable[[float], object] = time.sleep,
        is_interrupted: Callable[[], bool] = lambda: False,
    ) -> None:
        """Start the process and wait until everything is open in ROS.

        Args:
            socket: path of the simulation's socket.
            serve: function that serves the simulation's clients for some wall time [s].
            is_interrupted: function that returns True to wait no longer.

        Raises:
            InputError: SK-ROS-002 the bridge cannot start; the message has the reason.
        """
        namespace = "/" + self._options.namespace.strip("/") if self._options.namespace.strip("/") else ""
        options = {"socket": str(socket), "namespace": namespace, "arguments": self._options.arguments}
        try:
            self._process = process = subprocess.Popen(
                [str(self._python), "-P", str(_FOLDER / "bridge_main.py"), json.dumps(options)],
                stdin=subprocess.PIPE,  # nothing is written; the pipe closes when this process ends
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env=self._options.environment(),
                start_new_session=True,
            )
        except OSError as error:
            raise self._start_error(f"{self._python} cannot be started: {error.strerror}") from None
        for pipe, take in ((process.stdout, self._take_line), (process.stderr, self._errors.append)):
            threading.Thread(target=_read_lines, args=(pipe, take), daemon=True).start()
        end = time.monotonic() + _START_TIMEOUT
        while "ready" not in self._last:
            serve(_POLL)
            self._report_notes()
            if is_interrupted():
                return
            if process.poll() is not None:
                self._report_notes(0.5)
                reason = self._last.get("error") or (
                    self._errors[-1] if self._errors else f"exit code {process.poll()}"
                )
                raise self._start_error(str(reason))
            if time.monotonic() > end:
                raise self._start_error(f"the bridge is not ready after {_START_TIMEOUT:g} s")
        self._report(self._ready_text(self._last["ready"]))

    def _ready_text(self, found: dict[str, int]) -> str:
        counts = ", ".join(
            f"{found[name]} {name if found[name] != 1 else name[:-1]}" for name in ("topics", "services", "actions")
        )
        domain = self._options.environment().get("ROS_DOMAIN_ID") or "0"
        return f"ROS 2: {counts} in domain {domain}" + ("" if self._options.uses_network else ", on this machine only")

    def _start_error(self, reason: str) -> InputError:
        helps = f"\n    help: {INSTALL_HELP}" if "No module named" in reason or "rmw" in reason else ""
        text = f"SK-ROS-002 the bridge to ROS 2 cannot start with {self._python}: {reason}{helps}"
        return InputError(text, "SK-ROS-002")

    def check(self) -> None:
        """Report new notes of a bridge whose run continues, and once the end of the process."""
        if not self._is_over and not self._is_alive():
            self._is_over = True
            text = f"the bridge to ROS 2 has ended ({self._end_reason()}); the simulation continues without ROS"
            self._report(f"warning SK-ROS-004: {text}")

    def wait(self, is_interrupted: Callable[[], bool]) -> int:
        """Wait until the process ends or a function returns True.

        Returns:
            Exit code: 0 if the simulation has ended, 1 if the bridge has failed.
        """
        while self._is_alive():
            time.sleep(_POLL)
            if is_interrupted():
                self._end()
                return 0
        if "ended" in self._last:
            self._report(f"note: {self._end_reason()}")
            return 0
        self._report(f"error: SK-ROS-004 the bridge to ROS 2 has ended ({self._end_reason()})")
        return 1

    def _is_alive(self) -> bool:
        """Report new notes, and check whether the process runs."""
        self._report_notes()
        if self._process is None or self._process.poll() is None:
            return self._process is not None
        self._report_notes(0.5)
        return False

    def _end_reason(self) -> str:
        reason = self._last.get("ended") or self._last.get("error")
        if reason or self._process is None:
            return str(reason)
        code = self._process.returncode
        return f"signal {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"

    def _end(self) -> None:
        """Ask the process to end."""
        if self._process is not None and self._process.stdin is not None:
            self._process.stdin.close()

    def _take_line(self, line: str) -> None:
        try:
            found = json.loads(line)
        except ValueError:
            return
        if isinstance(found, dict):
            self._lines.put(found)

    def _report_notes(self, wait: float = 0.0) -> None:
        """Process the lines that have arrived; wait at most some time [s] for the first."""
        while True:
            try:
                found = self._lines.get(timeout=wait) if wait else self._lines.get_nowait()
            except queue.Empty:
                return
            if found is None:
                return
            self._last.update(found)
            if "note" in found:
                self._report(f"note SK-ROS-005: {found['note']}")

    def __enter__(self) -> RosBridge:
        return self

    def __exit__(self, *_: object) -> None:
        """Wait until the process has passed on the last messages; kill a process that does not end."""
        process, self._is_over = self._process, True
        if process is None:
            return
        with suppress(subprocess.TimeoutExpired):
            process.wait(_END_TIMEOUT)
        self._end()
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _read_lines(pipe: IO[bytes] | None, take: Callable[[str], None]) -> None:
    """Pass the lines of a pipe to a function until the pipe closes."""
    if pipe is not None:
        with pipe:
            for line in pipe:
                take(line.decode("utf-8", "replace").strip())

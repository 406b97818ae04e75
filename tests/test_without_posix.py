"""The commands work without what only POSIX systems have: its functions and modules are taken from Python here.

Windows itself has not been tried. These tests find a name that Windows does not have, not a difference in behaviour.
"""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FILES = sorted([*ROOT.glob("simkit/**/*.py"), *ROOT.glob("packs/*/simkit_*/**/*.py")])

NAMES: Mapping[str, frozenset[str]] = {
    module: frozenset(names.split())
    for module, names in {
        "os": """O_CLOEXEC O_DIRECTORY O_NOCTTY O_NOFOLLOW O_NONBLOCK O_SYNC WNOHANG chown chroot fchmod fchown fork
            forkpty get_blocking getegid geteuid getgid getgroups getloadavg getpgid getpgrp getpriority getuid
            initgroups killpg lchown lockf memfd_create mkfifo mknod nice openpty pidfd_open pipe2 posix_fadvise
            posix_fallocate pread pwrite register_at_fork sched_getaffinity sched_setaffinity sched_yield sendfile
            set_blocking setgid setpgid setpriority setsid setuid statvfs sync sysconf tcgetpgrp tcsetpgrp ttyname
            uname wait wait3 wait4 waitid""",
        "signal": """ITIMER_REAL SIGALRM SIGCHLD SIGCONT SIGHUP SIGKILL SIGPIPE SIGQUIT SIGSTOP SIGTSTP SIGTTIN
            SIGTTOU SIGUSR1 SIGUSR2 SIGWINCH SIG_BLOCK SIG_SETMASK SIG_UNBLOCK alarm pause pthread_kill
            pthread_sigmask setitimer siginterrupt sigtimedwait sigwait""",
        "socket": "AF_UNIX SCM_RIGHTS SO_PEERCRED SO_REUSEPORT",
        "select": "epoll kqueue poll",
        "selectors": "DevpollSelector EpollSelector KqueueSelector PollSelector",
        "time": "clock_gettime pthread_getcpuclockid tzset",
    }.items()
}
"""Names of the standard library that Windows does not have, in one of the supported versions of Python."""

MODULES = frozenset({"fcntl", "grp", "posix", "pty", "pwd", "readline", "resource", "syslog", "termios", "tty"})

GUARDED_ELSEWHERE = {
    "bridges/live/unix_socket.py": "used only where `is_available` is true",
    "packs/ros/simkit_ros/wait_thread.py": "only the Python of ROS runs it, and Windows has no wheels of ROS",
    "packs/launch/simkit_launch/programs/keyboard_teleop.py": "programs have a `termios` of simkit_nodes everywhere",
    "packs/launch/simkit_launch/programs/turtle_teleop_key.py": "as keyboard_teleop.py",
    "cli/terminal/keyboard.py": "`Keyboard` is used only where `sys.platform` is not win32",
    "cli/wall_time_limit.py": "`_may_alarm` is false where there is no SIGALRM",
}
"""Files whose uses another function guards, with the reason."""


def uses(tree: ast.AST) -> Iterator[tuple[int, str, str]]:
    """Line, module and name of each use of a name that Windows does not have."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            if node.attr in NAMES.get(node.value.id, ()):
                yield node.lineno, node.value.id, node.attr
        elif isinstance(node, ast.ImportFrom) and node.module in NAMES:
            yield from ((node.lineno, node.module, n.name) for n in node.names if n.name in NAMES[node.module])
        elif isinstance(node, ast.ImportFrom) and node.module in MODULES:
            yield node.lineno, node.module, ""
        elif isinstance(node, ast.Import):
            yield from ((node.lineno, n.name, "") for n in node.names if n.name in MODULES)


def is_guarded(block: ast.AST) -> bool:
    """Whether a function, or a statement of a module, asks for what the system has."""
    for node in ast.walk(block):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("hasattr", "getattr"):
            return True
        if isinstance(node, ast.Attribute) and ast.unparse(node) in ("os.name", "sys.platform"):
            return True
        if isinstance(node, ast.ExceptHandler) and node.type is not None:
            caught = ast.unparse(node.type)
            if "ImportError" in caught or "AttributeError" in caught:
                return True
    return False


def blocks(tree: ast.Module) -> Iterator[ast.AST]:
    """Functions and methods, and the other statements of the module."""
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            yield from node.body
        else:
            yield node


def unguarded(text: str) -> list[tuple[int, str]]:
    found = []
    for block in blocks(ast.parse(text)):
        if not is_guarded(block):
            found += [(line, f"{module}.{name}" if name else module) for line, module, name in uses(block)]
    return found


def test_a_use_of_a_posix_name_asks_whether_the_system_has_it() -> None:
    found: dict[str, list[tuple[int, str]]] = {}
    suspects = re.compile(rf"\b({'|'.join((*MODULES, *(name for names in NAMES.values() for name in names)))})\b")
    for path in FILES:
        text = path.read_text(encoding="utf-8")
        if suspects.search(text) and (problems := unguarded(text)):
            found[path.relative_to(ROOT).as_posix().removeprefix("simkit/")] = problems
    wrong = {name: problems for name, problems in found.items() if name not in GUARDED_ELSEWHERE}
    assert not wrong, "guard these with hasattr, or say in the table why they are guarded"
    assert found.keys() == GUARDED_ELSEWHERE.keys(), "the table has rows that nothing needs"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("import fcntl", [(1, "fcntl")]),
        ("try:\n    import fcntl\nexcept ImportError:\n    fcntl = None", []),
        ("from signal import SIGKILL", [(1, "signal.SIGKILL")]),
        ("def f():\n    os.killpg(1, signal.SIGKILL)", [(2, "os.killpg"), (2, "signal.SIGKILL")]),
        ("def f():\n    if hasattr(os, 'killpg'):\n        os.killpg(1, 9)", []),
        (
            "class A:\n    def f(self):\n        return os.getuid()\n    def g(self):\n        return os.name",
            [(3, "os.getuid")],
        ),
    ],
)
def test_uses_and_guards_are_found(text: str, found: list[tuple[int, str]]) -> None:
    assert sorted(unguarded(text)) == found


def text_without_encoding(tree: ast.AST) -> Iterator[int]:
    """Lines that open a file as text in the encoding of the system, which is not UTF-8 on Windows."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
        words = {word.arg for word in node.keywords}  # None for `**options` of a caller
        if {"encoding", None} & words or (name, len(node.args)) in (("read_text", 1), ("write_text", 2)):
            continue
        texts = [a.value for a in (*node.args, *(k.value for k in node.keywords)) if isinstance(a, ast.Constant)]
        is_binary = any(isinstance(text, str) and re.fullmatch(r"[rwxab+]*b[rwxab+]*", text) for text in texts)
        is_open = name == "open" and isinstance(node.func, ast.Name)
        if name in ("read_text", "write_text") or (is_open and not is_binary):
            yield node.lineno


def test_text_files_are_opened_with_their_encoding() -> None:
    found = []
    for path in FILES:
        text = path.read_text(encoding="utf-8")
        if re.search(r"\b(open|read_text|write_text)\(", text):
            found += [f"{path.relative_to(ROOT)}:{line}" for line in text_without_encoding(ast.parse(text))]
    assert found == []


@pytest.mark.parametrize(
    ("text", "is_found"),
    [
        ("open(path)", True),
        ("open(path, 'a+')", True),
        ("open(path, 'rb')", False),
        ("open(path, encoding='utf-8')", False),
        ("Path('a').write_text(text)", True),
        ("path.read_text('utf-8')", False),
    ],
)
def test_files_without_an_encoding_are_found(text: str, is_found: bool) -> None:
    assert bool(list(text_without_encoding(ast.parse(text)))) == is_found


# The modules of others come first: on Windows they have other files of their own. POSIX stands in for `msvcrt.locking`:
# both lock a range of bytes for a process.
PROGRAM = f"""
import asyncio, concurrent.futures, ctypes, errno, fcntl, getpass, multiprocessing, os, random, selectors, shutil
import signal, socket, subprocess, sys, tempfile, threading, types, uuid, webbrowser
import lxml.etree, mujoco, numpy, rich.console, scipy, trimesh, typer, yaml

def locking(handle, mode, count):
    command = fcntl.LOCK_UN if mode == 0 else fcntl.LOCK_EX | fcntl.LOCK_NB
    try:
        fcntl.lockf(handle, command, count, 0, os.SEEK_CUR)
    except BlockingIOError:
        raise PermissionError(errno.EACCES, "Permission denied") from None

windows = types.ModuleType("msvcrt")
windows.LK_UNLCK, windows.LK_NBLCK, windows.locking = 0, 2, locking
sys.modules["msvcrt"] = windows
KEPT = {{"uname", "set_blocking", "WNOHANG"}}  # the standard library of this system uses them itself
for module, names in { {module: sorted(names) for module, names in NAMES.items()}!r}.items():
    for name in set(names) - KEPT:
        if hasattr(sys.modules[module], name):
            delattr(sys.modules[module], name)
for module in {sorted(MODULES)!r}:
    sys.modules[module] = None
"""
COMMAND = PROGRAM + "sys.argv[0] = 'simkit'\nfrom simkit.cli import main\nmain()\n"
IMPORTS = (
    PROGRAM
    + """
import importlib, pkgutil
import simkit
optional = set(sys.argv[1].split())
found = []
from simkit.packs import installed_packs
packages = [simkit, *(importlib.import_module(pack.package) for pack in installed_packs())]
modules = [m for package in packages for m in pkgutil.walk_packages(package.__path__, package.__name__ + ".")]
for module in modules:
    if module.name == "simkit.__main__" or {"programs", "packages"} & set(module.name.split(".")):
        continue  # programs import modules of ROS and of their folder; packages have launch files
    try:
        importlib.import_module(module.name)
    except ImportError as error:
        if error.name is None or error.name.partition(".")[0] not in optional:
            raise
    found.append(module.name)
print(len(found))
"""
)
OPTIONAL = "rclpy action_msgs lifecycle_msgs rcl_interfaces rosidl_runtime_py builtin_interfaces glfw pytest msvcrt"


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """Environment variables of the commands, with a folder for data of programs as Windows has it."""
    (tmp_path / "local").mkdir(mode=0o700)
    return {**os.environ, "LOCALAPPDATA": str(tmp_path / "local")}


def command(*words: str, environment: Mapping[str, str], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", COMMAND, *words],
        env=environment,
        cwd=folder,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )


@pytest.mark.slow
def test_every_module_is_imported() -> None:
    found = subprocess.run(
        [sys.executable, "-c", IMPORTS, OPTIONAL], capture_output=True, text=True, encoding="utf-8", check=False
    )
    assert found.returncode == 0, found.stderr
    assert int(found.stdout) > 500


@pytest.mark.slow
def test_a_golden_run_is_recorded_and_checked(environment: dict[str, str], tmp_path: Path) -> None:
    for words in (("record", "empty", "--duration", "0.1", "--out", "golden"), ("check", "golden")):
        found = command("golden", *words, environment=environment, folder=tmp_path)
        assert found.returncode == 0, found.stdout + found.stderr
    assert {path.suffix for path in (tmp_path / "golden").iterdir()} == {".json", ".xz"}


@pytest.mark.slow
def test_another_terminal_reaches_a_run(environment: dict[str, str], tmp_path: Path) -> None:
    words = ["run", "empty", "--paused"]
    with subprocess.Popen(
        [sys.executable, "-c", COMMAND, *words],
        env=environment,
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    ) as process:
        try:
            folder = tmp_path / "local" / "simkit-running"
            assert process.stdout is not None
            while b"paused at" not in (line := process.stdout.readline()):
                assert line, "the run has ended"
            assert [path.name for path in folder.glob("*.port")] == ["empty.port"]
            found = command("topic", "list", environment=environment, folder=tmp_path)
            assert found.returncode == 0 and "/clock" in found.stdout, found.stdout + found.stderr
        finally:
            process.terminate()
    assert not list(folder.glob("*.port")), "the run has removed its file"

"""Sockets lie where only their user can reach them, and no name is ever taken from the living."""

from __future__ import annotations

import os
import socket
import stat
import tempfile
from pathlib import Path

import pytest

import simkit
from simkit.bridges.live import socket_files
from simkit.bridges.live.discovery import find_socket, simulations
from simkit.bridges.live.server import Server, serve


def test_folder_and_socket_are_accessible_only_to_their_user(court: simkit.Simulation, sockets: Path) -> None:
    with Server(court) as server:
        assert server.path == sockets / "court.sock"
        assert stat.S_IMODE(os.lstat(sockets).st_mode) == 0o700
        found = os.lstat(server.path)
        assert stat.S_ISSOCK(found.st_mode) and stat.S_IMODE(found.st_mode) == 0o600
    assert not server.path.exists()


def test_a_folder_that_other_users_may_enter_is_not_used(court: simkit.Simulation, sockets: Path) -> None:
    sockets.mkdir(mode=0o700)
    sockets.chmod(0o755)
    with Server(court) as server:
        assert server.path.parent.name == f"simkit-{os.getuid()}"
        server.path.parent.chmod(0o777)
        other, note = serve(court)
        assert other is None
        assert "SK-LIVE-009" in note and "is open to others (mode 777; expected 700)" in note
        assert simulations() == [], "sockets in such a folder are not trusted either"


def test_a_link_instead_of_the_folder_is_not_followed(sockets: Path, tmp_path: Path) -> None:
    sockets.symlink_to(tmp_path)
    assert socket_files.folder_fault(sockets) == f"{sockets} is not a folder"
    listening, _, path = socket_files.bind("court")
    listening.close()
    path.unlink()
    assert path.parent != sockets


def test_the_socket_of_a_dead_process_is_replaced(court: simkit.Simulation, sockets: Path) -> None:
    sockets.mkdir(mode=0o700)
    for name in ("court", "other"):
        with socket.socket(socket.AF_UNIX) as dead:
            dead.bind(str(sockets / f"{name}.sock"))
    assert simulations() == []
    with Server(court) as server:
        assert server.name == "court"
        assert socket_files.is_living(server.path)
        found = [(s.name, s.pid, s.world) for s in simulations()]
        assert found == [("court", os.getpid(), "")], "it says its world once it is polled"
        assert [path.name for path in sockets.glob("*.sock")] == ["court.sock"]


@pytest.mark.parametrize(
    ("name", "file"),
    [("lab/../x y", "lab_.._x_y"), ("Büro", "B_ro"), ("..", "simulation"), ("", "simulation"), ("a" * 99, "a" * 48)],
)
def test_any_name_becomes_a_valid_file_name(name: str, file: str) -> None:
    assert socket_files.file_name(name) == file


def test_a_path_that_is_too_long_is_replaced_by_the_temporary_folder(
    court: simkit.Simulation, sockets: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    deep = sockets.parent / ("d" * 90)
    deep.mkdir()
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(deep))
    with Server(court) as server:
        assert server.path.parent.name == f"simkit-{os.getuid()}"
        assert [found.name for found in simulations()] == ["court"]
    monkeypatch.setattr(tempfile, "tempdir", str(deep))
    none, note = serve(court)
    assert none is None and note.startswith("note SK-LIVE-009: other terminals cannot reach this run: ")


def test_a_python_without_unix_sockets_uses_local_tcp(
    court: simkit.Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr(socket, "AF_UNIX")
    with Server(court) as server:
        assert server.path.name == "court.port"
        assert [found.name for found in simulations()] == ["court"]
    monkeypatch.setenv("SIMKIT_LOCAL_SOCKETS", "unix")
    none, note = serve(court)
    assert none is None
    assert note.endswith("reach this run: this system's Python has no Unix sockets; expected SIMKIT_LOCAL_SOCKETS=tcp")


def test_an_unknown_kind_of_sockets_is_told_and_the_run_continues(
    court: simkit.Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SIMKIT_LOCAL_SOCKETS", "pipe")
    none, note = serve(court)
    assert none is None and note.endswith("SIMKIT_LOCAL_SOCKETS is 'pipe'; expected unix or tcp")


def test_a_file_that_is_not_a_socket_is_deleted_or_keeps_its_name(court: simkit.Simulation, sockets: Path) -> None:
    sockets.mkdir(mode=0o700)
    (sockets / "court.sock").mkdir()
    (sockets / "text.sock").write_text("no socket")
    (sockets / "link.sock").symlink_to("/nobody/there")
    with Server(court) as server:
        assert server.name == "court_2", "a folder is left alone"
        assert [found.name for found in simulations()] == ["court_2"]
        assert sorted(path.name for path in sockets.glob("*.sock")) == ["court.sock", "court_2.sock"]


def test_a_lock_that_is_never_released_does_not_prevent_a_run(
    court: simkit.Simulation, sockets: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import fcntl

    monkeypatch.setattr(socket_files, "_LOCK_TIMEOUT", 0.05)
    sockets.mkdir(mode=0o700)
    with (sockets / ".lock").open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        with Server(court) as server:
            assert server.path.parent.name == f"simkit-{os.getuid()}"


@pytest.mark.parametrize("name", ["Büro 7", "a/b", "n" * 300])
def test_a_run_is_found_by_its_name(court: simkit.Simulation, name: str) -> None:
    with Server(court, name) as server:
        assert find_socket(name) == server.path

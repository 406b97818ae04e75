"""Local TCP: only a caller with the token of the user's file is heard, and files of dead processes are cleaned up."""

from __future__ import annotations

import contextlib
import json
import socket
import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.bridges.live import loopback_socket, socket_files
from simkit.bridges.live.discovery import find_socket, simulations
from simkit.bridges.live.protocol import ASK, LARGEST_OUT, TELL, FrameReader, json_frame, read_json_frame
from simkit.bridges.live.server import Server
from simkit.live import Client, LiveError

pytestmark = pytest.mark.parametrize("kind_of_sockets", ["tcp"], indirect=True)

PAUSE = json_frame(ASK, {"id": 1, "ask": "control", "action": "pause"})
SERVER = """
import sys, simkit
from simkit.bridges.live.server import Server
with simkit.load(sys.argv[1]) as sim, Server(sim) as server:
    print(server.path, flush=True)
    sys.stdin.read()
"""
WORLD = "<sdf version='1.9'><world name='court'/></sdf>"


@pytest.fixture
def server(court: simkit.Simulation) -> Iterator[Server]:
    with Server(court) as found:
        yield found


def call(server: Server, first: bytes) -> socket.socket:
    """A connection to the port of a server that begins with some bytes."""
    caller = socket.create_connection(("127.0.0.1", about(server)["port"]), timeout=60.0)
    caller.sendall(first)
    return caller


def about(server: Server) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(server.path.read_text(encoding="utf-8"))
    return found


def answer(server: Server, caller: socket.socket) -> bytes:
    """What a caller gets while the server is polled a few times."""
    caller.setblocking(False)
    found = b""
    for _ in range(5):
        server.poll()
        with contextlib.suppress(BlockingIOError, ConnectionResetError):
            found += caller.recv(1 << 16)
    return found


def is_closed(caller: socket.socket) -> bool:
    caller.settimeout(5.0)
    with contextlib.suppress(ConnectionResetError):
        return caller.recv(1) == b""
    return True


def test_only_the_user_can_read_the_file_of_a_server(server: Server, sockets: Path) -> None:
    assert server.path == sockets / "court.port"
    assert stat.S_IMODE(server.path.stat().st_mode) == 0o600
    found = about(server)
    assert len({found["caller_token"], found["server_token"]}) == 2
    assert {len(bytes.fromhex(found[name])) for name in ("caller_token", "server_token")} == {32}


def test_a_caller_without_a_token_hears_nothing(server: Server) -> None:
    with call(server, b"") as silent:
        assert answer(server, silent) == b""
        assert not server.peers


@pytest.mark.parametrize(
    "token",
    [bytes(32), b"\xff" * 32, PAUSE, "server_token", "cut off"],
    ids=["zeros", "ones", "a request", "the server's", "cut off"],
)
def test_a_caller_with_a_wrong_token_is_refused_and_its_request_is_not_read(
    court: simkit.Simulation, server: Server, token: bytes | str
) -> None:
    if token == "server_token":
        token = bytes.fromhex(about(server)["server_token"])
    elif isinstance(token, str):
        token = bytes.fromhex(about(server)["caller_token"])[:31] + b"\0"
    with call(server, token + PAUSE) as caller:
        assert answer(server, caller) == b""
        assert is_closed(caller)
    assert not court.paused and not server.peers


def test_a_request_behind_the_right_token_is_processed(court: simkit.Simulation, server: Server) -> None:
    found = about(server)
    with call(server, bytes.fromhex(found["caller_token"]) + PAUSE) as caller:
        content = answer(server, caller)
        reader = FrameReader(LARGEST_OUT, (TELL, 2), bytes.fromhex(found["server_token"]))
        reader.feed(content)
        frame = reader.next()
        assert frame is not None
        assert read_json_frame(frame[1])[0]["world"] == "court"
    assert court.paused


def test_a_token_may_come_in_pieces(server: Server) -> None:
    token = bytes.fromhex(about(server)["caller_token"])
    with call(server, token[:5]) as caller:
        assert answer(server, caller) == b""
        caller.sendall(token[5:])
        assert answer(server, caller).startswith(bytes.fromhex(about(server)["server_token"]))


def test_callers_without_a_token_do_not_keep_others_out(server: Server) -> None:
    with contextlib.ExitStack() as stack:
        silent = [stack.enter_context(call(server, b"")) for _ in range(40)]
        for _ in range(3):
            server.poll()
        assert is_closed(silent[0]), "the oldest ones make room"
        with call(server, bytes.fromhex(about(server)["caller_token"])) as caller:
            assert answer(server, caller)
        assert len(server.peers) == 1


def test_a_caller_that_sends_no_token_in_time_is_refused(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loopback_socket, "_TOKEN_TIMEOUT", -1.0)
    with call(server, b"x") as caller:
        server.poll()
        assert is_closed(caller)


def test_a_stranger_at_the_port_is_not_taken_for_the_simulation(sockets: Path) -> None:
    """The file is locked, as that of a living server, but another program answers at its port."""
    sockets.mkdir(mode=0o700)
    path = sockets / "court.port"
    listener = loopback_socket.LoopbackListener(path)
    found = json.loads(path.read_text(encoding="utf-8"))
    with socket.create_server(("127.0.0.1", 0)) as stranger:
        found["port"] = stranger.getsockname()[1]
        path.write_text(json.dumps(found), encoding="utf-8")
        hello = json_frame(TELL, {"tell": "hello", "protocol": 1, "world": "trap"})
        connection, token = socket_files.connect(path, timeout=60.0)
        with connection, stranger.accept()[0] as other:
            other.sendall(bytes(32) + hello)
            reader = FrameReader(LARGEST_OUT, (TELL,), token)
            reader.feed(connection.recv(1 << 16))
            with pytest.raises(Exception, match="the first bytes are not the token of the simulation"):
                reader.next()
    listener.close()


def test_a_file_that_others_may_read_is_not_used(server: Server) -> None:
    server.path.chmod(0o644)
    with pytest.raises(LiveError, match=r"SK-LIVE-003 .*court\.port is open to others \(mode 644; expected 600\)"):
        Client(server.path)


def test_a_link_to_a_file_is_not_followed(server: Server) -> None:
    link = server.path.with_name("other.port")
    link.symlink_to(server.path)
    with pytest.raises(LiveError, match="'other' cannot be reached"):
        Client(link)


@pytest.mark.parametrize("content", ["", "{}", "[]", '{"port": 0}', "\0" * 99, '{"port": 1, "pid": 1}'])
def test_a_damaged_file_is_told(server: Server, content: str) -> None:
    server.path.write_text(content, encoding="utf-8")
    with pytest.raises(LiveError, match=r"court\.port is damaged"):
        Client(server.path)


@pytest.mark.slow
def test_the_file_of_a_killed_process_is_recognised_and_removed(
    court: simkit.Simulation, sockets: Path, tmp_path: Path
) -> None:
    process = subprocess.Popen([sys.executable, "-c", SERVER, WORLD], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert process.stdout is not None and process.stdin is not None
    path = Path(process.stdout.readline().decode().strip())
    assert path == sockets / "court.port"
    assert find_socket() == path
    assert [(found.name, found.pid) for found in simulations()] == [("court", process.pid)]
    process.kill()
    process.communicate()
    assert path.exists() and not socket_files.is_living(path)
    assert simulations() == []
    with pytest.raises(LiveError, match="SK-LIVE-001"):
        find_socket("court")
    with pytest.raises(LiveError, match="'court' cannot be reached: Connection refused"):
        Client(path)
    with Server(court) as server:
        assert server.path == path, "the name is free again"


def test_both_kinds_of_sockets_share_their_names(
    court: simkit.Simulation, monkeypatch: pytest.MonkeyPatch, sockets: Path
) -> None:
    with Server(court) as first:
        monkeypatch.setenv("SIMKIT_LOCAL_SOCKETS", "unix")
        with Server(court) as second:
            assert [first.path.name, second.path.name] == ["court.port", "court_2.sock"]
            assert [found.name for found in simulations()] == ["court", "court_2"]
            assert find_socket("court_2") == second.path
    assert sorted(path.name for path in sockets.iterdir()) == [".lock"]

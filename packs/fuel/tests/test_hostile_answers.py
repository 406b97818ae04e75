"""`simkit fetch` and answers that a proper server never sends: one error with a code, in time, and no traceback."""

from __future__ import annotations

import gzip
import itertools
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from packs.fuel.tests.fuel_server import Fuel, archive, model, run, served, write_world
from tests.limited_memory import run_limited

Answer = Callable[[socket.socket, bytes, int], None]
WHOLE = model(**{"data.bin": bytes(range(256)) * 400})
HEAD = b"HTTP/1.1 200 OK\r\n"


@contextmanager
def answering(answer: Answer) -> Iterator[str]:
    """Run a server that gives each connection, its request and its number to a function."""
    listener = socket.create_server(("127.0.0.1", 0))
    numbers = itertools.count()

    def serve(connection: socket.socket) -> None:
        with connection, suppress(OSError):
            request = b""
            while b"\r\n\r\n" not in request:
                request += connection.recv(65536)
            answer(connection, request, next(numbers))

    def accept() -> None:
        with suppress(OSError):
            while True:
                threading.Thread(target=serve, args=(listener.accept()[0],), daemon=True).start()

    threading.Thread(target=accept, daemon=True).start()
    yield f"http://127.0.0.1:{listener.getsockname()[1]}"
    listener.close()


def drip(connection: socket.socket, piece: bytes) -> None:
    """Send a piece again and again, with pauses that a time limit for each call would accept."""
    while True:
        connection.sendall(piece)
        time.sleep(0.05)


def flood(connection: socket.socket, piece: bytes) -> None:
    while True:
        connection.sendall(piece * 1000)


def part(first: int, total: int, more: bytes = b"") -> bytes:
    return b"HTTP/1.1 206 P\r\nContent-Range: bytes %d-%d/%d\r\n%s" % (first, total - 1, total, more)


def sized(content: bytes, stated: bytes | int) -> bytes:
    size = stated if isinstance(stated, bytes) else b"%d" % stated
    return HEAD + b'ETag: "a"\r\nContent-Length: ' + size + b"\r\n\r\n" + content


ENDLESS: dict[str, Answer] = {
    "header lines that drip": lambda c, _r, _n: (c.sendall(HEAD), drip(c, b"A: b\r\n"))[1],
    "one header that drips": lambda c, _r, _n: (c.sendall(HEAD + b"A: "), drip(c, b"b"))[1],
    "a status line that drips": lambda c, _r, _n: drip(c, b"H"),
    "interim answers that drip": lambda c, _r, _n: drip(c, b"HTTP/1.1 100 Continue\r\n\r\n"),
    "interim answers without end": lambda c, _r, _n: flood(c, b"HTTP/1.1 100 Continue\r\n\r\n"),
    "headers without end": lambda c, _r, _n: (c.sendall(HEAD), flood(c, b"A: b\r\n"))[1],
    "one header without end": lambda c, _r, _n: (c.sendall(HEAD + b"A: "), flood(c, b"b"))[1],
    "a content that drips": lambda c, _r, _n: (c.sendall(sized(b"", 10**6)), drip(c, b"x"))[1],
    "a content of one kB in each limit": lambda c, _r, _n: (c.sendall(sized(b"", 10**6)), drip(c, b"x" * 1024))[1],
    "a chunk size that drips": lambda c, _r, _n: (
        c.sendall(HEAD + b"Transfer-Encoding: chunked\r\n\r\n1;"),
        drip(c, b"x"),
    )[1],
    "trailers that drip": lambda c, _r, _n: (
        c.sendall(HEAD + b"Transfer-Encoding: chunked\r\n\r\n1\r\nx\r\n0\r\n"),
        drip(c, b"A: b\r\n"),
    )[1],
    "a redirect whose page drips": lambda c, _r, _n: (
        c.sendall(b"HTTP/1.1 302 F\r\nLocation: /1.0/o/models/a\r\n\r\n"),
        drip(c, b"x"),
    )[1],
    "a redirect whose page has no end": lambda c, _r, _n: (
        c.sendall(b"HTTP/1.1 302 F\r\nLocation: /1.0/o/models/a\r\n\r\n"),
        flood(c, b"x"),
    )[1],
    "silence": lambda c, _r, _n: time.sleep(20),
    "slow redirects": lambda c, _r, n: (
        time.sleep(0.25),
        c.sendall(b"HTTP/1.1 302 F\r\nLocation: /1.0/o/models/a%d\r\nContent-Length: 0\r\n\r\n" % n),
    )[1],
}


@pytest.mark.parametrize("name", ENDLESS)
def test_a_time_limit_covers_the_whole_request(fuel: object, name: str) -> None:
    with answering(ENDLESS[name]) as server:
        begun = time.monotonic()
        result = run("fetch", f"{server}/1.0/o/models/box", "--timeout", "0.6")
        took = time.monotonic() - begun
    assert result.exit_code == 1 and result.output.count("SK-FETCH-006") == 1, result.output
    assert took < 60, "the pauses of the server have no end"


WRONG: dict[str, tuple[Answer, int, str]] = {
    "a part that nobody asked for": (lambda c, _r, _n: c.sendall(part(0, 9) + b"\r\n123456789"), 1, "sends a part"),
    "a negative size": (lambda c, _r, _n: c.sendall(sized(WHOLE, b"-5")), 1, "states the size '-5'"),
    "a size of 400 digits": (lambda c, _r, _n: c.sendall(sized(WHOLE, b"9" * 400)), 1, "states the size"),
    "a size of 5000 digits": (lambda c, _r, _n: c.sendall(sized(WHOLE, b"9" * 5000)), 1, "states the size"),
    "a size that is too large": (lambda c, _r, _n: c.sendall(sized(WHOLE, len(WHOLE) + 9)), 1, "SK-FETCH-006"),
    "a size that is too small": (lambda c, _r, _n: c.sendall(sized(WHOLE, 100)), 2, "SK-FETCH-004"),
    "416 to each resumed part": (
        lambda c, r, _n: c.sendall(
            b"HTTP/1.1 416 R\r\nContent-Length: 0\r\n\r\n" if b"\r\nRange:" in r else sized(WHOLE[:999], len(WHOLE))
        ),
        1,
        "HTTP 416",
    ),
    "416 without a range": (lambda c, _r, _n: c.sendall(b"HTTP/1.1 416 R\r\n\r\n"), 1, "HTTP 416"),
    "a header of 100 kB": (lambda c, _r, _n: c.sendall(HEAD + b"A: " + b"b" * 100_000 + b"\r\n\r\n"), 1, "header"),
    "a status of words": (lambda c, _r, _n: c.sendall(b"HTTP/1.1 two hundred\r\n\r\n"), 1, "SK-FETCH-006"),
    "another protocol": (lambda c, _r, _n: c.sendall(b"SSH-2.0-x\r\n\r\n"), 1, "SK-FETCH-006"),
    "a redirect to nowhere": (
        lambda c, _r, _n: c.sendall(b"HTTP/1.1 302 F\r\nLocation: http://[::1\r\n\r\n"),
        1,
        "SK-FETCH-006",
    ),
    "redirects in a circle": (
        lambda c, _r, _n: c.sendall(b"HTTP/1.1 302 F\r\nLocation: /x\r\nContent-Length: 0\r\n\r\n"),
        2,
        "HTTP 302",
    ),
    "redirects without end": (
        lambda c, _r, n: c.sendall(b"HTTP/1.1 302 F\r\nLocation: /%d\r\nContent-Length: 0\r\n\r\n" % n),
        2,
        "HTTP 302",
    ),
    "a compressed answer": (
        lambda c, _r, _n: c.sendall(HEAD + b"Content-Encoding: gzip\r\n\r\n" + gzip.compress(bytes(10**8))),
        2,
        "SK-FETCH-004",
    ),
    "3 MB of trailers": (
        lambda c, _r, _n: c.sendall(
            HEAD + b"Transfer-Encoding: chunked\r\n\r\n1\r\nx\r\n0\r\n" + b"A: b\r\n" * 500_000 + b"\r\n"
        ),
        2,
        "SK-FETCH-004",
    ),
    "a chunk of negative size": (
        lambda c, _r, _n: c.sendall(HEAD + b"Transfer-Encoding: chunked\r\n\r\n-5\r\nabc\r\n"),
        1,
        "SK-FETCH-006",
    ),
    "a chunk of 400 digits": (
        lambda c, _r, _n: c.sendall(HEAD + b"Transfer-Encoding: chunked\r\n\r\n" + b"f" * 400 + b"\r\nabc\r\n"),
        1,
        "SK-FETCH-006",
    ),
    "a chunk without a size": (
        lambda c, _r, _n: c.sendall(HEAD + b"Transfer-Encoding: chunked\r\n\r\nzz\r\nabc\r\n"),
        1,
        "SK-FETCH-006",
    ),
    "an end after each byte": (
        lambda c, r, _n: c.sendall(
            part(at := int(r.split(b"bytes=")[1].split(b"-")[0]), len(WHOLE), b'ETag: "a"\r\n\r\n') + WHOLE[at : at + 1]
            if b"\r\nRange:" in r
            else sized(WHOLE[:1], len(WHOLE))
        ),
        1,
        "after 10 bytes",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_answer_is_one_error_with_a_code(fuel: object, name: str) -> None:
    answer, code, text = WRONG[name]
    with answering(answer) as server:
        result = run("fetch", f"{server}/1.0/o/models/box", "--timeout", "5")
    assert result.exit_code == code and text in result.output, result.output
    assert result.output.count("error SK-") == 1 and len(result.output) < 1500


RESUMED: dict[str, Answer] = {
    "that begins elsewhere": lambda c, _r, _n: c.sendall(part(5, len(WHOLE)) + b"\r\n" + WHOLE[5:]),
    "of another size": lambda c, _r, _n: c.sendall(part(1000, 9 * len(WHOLE), b"Content-Length: 9\r\n\r\n123456789")),
    "with another tag": lambda c, _r, _n: c.sendall(
        part(1000, len(WHOLE), b'ETag: "b"\r\n\r\n') + bytes(len(WHOLE) - 1000)
    ),
    "without a range": lambda c, _r, _n: c.sendall(b"HTTP/1.1 206 P\r\n\r\n" + WHOLE[1000:]),
    "with a range of words": lambda c, _r, _n: c.sendall(b"HTTP/1.1 206 P\r\nContent-Range: all\r\n\r\n" + WHOLE),
    "that is refused once": lambda c, _r, _n: c.sendall(b"HTTP/1.1 416 R\r\nContent-Length: 0\r\n\r\n"),
}


@pytest.mark.parametrize("name", RESUMED)
def test_after_a_wrong_part_the_whole_file_is_downloaded_again(fuel: object, name: str) -> None:
    """The server breaks off once, answers wrongly to the resumed part, and then properly."""

    def answer(connection: socket.socket, request: bytes, number: int) -> None:
        if b"\r\nRange:" in request:
            RESUMED[name](connection, request, number)
        else:
            connection.sendall(sized(WHOLE[:1000] if number == 0 else WHOLE, len(WHOLE)))

    with answering(answer) as server:
        result = run("fetch", f"{server}/1.0/o/models/box")
    assert result.exit_code == 0, result.output


def test_an_endless_page_of_a_redirect_takes_no_memory(tmp_path: Path) -> None:
    with answering(ENDLESS["a redirect whose page has no end"]) as server:
        place = {**os.environ, "GZ_FUEL_CACHE_PATH": str(tmp_path / "cache")}
        result = run_limited(["fetch", f"{server}/1.0/o/models/box", "--timeout", "8"], 500, env=place)
    assert result.returncode == 1 and "more than 1 MiB" in result.stderr, result.stderr


@pytest.mark.slow
def test_many_slow_models_end_with_the_time_of_the_run(fuel: object) -> None:
    """Each model comes in time; all together do not."""
    names = "".join(f"<include><uri>SERVER/1.0/o/models/m{i}</uri><name>m{i}</name></include>\n" for i in range(100))

    def answer(connection: socket.socket, _request: bytes, _number: int) -> None:
        time.sleep(0.1)
        connection.sendall(sized(model(), len(model())))

    with answering(answer) as server:
        Path("w.sdf").write_text(f'<sdf version="1.9"><world name="w">{names.replace("SERVER", server)}</world></sdf>')
        begun = time.monotonic()
        result = run("fetch", "w.sdf", "--timeout", "5", "--max-time", "1")
    assert result.exit_code == 1 and "--max-time" in result.output and result.output.count("error SK-") == 1
    assert time.monotonic() - begun < 60
    assert result.output.count("fetched:") > 1, "what was there in time is stored"


def test_a_proxy_that_drips_ends_in_time(fuel: object, monkeypatch: pytest.MonkeyPatch) -> None:
    with answering(lambda c, _r, _n: (c.sendall(HEAD), drip(c, b"A: b\r\n"))[1]) as server:
        monkeypatch.setenv("https_proxy", server)
        monkeypatch.setenv("no_proxy", "")
        begun = time.monotonic()
        result = run("fetch", "https://fuel.example/1.0/o/models/box", "--timeout", "0.6")
    assert result.exit_code == 1 and "timed out" in result.output and time.monotonic() - begun < 60


def test_a_server_that_never_ends_its_handshake_ends_in_time(fuel: object) -> None:
    with answering(lambda c, _r, _n: None) as server:
        begun = time.monotonic()
        result = run("fetch", f"https{server[4:]}/1.0/o/models/box", "--timeout", "0.6")
    assert result.exit_code == 1 and "timed out" in result.output and time.monotonic() - begun < 60


def test_a_download_of_another_process_is_not_waited_for_without_end(fuel: object) -> None:
    with served() as server:
        server.silent.set()
        command = [sys.executable, "-m", "simkit", "fetch", f"{server.url}/1.0/o/models/box", "--timeout", "30"]
        other = subprocess.Popen(command, stderr=subprocess.DEVNULL)
        try:
            end = time.monotonic() + 20
            while not server.requests and time.monotonic() < end:
                time.sleep(0.01)
            result = run("fetch", f"{server.url}/1.0/o/models/box", "--max-time", "0.5")
        finally:
            other.kill()
            other.wait()
    assert result.exit_code == 1 and "another simkit fetch" in result.output, result.output


def including(*uris: str) -> bytes:
    """Return the archive of a model that includes others, outside of its element that a resolver would replace."""
    includes = "".join(f"<include><uri>{uri}</uri><name>n{i}</name></include>" for i, uri in enumerate(uris))
    text = f'<sdf version="1.9"><model name="box"><link name="l"/>{includes}</model></sdf>'
    return archive({"model.config": "<model><name>box</name><sdf>model.sdf</sdf></model>", "model.sdf": text})


def chained(connection: socket.socket, request: bytes, length: int) -> None:
    """Answer with model `m<N>`, which includes model `m<N + 1>`, up to a length of the chain."""
    host = request.split(b"Host: ")[1].split(b"\r\n")[0].decode()
    number = int(request.split(b"/models/m")[1].split(b"/")[0])
    names = [f"http://{host}/1.0/o/models/m{number + 1}"] if number + 1 < length else []
    content = including(*names)
    connection.sendall(sized(content, len(content)))


@pytest.mark.parametrize(("length", "code"), [(33, 0), (34, 2), (1 << 30, 2)])
def test_models_that_name_one_another_end_at_the_depth_that_can_be_loaded(fuel: object, length: int, code: int) -> None:
    with answering(lambda c, r, _n: chained(c, r, length)) as server:
        result = run("fetch", f"{server}/1.0/o/models/m0")
    assert result.exit_code == code, result.output
    assert result.output.count("nested deeper than 32") == (1 if code else 0)


def test_the_models_of_a_world_are_counted_with_those_that_fail(fuel: Fuel, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("simkit_fuel.fetch._MOST_RESOURCES", 5)
    write_world(*(f"{fuel.url}/1.0/o/models/m{i}" for i in range(5)))
    assert "more than 5 resources" not in run("fetch", "w.sdf").output
    write_world(*(f"{fuel.url}/1.0/o/models/m{i}" for i in range(20)))
    fuel.requests.clear()
    result = run("fetch", "w.sdf")
    assert result.output.count("more than 5 resources") == 1 and len(fuel.requests) == 5


def test_a_model_that_names_a_million_resources_is_read_up_to_the_limit(
    fuel: Fuel, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("simkit_fuel.fetch._MOST_REFERENCES", 50)
    fuel.archives["o/models/box"] = [including(*([f"{fuel.url}/1.0/o/models/box"] * 49))]
    assert run("fetch", f"{fuel.url}/1.0/o/models/box").exit_code == 0
    fuel.archives["o/models/big"] = [including(*([f"{fuel.url}/1.0/o/models/big"] * 50))]
    result = run("fetch", f"{fuel.url}/1.0/o/models/big")
    assert result.exit_code == 2 and result.output.count("more than 50 places") == 1, result.output

"""`simkit fetch` and servers that fail or are not to be trusted: a code, nothing in the cache, no endless waiting."""

from __future__ import annotations

import stat
import struct
import time
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

import simkit
from packs.fuel.tests.fuel_server import BOX, Fuel, archive, model, run, served, write_world


def link(name: str, target: bytes) -> tuple[zipfile.ZipInfo, bytes]:
    info = zipfile.ZipInfo(name)
    info.external_attr = (stat.S_IFLNK | 0o777) << 16
    return info, target


def with_wrong_size(content: bytes, size: int) -> bytes:
    """Return an archive whose list says another unpacked size of the first file."""
    at = content.rindex(b"PK\1\2", 0, content.index(b"PK\1\2") + 4)
    return content[: at + 24] + struct.pack("<L", size) + content[at + 28 :]


def stored(fuel: Fuel) -> list[Path]:
    """Return the files in the cache, apart from unfinished downloads."""
    return [p for p in Path("cache").rglob("*") if p.is_file() and ".simkit-fetch" not in p.parts]


UNSAFE: dict[str, tuple[Callable[[], bytes], str]] = {
    "slip": (lambda: archive({"model.sdf": BOX, "../../outside.txt": "x"}), "leads out of its folder"),
    "absolute": (lambda: archive({"/tmp/out.txt": "x"}), "is an absolute path"),
    "backslash": (lambda: archive({"a\\b.txt": "x"}), "characters that are not allowed"),
    "folder": (lambda: archive({"../../outside/": ""}), "leads out of its folder"),
    "link": (lambda: archive({"model.sdf": BOX, "out": link("out", b"/etc")}), "is a link"),
    "bomb": (lambda: archive({"zeros": bytes(80 << 20)}), "more than 200 times its size"),
    "hidden bomb": (lambda: with_wrong_size(archive({"zeros": bytes(80 << 20)}), 100), "it is damaged"),
    "duplicate": (lambda: archive({"A.sdf": "x", "a.sdf": "y"}), "is a duplicate"),
    "both": (lambda: archive({"a": "x", "a/b": "y"}), "is both a file and a folder"),
    "truncated": (lambda: model()[:200], "not a ZIP archive"),
    "damaged": (lambda: model().replace(b"model.sdf", b"m0del.sdf", 1), "it is damaged"),
    "page": (lambda: b"<html>login</html>", "not a ZIP archive"),
    "empty": (lambda: b"", "not a ZIP archive"),
}


@pytest.mark.parametrize("name", UNSAFE)
def test_a_dangerous_archive_is_refused_and_nothing_is_stored(fuel: Fuel, name: str) -> None:
    fuel.archives["o/models/box"], reason = [UNSAFE[name][0]()], UNSAFE[name][1]
    fuel.archives["o/models/good"] = [model()]
    write_world(f"{fuel.url}/1.0/o/models/box", f"{fuel.url}/1.0/o/models/good")
    result = run("fetch", "w.sdf")
    assert result.exit_code == 2
    assert "w.sdf:2: error SK-FETCH-004" in result.output and reason in result.output, result.output
    assert {p.relative_to("cache").parts[3] for p in stored(fuel)} == {"good"}
    assert (
        not list(Path("cache/.simkit-fetch").iterdir())
        and not list(Path.cwd().rglob("outside*"))
        and not Path("../outside").exists()
    )


def test_a_broken_download_continues_in_the_same_run(fuel: Fuel) -> None:
    content = model(**{"data.bin": bytes(range(256)) * 40})
    fuel.archives["o/models/box"], fuel.breaks = [content], [100, 60]
    write_world(f"{fuel.url}/1.0/o/models/box")
    result = run("fetch", "w.sdf")
    assert result.exit_code == 0, result.output
    assert fuel.downloads() == ["box tip", "box tip 100-", "box tip 160-"]
    assert not [d for d in simkit.check("w.sdf") if d.severity != "note"]


def test_a_broken_download_continues_in_a_later_run(fuel: Fuel) -> None:
    fuel.archives["o/models/box"], fuel.breaks = [model()], [100, 0]
    write_world(f"{fuel.url}/1.0/o/models/box")
    result = run("fetch", "w.sdf")
    assert result.exit_code == 1 and "SK-FETCH-006" in result.output and "after 100 bytes" in result.output
    assert not stored(fuel) and not Path("simkit.lock").exists()
    assert run("fetch", "w.sdf").exit_code == 0
    assert fuel.downloads()[-1] == "box tip 100-"
    assert not list(Path("cache/.simkit-fetch").iterdir())


def test_the_beginning_of_an_older_version_is_not_used(fuel: Fuel) -> None:
    fuel.archives["o/models/box"], fuel.breaks = [model("<!-- old -->")], [100, 0]
    write_world(f"{fuel.url}/1.0/o/models/box")
    assert run("fetch", "w.sdf").exit_code == 1
    fuel.archives["o/models/box"].append(model())
    assert run("fetch", "w.sdf").exit_code == 0
    assert (Path("cache", f"127.0.0.1:{fuel.port}", "o/models/box/2") / "model.sdf").read_text() == BOX.format("")


def test_a_server_that_ignores_ranges_sends_everything_again(fuel: Fuel) -> None:
    fuel.archives["o/models/box"], fuel.breaks = [model()], [100]
    fuel.ignores_ranges = True
    write_world(f"{fuel.url}/1.0/o/models/box")
    assert run("fetch", "w.sdf").exit_code == 0
    assert len(fuel.requests) == 2


def test_a_redirect_to_another_server_is_refused(fuel: Fuel) -> None:
    write_world(f"{fuel.url}/1.0/o/models/box")
    with served() as other:
        other.archives["o/models/box"] = [model()]
        fuel.redirect = other.url
        result = run("fetch", "w.sdf")
        assert result.exit_code == 2 and "SK-FETCH-002" in result.output and other.url in result.output
        assert not other.requests


def test_a_redirect_on_the_same_server_is_followed(fuel: Fuel) -> None:
    fuel.archives["o/models/new"] = [model()]
    fuel.redirect = f"{fuel.url}/1.0/o/models/new/1/new.zip"
    write_world(f"{fuel.url}/1.0/o/models/box")
    assert run("fetch", "w.sdf").exit_code == 0


def test_a_connection_without_encryption_to_another_computer_needs_consent(fuel: Fuel) -> None:
    write_world("http://192.0.2.1/1.0/o/models/box")
    result = run("fetch", "w.sdf")
    assert result.exit_code == 2 and "SK-FETCH-002" in result.output and "--allow-http" in result.output
    assert run("fetch", "w.sdf", "--server", "http://192.0.2.1").exit_code == 2


@pytest.mark.parametrize("text", ["fuel", "ftp://a", "http://", "http://a:x", "https://user@host", "https://a?b"])
def test_an_invalid_server_is_a_usage_error(fuel: Fuel, text: str) -> None:
    write_world(f"{fuel.url}/1.0/o/models/box")
    result = run("fetch", "w.sdf", "--server", text)
    assert result.exit_code == 2 and "SK-CLI-018 --server" in result.output


def test_a_huge_size_is_refused_before_it_is_downloaded(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model()]
    fuel.headers["Content-Length"] = str(1 << 50)
    write_world(f"{fuel.url}/1.0/o/models/box")
    result = run("fetch", "w.sdf")
    assert result.exit_code == 2 and "SK-FETCH-003" in result.output and "--max-size" in result.output
    assert not list(Path("cache").rglob("*.part"))


def test_a_server_that_tells_no_size_cannot_pass_the_limit(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model(**{"a.bin": bytes(range(256)) * 4000})]
    fuel.headers["Content-Length"] = None
    write_world(f"{fuel.url}/1.0/o/models/box")
    assert run("fetch", "w.sdf", "--max-size", "0.001").exit_code == 2
    assert not stored(fuel)
    assert run("fetch", "w.sdf").exit_code == 0


def test_the_sum_of_all_archives_is_limited(fuel: Fuel) -> None:
    for name in ("a", "b"):
        fuel.archives[f"o/models/{name}"] = [model()]
    write_world(f"{fuel.url}/1.0/o/models/a", f"{fuel.url}/1.0/o/models/b")
    result = run("fetch", "w.sdf", "--max-total", str(1.5e-6 * len(model())))
    assert result.exit_code == 2 and "w.sdf:3: error SK-FETCH-003" in result.output


def test_a_silent_server_ends_with_a_time_out(fuel: Fuel) -> None:
    fuel.silent.set()
    write_world(f"{fuel.url}/1.0/o/models/a", f"{fuel.url}/1.0/o/models/b")
    begun = time.perf_counter()
    result = run("fetch", "w.sdf", "--timeout", "0.2")
    assert result.exit_code == 1 and "timed out" in result.output
    assert time.perf_counter() - begun < 60 and len(fuel.requests) == 1, "a silent server is asked once"


@pytest.mark.parametrize(("status", "code"), [(500, 1), (503, 1), (403, 2), (401, 2), (410, 2)])
def test_an_error_of_the_server_has_a_code(fuel: Fuel, status: int, code: int) -> None:
    fuel.status = status
    write_world(f"{fuel.url}/1.0/o/models/box")
    result = run("fetch", "w.sdf")
    assert result.exit_code == code and f"HTTP {status}" in result.output


def test_a_cache_that_cannot_be_written_is_an_error(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model()]
    Path("cache").write_text("a file")
    write_world(f"{fuel.url}/1.0/o/models/box")
    result = run("fetch", "w.sdf")
    assert result.exit_code == 2 and "SK-CLI-016" in result.output


def secret_robot(fuel: Fuel, content: str, model_name: str) -> str:
    """Return a xacro file whose mesh has a URL of the server; `content` is before it, and NAME means the variable."""
    mesh = f'<mesh filename="{fuel.url}/1.0/o/models/{model_name}/1/files/a.stl"/>'
    link = f'<link name="m"><visual><geometry>{mesh}</geometry></visual></link>'
    text = content.replace("{}", link) if "{}" in content else content + link
    xmlns = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    return f'<robot name="r" {xmlns}><link name="l"/>\n{text}</robot>'.replace("NAME", "SIMKIT_TEST_SECRET")


SECRET_URLS = {
    "whole": ("", "$(env NAME)"),
    "optional": ("", "$(optenv NAME none)"),
    "function": ("", "${env('NAME')}"),
    "function with a default": ("", "${optenv('NAME', 'x')}"),
    "one letter": ("", "${env('NAME')[2]}"),
    "other letters": ("", "${env('NAME').upper()}"),
    "condition": ("""<xacro:if value="${env('NAME')[0] == 't'}">{}</xacro:if>""", "a"),
    "argument": ('<xacro:arg name="a" default="$(env NAME)"/>', "$(arg a)"),
}


@pytest.mark.parametrize("name", SECRET_URLS)
def test_no_request_contains_an_environment_variable(fuel: Fuel, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SIMKIT_TEST_SECRET", "token123")
    Path("r.xacro").write_text(secret_robot(fuel, *SECRET_URLS[name]))
    for options in ((), ("--dry-run",), ("--server", fuel.url)):
        result = run("fetch", "r.xacro", *options)
        assert result.exit_code == 2 and "r.xacro:2: error SK-FETCH-010" in result.output, result.output
        assert "SIMKIT_TEST_SECRET" in result.output and "help: " in result.output
    assert not fuel.requests, "the request could contain the value"


def test_a_variable_that_is_not_set_or_that_of_ros_is_no_secret(fuel: Fuel, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SIMKIT_TEST_SECRET", raising=False)
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    fuel.archives["o/models/jazzy_box"] = [model(**{"a.stl": "x"})]
    Path("r.xacro").write_text(secret_robot(fuel, "", "$(env ROS_DISTRO)_$(optenv NAME box)"))
    result = run("fetch", "r.xacro")
    assert result.exit_code == 0 and len(fuel.requests) == 1, result.output

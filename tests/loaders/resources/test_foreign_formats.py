"""Files of another format: the message names their likely format."""

from __future__ import annotations

import gzip
from pathlib import Path

import pytest

import simkit
from simkit.diagnostics import Diagnostics
from simkit.loaders.resources.xml_reader import parse_file

SCENARIO = "a scenario; simkit golden record runs it with its checks"
LFS = "a pointer of Git LFS; the content was not fetched (git lfs pull)"


def refused(path: Path) -> simkit.Diagnostic:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.describe(path)
    (found,) = caught.value.diagnostics
    return found


@pytest.mark.parametrize(
    ("content", "likely_format"),
    [
        (b"", "an empty file"),
        (b" \n\t", "an empty file"),
        (b"\xef\xbb\xbf", "an empty file"),
        (gzip.compress(b"<sdf/>", mtime=0), "a gzip file; unpack it first"),
        (b"PK\x03\x04rest", "a zip archive; unpack it first"),
        (b"\x89PNG\r\n", "a PNG picture"),
        (b"solid part\nfacet normal 0 0 1", "an STL mesh"),
        (b"\x01" * 80 + (1).to_bytes(4, "little") + b"\x00" * 50, "an STL mesh"),
        (b"# by hand\nv 0 0 0\nv 1 0 0\n", "an OBJ mesh"),
        (b"glTF\x02\0\0\0", "a glTF mesh"),
        (b'{"models": []}', "JSON"),
        (b"\x7fELF\x02", "a program"),
        (b"\x89MCAP0\r\n", "an MCAP recording"),
        (b"abc\0def", "a binary file"),
        (b"world:\n  models: []\n", "a text without any element"),
        (b"# a run\nworld: hall\nlimits: [time < 3]\n", SCENARIO),
        (b"# Read me\n\nUse <tag>.\n", "a text that begins with '# Read me'"),
        (b"version https://git-lfs.github.com/spec/v1\n", LFS),
    ],
)  # fmt: skip
def test_an_error_about_another_format_names_this_format(tmp_path: Path, content: bytes, likely_format: str) -> None:
    path = tmp_path / "world.sdf"
    path.write_bytes(content)
    found = refused(path)
    assert (found.code, found.file) == ("SK-XML-005", str(path))
    assert found.message == f"this is not XML; it looks like {likely_format}"
    assert "<sdf>, <robot> (URDF, xacro) or <mujoco> (MJCF)" in found.hint


@pytest.mark.parametrize(
    ("content", "hint"),
    [
        ("<COLLADA/>", "a mesh (COLLADA); name it in the <uri> of a <mesh>"),
        ("<world name='w'/>", "a world without the <sdf> around it; put <sdf version='1.9'> around it"),
        ("<launch/>", "a ROS launch file; run it with `simkit launch FILE`"),
        ("<robto/>", "did you mean 'robot'?"),
    ],
)
def test_an_error_about_xml_of_another_format_names_this_format(tmp_path: Path, content: str, hint: str) -> None:
    path = tmp_path / "world.sdf"
    path.write_text(content)
    found = refused(path)
    assert (found.code, found.hint) == ("SK-LOAD-003", hint)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_xml_is_read_in_all_supported_encodings(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "world.sdf"
    path.write_bytes("<sdf version='1.9'><world name='Ä'/></sdf>".encode(encoding))
    diagnostics = Diagnostics()
    document = parse_file(path, diagnostics)
    assert list(diagnostics) == []
    assert document is not None
    assert document.root.children[0].attribute("name") == "Ä"

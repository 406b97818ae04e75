"""A `file://` URI names the same file on systems with drives."""

from __future__ import annotations

import pytest

from simkit.loaders.resources.uris import path_of_file_uri


@pytest.mark.parametrize(
    ("rest", "path"),
    [
        ("/C:/worlds/a.sdf", "C:/worlds/a.sdf"),
        ("C:/worlds/a.sdf", "C:/worlds/a.sdf"),
        ("meshes/a.stl", "meshes/a.stl"),
        ("/srv/a.sdf", "/srv/a.sdf"),
        ("", ""),
    ],
)
def test_a_drive_follows_a_slash(rest: str, path: str) -> None:
    assert path_of_file_uri(rest, has_drives=True) == path


def test_on_posix_a_colon_is_a_letter_like_others() -> None:
    assert path_of_file_uri("/C:/worlds/a.sdf", has_drives=False) == "/C:/worlds/a.sdf"

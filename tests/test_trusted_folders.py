"""Join of a trusted folder with an untrusted text, and the check of symbolic links."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from urllib.parse import quote

import pytest

from simkit.trusted_folders import OutsideError, TrustedFolders, built_workspace, join_below

ROOT = Path("/trusted/model")


@pytest.mark.parametrize(
    ("text", "below"),
    [
        ("meshes/a.stl", "meshes/a.stl"),
        ("meshes//a.stl", "meshes/a.stl"),
        ("./meshes/./a.stl", "meshes/a.stl"),
        ("meshes/../a.stl", "a.stl"),
        ("meshes/", "meshes"),
        ("", "."),
        (".", "."),
        ("~/a.stl", "~/a.stl"),
        ("~root/a.stl", "~root/a.stl"),
        ("...", "..."),
        ("..a/b..", "..a/b.."),
        ("100%.png", "100%.png"),
        ("my%20mesh.stl", "my%20mesh.stl"),
        ("a%2Fb.stl", "a%2Fb.stl"),
        ("a\\b.stl", "a\\b.stl"),
        ("C:/a.stl", "C:/a.stl"),
        ("$HOME/a", "$HOME/a"),
        ("\uff0e\uff0e/\u2215home", "\uff0e\uff0e/\u2215home"),
    ],
)
def test_a_relative_text_is_joined_as_it_is_written(text: str, below: str) -> None:
    assert join_below(ROOT, text, is_windows=False) == ROOT / below


@pytest.mark.parametrize(
    "text",
    ["/etc/x", "//etc/x", "/", "..", "../x", "a/../../x", "./../x", "a/b/../../../model/x", "..//x", "a\0b", "\0"],
)
@pytest.mark.parametrize("times", [0, 1, 2, 3, 20])
@pytest.mark.parametrize("is_windows", [False, True])
def test_no_spelling_of_an_absolute_or_climbing_path_is_accepted(text: str, times: int, is_windows: bool) -> None:
    for _ in range(times):
        text = "".join(f"%{ord(char):02x}" if char in "/.\0\\" else char for char in quote(text, safe="/.\0\\"))
    with pytest.raises(OutsideError) as caught:
        join_below(ROOT, text, is_windows=is_windows)
    assert caught.value.code == "SK-URI-003"
    assert caught.value.exit_code == 2


@pytest.mark.parametrize("text", ["//meshes/a.stl", "/meshes//a.stl", "///meshes/./a.stl", "/a/../meshes/%2E/a.stl"])
def test_slashes_at_the_start_of_the_rest_of_a_uri_are_dropped(text: str) -> None:
    assert ROOT in join_below(ROOT, text, in_uri=True, is_windows=False).parents


@pytest.mark.parametrize("text", ["..", "//../x", "/..", "/a/../../x", "%2e%2e/x", "/%252e%252e%252Fx", "a\0"])
def test_the_rest_of_a_uri_cannot_climb(text: str) -> None:
    with pytest.raises(OutsideError):
        join_below(ROOT, text, in_uri=True)


@pytest.mark.parametrize(
    "text",
    [
        "C:/x", "c:x", "C:", "C:\\x", "\\\\server\\share\\x", "\\x", "..\\x", "a\\..\\..\\x", "%5Cx", "%5c%5cserver/x",
        "C%3A/x", "/C:/x", "a/b:stream", "a.stl::$DATA", ".. /x", "a/... /.. /../x", "..%5Cx",
    ],
)  # fmt: skip
@pytest.mark.parametrize("in_uri", [False, True])
def test_no_spelling_of_windows_leaves_the_folder(text: str, in_uri: bool) -> None:
    if in_uri and text.replace("%5C", "\\").replace("%5c", "\\").startswith("\\"):
        assert ROOT in join_below(ROOT, text, in_uri=True, is_windows=True).parents
        return
    with pytest.raises(OutsideError):
        join_below(ROOT, text, in_uri=in_uri, is_windows=True)


def test_a_text_that_no_file_can_have_is_refused_at_once() -> None:
    for text in ("%25" * 2_000_000, "a" * 5000, "%" + "25" * 2_000_000 + "2F"):
        with pytest.raises(OutsideError):
            join_below(ROOT, text)
    assert join_below(ROOT, "a" * 4096).name == "a" * 4096
    assert join_below(ROOT, "%" + "25" * 2000).parent == ROOT


def test_the_module_needs_no_slow_import() -> None:
    program = "import sys, simkit.trusted_folders; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert not {"numpy", "mujoco", "yaml"} & set(done.stdout.split())


# ---------------------------------------------------------------------- links


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """Return a folder with a project, a second folder of the user and a private folder."""
    for name in ("project/meshes", "assets/meshes", "private", "projectile"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "a.stl").write_text("a")
    return tmp_path


def link(path: Path, target: Path | str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.symlink_to(target)
    return path


def test_a_file_in_a_trusted_folder_is_allowed_and_no_other_file(tree: Path) -> None:
    folders = TrustedFolders([tree / "project"])
    assert folders.allows(tree / "project")
    assert folders.allows(tree / "project/meshes/a.stl")
    assert folders.allows(tree / "project/missing/a.stl")
    assert folders.allows(tree / "project/meshes/../../project/a.stl")
    assert not folders.allows(tree / "private/a.stl")
    assert not folders.allows(tree / "projectile/a.stl")
    assert not folders.allows(tree / "project/../private/a.stl")
    assert not folders.allows(tree / "project/a\0")


def test_a_link_may_lead_to_any_trusted_folder(tree: Path) -> None:
    inside = link(tree / "project/inside.stl", "meshes/a.stl")
    across = link(tree / "project/across.stl", tree / "assets/meshes/a.stl")
    folder = link(tree / "project/folder", tree / "assets/meshes")
    back = link(tree / "private/back", tree / "project")
    assert TrustedFolders([tree / "project"]).allows(inside)
    assert TrustedFolders([tree / "project"]).allows(back / "meshes/a.stl")
    folders = TrustedFolders([tree / "project", tree / "assets"])
    assert folders.allows(across)
    assert folders.allows(folder / "a.stl")


def test_a_link_that_leaves_the_trusted_folders_is_refused_with_the_option_that_allows_it(tree: Path) -> None:
    file = link(tree / "project/file.stl", tree / "private/a.stl")
    relative = link(tree / "project/meshes/relative.stl", "../../private/a.stl")
    folder = link(tree / "project/folder", tree / "private")
    chain = link(tree / "project/chain.stl", "folder/a.stl")
    climbing = folder / ".." / "private" / "a.stl"
    dangling = link(tree / "project/dangling.stl", tree / "private/later.stl")
    folders = TrustedFolders([tree / "project"])
    for path in (file, relative, folder, folder / "a.stl", chain, climbing, dangling):
        assert not folders.allows(path), path
    assert str(tree / "private/a.stl") in folders.refusal(file)
    assert folders.help(file) == folders.help(folder) == f"to allow it, use --resource-path {tree / 'private'}"
    folders.add(tree / "private")
    assert folders.allows(file)


def test_loops_and_endless_chains_of_links_end(tree: Path) -> None:
    loop = link(tree / "project/loop", "loop")
    link(tree / "project/one", "two")
    two = link(tree / "project/two", "one")
    outside = link(tree / "project/outside", tree / "private/loop")
    link(tree / "private/loop", tree / "private/loop")
    for number in range(3000):
        link(tree / f"project/chain/{number}", str(number + 1))
    folders = TrustedFolders([tree / "project"])
    for path in (loop, two, tree / "project/chain/0"):
        assert folders.allows(path) in (True, False)
        with pytest.raises(OSError):
            path.read_bytes()
    assert not folders.allows(outside)


def test_a_trusted_folder_may_be_a_link_be_missing_and_be_the_whole_machine(tree: Path) -> None:
    root = link(tree / "root", tree / "project")
    assert TrustedFolders([root]).allows(root / "a.stl")
    assert TrustedFolders([root]).allows(tree / "project/a.stl")
    assert not TrustedFolders([tree / "missing"]).allows(tree / "private/a.stl")
    assert TrustedFolders([tree / "missing"]).allows(tree / "missing/a.stl")
    assert TrustedFolders([Path("/")]).allows(tree / "private/a.stl")
    assert not TrustedFolders([]).allows(tree / "private/a.stl")


@pytest.mark.parametrize("manifest", ["model.config", "package.xml"])
def test_a_link_of_the_user_to_a_package_makes_it_a_trusted_folder(tree: Path, manifest: str) -> None:
    """People link packages into the folder `src` of a workspace."""
    (tree / "dev/robot/meshes").mkdir(parents=True)
    (tree / f"dev/robot/{manifest}").touch()
    linked = link(tree / "ws/src/robot", tree / "dev/robot")
    deeper = link(tree / "ws/src/group/other", tree / "dev/robot")
    plain = link(tree / "ws/src/plain", tree / "private")
    of_author = link(tree / "ws/src/foreign/robot", tree / "dev/robot")
    folders = TrustedFolders([], search_paths=[tree / "ws"])
    for path in (linked / "meshes", deeper, of_author, tree / "dev/robot/meshes"):
        assert folders.allows(path), path
    assert not folders.allows(plain / "a.stl")
    assert not folders.allows(tree / "dev")
    assert not TrustedFolders([tree / "ws"]).allows(linked / "meshes")


def test_a_link_inside_a_package_does_not_make_its_target_a_trusted_folder(tree: Path) -> None:
    (tree / "dev").mkdir()
    (tree / "dev/package.xml").touch()
    (tree / "ws/foreign").mkdir(parents=True)
    (tree / "ws/foreign/package.xml").touch()
    inside = link(tree / "ws/foreign/robot", tree / "dev")
    (tree / "ws/cloned/.git").mkdir(parents=True)
    cloned = link(tree / "ws/cloned/robot", tree / "dev")
    folders = TrustedFolders([], search_paths=[tree / "ws"])
    assert not folders.allows(inside / "a.stl")
    assert not folders.allows(cloned / "a.stl")


def test_a_link_to_the_home_folder_does_not_make_it_a_trusted_folder(
    tree: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tree / "private/package.xml").touch()
    home = link(tree / "ws/src/home", tree / "private")
    monkeypatch.setenv("HOME", str(tree / "private"))
    assert not TrustedFolders([], search_paths=[tree / "ws"]).allows(home / "a.stl")


def test_an_installed_folder_has_the_sources_and_the_build_of_its_workspace(tree: Path) -> None:
    share = tree / "ws/install/robot/share/robot"
    for folder in (share, tree / "ws/src/robot", tree / "ws/build/robot"):
        folder.mkdir(parents=True)
    (tree / "ws/src/robot/r.urdf").touch()
    installed = link(share / "r.urdf", tree / "ws/src/robot/r.urdf")
    private = link(share / "private.stl", tree / "private/a.stl")
    folders = TrustedFolders(built_workspace(share))
    assert folders.allows(installed)
    assert not folders.allows(private)
    assert built_workspace(tree / "project") == []
    link(tree / "foreign/src", tree / "private")
    (tree / "foreign/install/share").mkdir(parents=True)
    assert built_workspace(tree / "foreign/install/share") == [tree / "foreign/install"]
    assert built_workspace(Path("/install/share")) == []


@pytest.mark.skipif(os.name == "nt", reason="needs the right to create links")
def test_the_real_path_of_a_folder_is_looked_up_once(tree: Path) -> None:
    folders = TrustedFolders([tree / "project"])
    looked: list[str] = []
    real_path = os.path.realpath

    def counted(path: str) -> str:
        looked.append(path)
        return real_path(path)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os.path, "realpath", counted)
        for number in range(1000):
            assert folders.allows(tree / f"project/meshes/{number}.stl")
    assert sorted(looked) == [str(tree / "project"), str(tree / "project/meshes")]

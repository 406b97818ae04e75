"""Each file has a licence and a source, the wheel has the notices of its third-party parts, and the lock is public."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGE = "packs/view/simkit_view/view/page"
ASSETS = ("assets", "worlds", "labs", "examples", "simkit", "packs/*/simkit_*", "packs/*/examples")
"""Folders with files that a world can show."""
SUFFIXES = {
    ".bmp",
    ".COF",
    ".config",
    ".css",
    ".dae",
    ".gif",
    ".glb",
    ".gltf",
    ".jpeg",
    ".jpg",
    ".js",
    ".launch",
    ".npz",
    ".obj",
    ".pgm",
    ".png",
    ".sdf",
    ".stl",
    ".svg",
    ".tga",
    ".tif",
    ".urdf",
    ".webp",
    ".woff",
    ".woff2",
    ".world",
    ".xacro",
}


def read_toml(name: str) -> dict[str, Any]:
    return tomllib.loads((ROOT / name).read_text(encoding="utf-8"))


def glob_pattern(glob: str) -> re.Pattern[str]:
    """Return the expression for a path of REUSE.toml: `*` stays in a folder, `**` does not."""
    parts = re.split(r"(\*\*|\*)", glob)
    return re.compile("".join({"**": ".*", "*": "[^/]*"}.get(part) or re.escape(part) for part in parts))


def annotations() -> list[tuple[list[re.Pattern[str]], dict[str, Any]]]:
    found = []
    for entry in read_toml("REUSE.toml")["annotations"]:
        paths = entry["path"] if isinstance(entry["path"], list) else [entry["path"]]
        found.append(([glob_pattern(path) for path in paths], entry))
    return found


def asset_files() -> list[str]:
    paths = {path for glob in ASSETS for folder in ROOT.glob(glob) for path in folder.rglob("*")}
    names = sorted(path.relative_to(ROOT).as_posix() for path in paths if path.suffix in SUFFIXES and path.is_file())
    return [name for name in names if "/node_modules/" not in name]


def test_each_mesh_texture_world_and_robot_has_one_entry_with_licence_and_source() -> None:
    default, *entries = annotations()
    files = asset_files()
    assert len(files) > 250
    by_number = {
        name: [entry for patterns, entry in entries if any(pattern.fullmatch(name) for pattern in patterns)]
        for name in files
    }
    assert not {name: len(found) for name, found in by_number.items() if len(found) != 1}
    assert all(entry["source"] and entry["SPDX-FileCopyrightText"] for (entry,) in by_number.values())
    assert [pattern.pattern for pattern in default[0]] == [".*"]


def test_each_entry_matches_a_file_and_names_a_licence_whose_text_is_there() -> None:
    used = set()
    for entry in read_toml("REUSE.toml")["annotations"]:
        paths = entry["path"] if isinstance(entry["path"], list) else [entry["path"]]
        assert all(any(ROOT.glob(path)) for path in paths), entry
        used |= set(entry["SPDX-License-Identifier"].split(" AND "))
    assert {file.stem for file in (ROOT / "LICENSES").iterdir()} == used
    assert (ROOT / "LICENSES" / "Apache-2.0.txt").read_bytes() == (ROOT / "LICENSE").read_bytes()


def test_package_files_of_robots_name_the_licence_of_their_entry() -> None:
    files = [*ROOT.glob("assets/*/package.xml")]
    assert len(files) >= 3
    for file in files:
        name = file.relative_to(ROOT).as_posix()
        ((entry,),) = [[e for patterns, e in annotations()[1:] if any(p.fullmatch(name) for p in patterns)]]
        found = re.search(r"<license>(.+)</license>", file.read_text(encoding="utf-8"))
        assert found and found[1] == entry["SPDX-License-Identifier"]


def test_the_notices_have_each_library_of_the_page_with_its_version() -> None:
    lock = json.loads((ROOT / "packs/view/view_page/package-lock.json").read_text(encoding="utf-8"))
    libraries = {
        f"{name.removeprefix('node_modules/')} {package['version']} ({package['license']})"
        for name, package in lock["packages"].items()
        if name and not package.get("dev")
    }
    notices = (ROOT / PAGE / "LICENSES.txt").read_text(encoding="utf-8")
    assert set(re.findall(r"^\S+ [\d.]+ \(.+\)$", notices, flags=re.MULTILINE)) == libraries
    assert notices.count("Copyright") == len(libraries)
    licences = {library.rpartition("(")[2].rstrip(")") for library in libraries}
    expression = read_toml("pyproject.toml")["project"]["license"]
    assert set(expression.split(" AND ")) == {"Apache-2.0", *licences}
    (page,) = [entry for entry in read_toml("REUSE.toml")["annotations"] if f"{PAGE}/app.js" in entry["path"]]
    assert page["SPDX-License-Identifier"] == expression


def test_each_package_of_message_definitions_is_a_third_party_part() -> None:
    folders = [*ROOT.glob("simkit/msgs/definitions/*"), *ROOT.glob("packs/*/simkit_*/msgs/definitions/*")]
    packages = {folder.name for folder in folders if folder.is_dir()} - {"simkit_msgs"}
    text = (ROOT / "THIRD_PARTY.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+)` \| \[(.+)\]\(https://github.com/(.+)\) \| (.+) \|$", text, flags=re.MULTILINE)
    assert {row[0] for row in rows} == packages
    repositories = read_toml("tests/msgs/published_interfaces.toml")["repositories"]
    assert all(shown == linked == repositories.get(name, linked) for name, shown, linked, _ in rows)
    definitions = [
        path for folder in folders for path in folder.rglob("*.*") if path.suffix in (".msg", ".srv", ".action")
    ]
    assert len(definitions) > 300
    with_comments = {path.parents[1].name for path in definitions if "#" in path.read_text(encoding="utf-8")}
    assert with_comments == {"roscpp", "turtlesim", "turtlesim_msgs"}  # simkit's own comments


def test_the_lock_has_only_addresses_of_the_public_index() -> None:
    text = (ROOT / "uv.lock").read_text(encoding="utf-8")
    assert set(re.findall(r"\w+://[^/\"]+/", text)) == {"https://pypi.org/", "https://files.pythonhosted.org/"}
    sources = re.findall(r"^source = (.+)$", text, flags=re.MULTILINE)
    assert set(sources) == {'{ registry = "https://pypi.org/simple" }', '{ editable = "." }'}


def test_the_lock_has_the_dependencies_of_the_project() -> None:
    requirements = pytest.importorskip("packaging.requirements")
    lock = read_toml("uv.lock")
    versions: dict[str, list[str]] = {}
    for package in lock["package"]:
        versions.setdefault(package["name"], []).append(package.get("version", ""))
    (ours,) = [package for package in lock["package"] if package["name"] == "simkit-robotics"]
    locked = {(row["name"], row.get("specifier", "")) for row in ours["metadata"]["requires-dist"]}
    project = read_toml("pyproject.toml")["project"]
    texts = [*project["dependencies"], *(text for extra in project["optional-dependencies"].values() for text in extra)]
    for requirement in map(requirements.Requirement, texts):
        name = requirement.name.lower()
        if name == "simkit-robotics":
            continue
        specifiers = [specifier for found, specifier in locked if found == name]
        assert any(requirements.Requirement(name + each).specifier == requirement.specifier for each in specifiers)
        assert all(requirement.specifier.contains(version, prereleases=True) for version in versions[name]), name


@pytest.mark.slow  # builds the wheel
def test_the_wheel_has_its_licences_and_notices(tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", tmp_path], cwd=ROOT, check=True)
    (wheel,) = tmp_path.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    licences = {name.partition(".dist-info/licenses/")[2] for name in names if ".dist-info/licenses/" in name}
    texts = {f"LICENSES/{file.name}" for file in (ROOT / "LICENSES").iterdir()}
    assert licences == {"LICENSE", "THIRD_PARTY.md", f"{PAGE}/LICENSES.txt", *texts}

"""No file outside of the user's folders is opened or printed, whatever a file from a stranger names."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from tests.loaders.resources.hostile_spellings import (
    READERS,
    TOKEN,
    Reader,
    make_project,
    spellings,
    write_job,
)

ROOT = Path(__file__).resolve().parents[3]
TRACER = Path(__file__).with_name("file_tracer.py")
OWN = ("{}/{}", "../{}/{}", "package://mine/{}/{}", "package://mine//{}///{}", "$(find mine)/{}/./{}")
"""Spellings of a file of the project; each reader accepts at least one."""


def trace(top: Path, jobs: Sequence[tuple[str, str]], strace: Path | None = None, **variables: str) -> list[Any]:
    """Run jobs in another process; return the opened files and the text of each."""
    listed = top / "jobs.json"
    listed.write_text(json.dumps(list(jobs)))
    home = top / "home"
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "HOME": str(home), "SIMKIT_CACHE_DIR": str(top / "cache")}
    command = [sys.executable, str(TRACER), str(listed)]
    if strace is not None:
        command = ["strace", "-f", "-y", "-s", "300", "-e", "trace=open,openat,openat2", "-o", str(strace), *command]
    done = subprocess.run(
        command, cwd=home, env={**environment, **variables}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return [json.loads(line) for line in done.stdout.splitlines()]


def hostile_jobs(
    reader: Reader, project: Path, name: str, every: int, first: int
) -> Iterator[tuple[str, tuple[str, str]]]:
    """Yield each spelling with the job that opens it."""
    private = project.parents[3] / "private"
    files, folders = list(spellings(private / reader.target, project)), list(spellings(private, project))
    for number, text in list(enumerate(files))[first::every]:
        yield text, write_job(reader, project, text, folders[number % len(folders)], f"{name}_{number}")


def leak(found: Any, top: Path) -> str:
    """Return what a job has opened or printed of the private files."""
    private = f"{top / 'private'}{os.sep}"
    opened = [path for path in found["opened"] if path.startswith(private)]
    return " ".join(opened) or (found["said"][-500:] if TOKEN in found["said"] else "")


@pytest.fixture(scope="module")
def opened_own(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[str]]:
    """Return the files that each reader opened when it was given the spellings of a file of its project."""
    top = tmp_path_factory.mktemp("own")
    project, jobs = make_project(top), []
    for place, (name, reader) in enumerate(READERS.items()):
        for folder in (project, project / "meshes", project / "worlds"):  # the readers share a cache of files
            shutil.copytree(project / "own", folder / f"own_{place}")
        for k, text in enumerate(OWN):
            own, other = (text.format(f"own_{place}", name) for name in (reader.target, ""))
            jobs.append((name, write_job(reader, project, own, other, f"own{place}_{k}")))
    found = trace(top, [job for _, job in jobs])
    opened: dict[str, list[str]] = {name: [] for name in READERS}
    for (name, _), result in zip(jobs, found, strict=True):
        opened[name] += result["opened"]
    return opened


@pytest.mark.needs_packs
@pytest.mark.parametrize("name", [name for name, reader in READERS.items() if reader.opens_own])
def test_each_reader_opens_a_file_of_the_project(opened_own: dict[str, list[str]], name: str) -> None:
    """This shows that the tracer sees what the readers open."""
    assert any("/own_" in path and path.endswith(READERS[name].target) for path in opened_own[name])


def assert_nothing_is_opened(top: Path, every: int, names: Iterable[str] = READERS) -> None:
    project, jobs = make_project(top), []
    for place, name in enumerate(names):
        for text, job in hostile_jobs(READERS[name], project, str(place), every, place % every):
            jobs.append((f"{name}: {text}", job))
    results = zip(jobs, trace(top, [job for _, job in jobs]), strict=True)
    leaks = [(what, problem) for (what, _), found in results if (problem := leak(found, top))]
    assert not leaks, f"{len(leaks)} of {len(jobs)}: {leaks[:20]}"


def test_no_spelling_of_a_private_file_is_opened_or_printed(tmp_path: Path) -> None:
    """Each reader gets a part of the spellings here, beginning at another one; the slow test has all of them."""
    assert_nothing_is_opened(tmp_path, 181)


@pytest.mark.slow
@pytest.mark.parametrize("name", READERS)
def test_no_spelling_at_all_of_a_private_file_is_opened_or_printed(tmp_path: Path, name: str) -> None:
    assert_nothing_is_opened(tmp_path, 1, [name])


@pytest.mark.skipif(shutil.which("strace") is None, reason="needs strace")
@pytest.mark.slow
def test_no_library_opens_a_private_file_by_itself(tmp_path: Path) -> None:
    """MuJoCo and the decoders of images are written in C and C++; the hook of Python does not see what they open."""
    project = make_project(tmp_path)
    jobs = [
        job
        for place, reader in enumerate(READERS.values())
        for _, job in hostile_jobs(reader, project, str(place), 179, place)
    ]
    log = tmp_path / "strace"
    trace(tmp_path, jobs, strace=log)
    opened = re.findall(r"= \d+<([^>]*)>", log.read_text("utf-8", "replace"))
    assert any(path.startswith(str(project)) for path in opened)
    assert [path for path in opened if path.startswith(f"{tmp_path / 'private'}{os.sep}")] == []

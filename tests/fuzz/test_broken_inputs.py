"""Bags, scripts, parameter files, motions, scenarios, exercises, bundles, golden runs, packets and command lines.

Each is opened by the command line or by its reader, and answered with a result or with an error that has a code: no
traceback, no other exit code, no control character on the terminal, no file, process or connection outside its folder.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest
from campaign import several_readers, try_many
from containers import damaged, sealed
from reader import FINE, Reader
from targets import WORLD_FILES, Target, targets
from test_broken_files import SECONDS, SEED, complaint

KINDS = (
    "bag", "bag folder", "sqlite bag", "script", "parameters", "motions", "scenario", "exercise", "bundle",
    "bundle with code", "golden", "condition", "command", "packets",
)  # fmt: skip
QUICK = 5  # inputs of a kind that are always tried
# What an intact input gives where it is not "loaded"
REFUSED = {("bag", "recover", "sqlite"): "SK-BAG-004", ("replay", "c.zip"): "SK-BUNDLE-005"}


@pytest.fixture(scope="module")
def readers() -> Iterator[list[Reader]]:
    yield from several_readers()


@pytest.fixture(scope="module")
def reader(readers: list[Reader]) -> Reader:
    return readers[0]


def of_kind(kind: str) -> list[Target]:
    return [target for target in targets() if target.kind == kind]


def problem(reader: Reader, target: Target, index: object, folder: Path, only: int | None = None) -> str:
    """Change one file of a target, open it, and say what is wrong with the answer."""
    chance = random.Random(f"{SEED} {target.kind} {index}")
    files = dict(target.files)
    one = chance.choice(target.broken)
    files[one] = damaged(one, files[one], chance)
    files = sealed(files, chance)
    command = target.commands[only] if only is not None else chance.choice(target.commands)
    answer = reader.read(one, files, f"{target.kind} {index}", command)
    return "" if answer["outcome"] in FINE else f"{command}: {complaint(one, files, answer, folder)}"


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_the_readers_accept_the_intact_input(kind: str, reader: Reader) -> None:
    for target in of_kind(kind):
        command = target.commands[0]
        answer = reader.read("", target.files, f"intact {kind}", command)
        expected = next((code for start, code in REFUSED.items() if command[: len(start)] == start), None)
        assert answer["outcome"] == ("refused" if expected else "loaded"), (command, answer)
        assert expected in (None, answer.get("code")), (command, answer)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_broken_inputs_are_accepted_or_refused(kind: str, reader: Reader, tmp_path: Path) -> None:
    found = [problem(reader, t, index, tmp_path, 0) for t in of_kind(kind)[:3] for index in range(QUICK)]
    assert not any(found), "\n".join(filter(None, found))


@pytest.mark.fuzz
@pytest.mark.parametrize("kind", KINDS)
def test_every_command_accepts_the_intact_input(kind: str, reader: Reader) -> None:
    for target in of_kind(kind):
        for command in dict.fromkeys(target.commands):
            answer = reader.read("", target.files, f"intact {kind}", command)
            refused = next((c for start, c in REFUSED.items() if command[: len(start)] == start), None)
            assert answer["outcome"] == "loaded" or (refused and answer.get("code") == refused), (command, answer)


@pytest.mark.fuzz
@pytest.mark.parametrize("kind", KINDS)
def test_broken_inputs_are_accepted_or_refused_for_minutes(kind: str, readers: list[Reader], tmp_path: Path) -> None:
    chosen = of_kind(kind)

    def one(reader: Reader, index: int) -> str:
        return problem(reader, chosen[index % len(chosen)], f"for minutes {index}", tmp_path)

    try_many(kind, one, readers, SECONDS / (len(KINDS) + 1))


@pytest.mark.fuzz
def test_odd_arguments_of_the_python_interface_raise_errors_with_a_code_for_minutes(
    readers: list[Reader], tmp_path: Path
) -> None:
    def one(reader: Reader, index: int) -> str:
        files = {**WORLD_FILES, "calls.txt": f"{SEED} {index}".encode()}
        answer = reader.read("calls.txt", files, f"calls {index}", ("*calls", "calls.txt"))
        return "" if answer["outcome"] in FINE else complaint("calls.txt", files, answer, tmp_path)

    try_many("calls", one, readers, SECONDS / (len(KINDS) + 1))

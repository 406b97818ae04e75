"""Whatever a file holds, it is loaded or refused: no exception but LoadError, no crash, no hang, no endless memory."""

from __future__ import annotations

import os
import random
import time
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any
from zlib import crc32

import pytest
from campaign import several_readers, try_many
from grammar import Grammar
from hypothesis import HealthCheck, Phase, given, seed, settings
from mutation import Mutator, shuffled_bytes
from reader import FINE, Reader
from samples import Sample, samples

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared"
FOUND = Path(__file__).with_name("found")
KEPT = os.environ.get("SIMKIT_FUZZ_KEEP", "")  # a folder for what does harm, beyond the life of the test
SECONDS = float(os.environ.get("SIMKIT_FUZZ_SECONDS", "300"))
SEED = os.environ.get("SIMKIT_FUZZ_SEED", "0")  # another one gives other inputs
SUFFIXES = (".sdf", ".world", ".urdf", ".xacro", ".xml")
LARGEST = 100_000  # [bytes]; larger files only take longer
QUICK = 45  # inputs of each of the tests that always run


def real_files(suffixes: tuple[str, ...], shared: bool = True) -> list[Path]:
    """Our own files, and where they are, the shared ones."""
    folders = [ROOT / "assets", ROOT / "worlds", *ROOT.glob("packs/*/simkit_*")]
    folders += [SHARED / "corpus" / "files", SHARED / "course"] if shared else []
    found = [p for folder in folders if folder.is_dir() for s in suffixes for p in sorted(folder.rglob(f"*{s}"))]
    return [p for p in found if p.stat().st_size <= LARGEST]


@cache
def library() -> tuple[bytes, ...]:
    """Texts with blocks that mutations put into other files: our own, and what our tests and pages have inline."""
    texts = [*real_files(SUFFIXES), *(p for name in ("tests", "packs") for p in (ROOT / name).rglob("test_*.py"))]
    texts += [page for name in ("docs", "packs") for page in (ROOT / name).rglob("*.md")]
    return tuple(p.read_bytes() for p in sorted(texts) if "node_modules" not in p.parts)


@cache
def mutator() -> Mutator:
    return Mutator(library())


@pytest.fixture(scope="module")
def readers() -> Iterator[list[Reader]]:
    yield from several_readers(resources())


@pytest.fixture(scope="module")
def reader(readers: list[Reader]) -> Reader:
    return readers[0]


def resources() -> list[Path]:
    manifest = SHARED / "corpus" / "manifest.tsv"
    rows = manifest.read_text().splitlines()[1:] if manifest.is_file() else []
    roots = dict.fromkeys(root for row in rows for root in row.split("\t")[-1].split(":") if root.startswith("files/"))
    here = [ROOT / "assets", ROOT / "assets" / "turtlebot3"]
    return [*here, *(SHARED / "corpus" / root for root in roots), SHARED / "course" / "models"]


def complaint(main: str, files: Mapping[str, bytes], answer: dict[str, Any], folder: Path) -> str:
    """Keeps the input and says what went wrong with it."""
    kept = Path(KEPT) if KEPT else folder
    kept = kept / f"{crc32(b''.join(files.values())):08x}"
    for name, content in files.items():
        (kept / name).parent.mkdir(parents=True, exist_ok=True)
        (kept / name).write_bytes(content)
    (kept / "complaint.txt").write_text(f"{main}\n{answer['outcome']}\n{answer.get('trace', '')}")
    return f"{answer['outcome']}\ninput: {kept / main}\n{answer.get('trace', '')}"


def broken(sample: Sample, chance: random.Random) -> dict[str, bytes]:
    """The files of a sample, one of them changed."""
    files = dict(sample.files)
    which = chance.choice(sample.broken)
    change = mutator().mutated if sample.is_text and not which.endswith(".yaml") else shuffled_bytes
    files[which] = change(files[which], chance)
    return files


@pytest.mark.parametrize("path", sorted(p for p in FOUND.glob("*") if p.name[0] != "."), ids=lambda p: p.name)
def test_a_file_that_once_did_harm_does_none(path: Path, reader: Reader) -> None:
    """A file of `found/`, or a folder with what is opened: `main.*`, or the command line in `arguments.txt`."""
    named = [path] if path.is_file() else sorted(p for p in path.rglob("*") if p.is_file())
    files = {p.name if p == path else str(p.relative_to(path)): p.read_bytes() for p in named}
    arguments = files.pop("arguments.txt", b"").decode().split("\n")[:-1]
    main = "" if arguments else next(n for n in files if path.is_file() or n.startswith("main."))
    answer = reader.read(main, files, path.name, arguments)
    assert answer["outcome"] in FINE, answer.get("trace") or answer["outcome"]


@pytest.mark.slow
def test_mutated_files_are_loaded_or_refused(reader: Reader, tmp_path: Path) -> None:
    files = real_files(SUFFIXES, shared=False)
    for index in range(QUICK):
        chance = random.Random(index)
        path = chance.choice(files)
        content = {f"input{path.suffix}": mutator().mutated(path.read_bytes(), chance)}
        answer = reader.read(f"input{path.suffix}", content, path.name)
        assert answer["outcome"] in FINE, complaint(f"input{path.suffix}", content, answer, tmp_path)


@pytest.mark.slow
def test_whatever_files_name_may_be_broken(reader: Reader, tmp_path: Path) -> None:
    for index in range(QUICK):
        chance = random.Random(f"samples {index}")
        sample = chance.choice(samples())
        files = broken(sample, chance)
        answer = reader.read(sample.main, files, sample.name)
        assert answer["outcome"] in FINE, complaint(sample.main, files, answer, tmp_path)


@pytest.mark.parametrize("sample", samples(), ids=lambda s: s.name)
def test_a_sample_that_is_not_broken_loads(sample: Sample, reader: Reader) -> None:
    answer = reader.read(sample.main, sample.files)
    assert answer["outcome"] == "loaded", answer


@pytest.mark.fuzz
def test_mutated_real_files_are_loaded_or_refused_for_minutes(readers: list[Reader], tmp_path: Path) -> None:
    files = real_files(SUFFIXES)

    def one(reader: Reader, index: int) -> str:
        chance = random.Random(f"{SEED} minutes {index}")
        path = chance.choice(files)
        content = {f"input{path.suffix}": mutator().mutated(path.read_bytes(), chance)}
        answer = reader.read(f"input{path.suffix}", content, f"{path.name} {index}")
        return "" if answer["outcome"] in FINE else complaint(f"input{path.suffix}", content, answer, tmp_path)

    try_many("worlds", one, readers, SECONDS / 2)


@pytest.mark.fuzz
def test_whatever_files_name_may_be_broken_for_minutes(readers: list[Reader], tmp_path: Path) -> None:
    def one(reader: Reader, index: int) -> str:
        chance = random.Random(f"{SEED} samples for minutes {index}")
        sample = chance.choice(samples())
        files = broken(sample, chance)
        answer = reader.read(sample.main, files, f"{sample.name} {index}")
        return "" if answer["outcome"] in FINE else complaint(sample.main, files, answer, tmp_path)

    try_many("samples", one, readers, SECONDS / 4)


@pytest.mark.fuzz
@pytest.mark.parametrize(
    "root, suffix, suffixes",
    [("sdf", ".sdf", (".sdf", ".world")), ("robot", ".urdf", (".urdf",)), ("mujoco", ".xml", (".xml", ".py", ".md"))],
)
def test_documents_of_the_grammar_are_loaded_or_refused_for_minutes(
    root: str, suffix: str, suffixes: tuple[str, ...], reader: Reader, tmp_path: Path
) -> None:
    examples = [c for p in real_files(suffixes) if f"<{root}".encode() in (c := p.read_bytes())]
    examples += inline_documents(root)
    grammar = Grammar(examples, root)
    until, round_ = time.monotonic() + SECONDS / 12, 0

    def check(content: bytes) -> None:
        answer = reader.read(f"input{suffix}", {f"input{suffix}": content}, root)
        assert answer["outcome"] in FINE, complaint(f"input{suffix}", {f"input{suffix}": content}, answer, tmp_path)

    while time.monotonic() < until:
        one_round = settings(
            max_examples=100,
            deadline=None,
            database=None,
            phases=(Phase.generate, Phase.shrink),
            suppress_health_check=list(HealthCheck),
        )(given(grammar.documents())(check))
        seed(f"{SEED} {round_}")(one_round)()
        round_ += 1


def inline_documents(root: str) -> list[bytes]:
    """Whole documents that stand inside our own tests and pages."""
    open_, close = f"<{root}".encode(), f"</{root}>".encode()
    found = []
    for text in library():
        for piece in text.split(open_)[1:]:
            inner, end, _ = piece.partition(close)
            if end and inner[:1] in (b" ", b">") and b"\n\n\n" not in inner:
                found.append(open_ + inner + close)
    return found

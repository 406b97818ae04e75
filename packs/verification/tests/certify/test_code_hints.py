"""Hints about code lines that often make runs differ."""

from __future__ import annotations

from pathlib import Path

import pytest

from simkit_verification.testing.certify.code_hints import hints_in


def hints(folder: Path, body: str) -> list[str]:
    text = "class A:\n" + "".join(f"    {line}\n" for line in body.splitlines())
    (folder / "a.py").write_text(text)
    return [hint.text for hint in hints_in(str(folder / "a.py"), 1, text.count("\n") + 1)]


@pytest.mark.parametrize(
    ("body", "word"),
    [
        ("def f(self): return time.time()", "wall clock"),
        ("def f(self): return datetime.datetime.now()", "wall clock"),
        ("def f(self): return random.gauss(0, 1)", "without the simulation's seed"),
        ("def f(self): return np.random.normal()", "without the simulation's seed"),
        ("def f(self): return np.random.default_rng()", "has no seed"),
        ("def f(self): return os.urandom(4)", "every process"),
        ("def f(self): return id(self)", "every process"),
        ("def f(self): return hash('a')", "every process"),
        ("def f(self):\n    for n in {1, 2}: pass", "a set"),
        ("def f(self):\n    self.x = set()\n    return [n for n in self.x]", "a set"),
        ("def f(self):\n    for n in set(a) | set(b): pass", "a set"),
        ("def f(self): return os.environ['HOME']", "the shell that started the program"),
        ("def f(self):\n    global count\n    count = 1", "snapshots and resets do not restore it"),
        ("def f(self):\n    def g():\n        nonlocal n\n        n = 1", "nonlocal n"),
        ("def f(self):\n    yield 1", "position of a generator"),
        ("def f(self): open('seen.txt', 'a')", "files keep"),
        ("seen = []", "belongs to the class"),
    ],
)
def test_the_source_position_of_a_value_is_found(body: str, word: str, tmp_path: Path) -> None:
    (found,) = hints(tmp_path, body)
    assert word in found


def test_import_aliases_and_module_containers_are_known(tmp_path: Path) -> None:
    head = "from time import time as now\nfrom random import gauss\nimport numpy.random as dice\nSEEN = {}\n"
    (tmp_path / "a.py").write_text(
        f"{head}class A:\n    def f(self):\n        SEEN[1] = now() + gauss(0, 1) + dice.normal()"
    )
    texts = " ".join(hint.text for hint in hints_in(str(tmp_path / "a.py"), 5, 8))
    assert all(
        word in texts for word in ("now() reads", "gauss() uses", "dice.normal() uses", "SEEN belongs to the module")
    )


def test_deterministic_code_gets_no_hints(tmp_path: Path) -> None:
    sound = (
        "def f(self):\n    self.rng = np.random.default_rng(3)\n    for n in sorted({1, 2}): pass\n"
        "    return self.random('a').normal(1), self.sim.time\n"
    )
    assert hints(tmp_path, sound) == []


def test_another_class_in_the_file_gets_no_hints(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("class A:\n    x = 1\n\n\nclass B:\n    y = time.time()\n")
    assert hints_in(str(tmp_path / "a.py"), 1, 2) == []


def test_a_file_that_is_not_python_has_no_hints(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("class (")
    assert hints_in(str(tmp_path / "a.py"), 1, 2) == [] == hints_in(str(tmp_path / "none.py"), 1, 2)

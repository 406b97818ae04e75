"""What is expected of the suites beside the project: each exception has its reason, and none outlives it."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture(scope="module")
def check() -> ModuleType:
    spec = importlib.util.spec_from_file_location("conformance_check", Path(__file__).with_name("conformance_check.py"))
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_exception_names_a_suite_and_a_reason(check: ModuleType) -> None:
    known = check.expected()
    assert known and {name.split()[0] for name in known} <= {"conformance", "corpus"}
    assert all(len(reason) > 20 for reason in known.values())


def test_an_exception_without_a_reason_is_refused(check: ModuleType, tmp_path: Path) -> None:
    (tmp_path / "list.txt").write_text("# what fails\ncorpus W001\n")
    with pytest.raises(SystemExit, match=r"list.txt:2: found 'corpus W001'; expected 'suite name: reason'"):
        check.expected(tmp_path / "list.txt")


def test_a_new_failure_and_an_exception_that_holds_no_more_are_wrong(check: ModuleType) -> None:
    found = {
        "conformance test_a::test_x": "passed",
        "conformance test_a::test_y": "assert 1 == 2",
        "corpus W001": "agrees",
        "corpus W002": "differs mass",
        "corpus W003": "skipped",
        "corpus W004": "differs pose",
    }
    known = {"corpus W002": "the reference is wrong", "corpus W001": "was wrong", "corpus W003": "not here"}
    wrong = check.compare(found, known)
    assert [line.split(":")[0] for line in wrong] == [
        "FAILS  conformance test_a",
        "FAILS  corpus W004",
        "LISTED corpus W001 agrees, take it out of conformance_expected.txt (was wrong)",
    ]

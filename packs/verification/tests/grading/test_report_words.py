"""Sentences of the grader in French: each sentence of its code has a translation with the same fields."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import simkit.testing.conditions
import simkit_verification
from simkit.cli.terminal.task_display import task_text
from simkit.errors import InputError
from simkit.progress import Task
from simkit_verification.testing.grading.report_words import read_words

CONDITIONS = Path(simkit.testing.conditions.__file__).parent
PACK = Path(simkit_verification.__file__).parent
GRADING = PACK / "testing" / "grading"
GRADER = [file for file in sorted(GRADING.glob("*.py")) if file.stem != "exercise"]  # its messages are for authors
FRENCH = read_words(None, "fr")
TIMES = {"now", "first", "last"}
"""Variables of checks.py with the text of a simulated time."""
VARIABLES = {"end", "message", "text"}
"""Variables with a message or its begin."""
COMPOSED = {
    "was not reached by t = 1 s, when 1": "was not reached by t = 1 s, when the run ended at t = 1 s: f(x) was 1",
    "1, and no further message until t = 1 s": (
        "/a: 5 Hz (5 messages from t = 0 s to t = 1 s), and no further message until t = 2 s"
    ),
    "1: 1 Hz (1 messages from t = 1 s to t = 1 s)": "/a: 5 Hz (9 messages from t = 0 s to t = 1 s), expected 5 Hz",
    "the process of the judge ended 1": "the process of the judge ended by signal 9",
    "the process ended 1 before the run was complete": "the process ended with 3 before the run was complete",
    "the run was stopped after 1; the plugin may have an endless loop": (
        "the run was stopped after 9 s of wall time; the plugin may have an endless loop"
    ),
    "creating 1 failed: 1: 11": "push.py: error SK-PLUGIN-008: creating Push failed: NameError: no",
    "1 contains no plugin": "push.py: error SK-PLUGIN-008: push.py contains no plugin",
    "1 ended the run1": "SystemExit ended the run",
    "the import of the hand-in": "the import of the hand-in made no progress for 1 s, and was stopped at a.py:1",
    "it exists and is not an empty folder": "cannot write a: it exists and is not an empty folder",
}
"""Beginning or end of a message in the code -> such a message."""
OF_AUTHORS = {
    "the expression is 1, but must be true or false",
    "the check 'apart' has 1 models; expected one or two",
}
"""Messages for the author of an exercise, which stay in English, as those of other commands."""


def sample(node: ast.expr) -> str:
    """Return a text that a literal or an f-string gives: 1 for each value."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.BinOp):
        return sample(node.left) + sample(node.right)
    if isinstance(node, ast.IfExp):
        return sample(node.body)
    if isinstance(node, ast.JoinedStr):
        return "".join(map(sample, node.values))
    if isinstance(node, ast.FormattedValue):
        value = node.value
        is_time = (isinstance(value, ast.Name) and value.id in TIMES) or (
            isinstance(value, ast.Call) and isinstance(value.func, ast.Name) and value.func.id == "time_text"
        )
        return "t = 1 s" if is_time else sample(value) if isinstance(value, ast.JoinedStr) else "1"
    return ""


def name_of(function: ast.expr) -> str:
    return function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")


def messages(file: Path, functions: set[str]) -> Iterator[str]:
    """Yield the texts that a file gives to functions, and those of the key `error` and of some variables."""
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        found: list[ast.expr] = []
        if isinstance(node, ast.Call) and name_of(node.func) in functions:
            found = node.args
        elif isinstance(node, ast.Dict):
            pairs = zip(node.keys, node.values, strict=True)
            found = [value for key, value in pairs if isinstance(key, ast.Constant) and key.value == "error"]
        elif isinstance(node, ast.Assign) and name_of(node.targets[0]) in VARIABLES and "_functions" not in file.stem:
            found = [node.value]
        elif isinstance(node, ast.Return) and node.value is not None and file.parent == GRADING:
            found = [node.value, *(node.value.elts if isinstance(node.value, ast.Tuple) else [])]
        yield from (text for text in map(sample, found) if len(re.findall(r"[a-z]{2,}", text)) >= 2)


@pytest.mark.parametrize(
    ("file", "functions"),
    [
        *((CONDITIONS / f"{name}.py", {"_decide", "UndecidedValue"}) for name in ("checks", "topic_listeners")),
        *((file, {"UndecidedValue"}) for file in sorted(CONDITIONS.glob("*_functions.py"))),
        *((file, {"DamagedStreamError", "UndecidedValue", "error"}) for file in GRADER),
        (PACK / "cli" / "lab.py", {"InputError", "_not_writable"}),
        (PACK / "cli" / "grade.py", {"InputError"}),
    ],
    ids=lambda value: value.stem if isinstance(value, Path) else "",
)
def test_each_message_of_the_code_is_there_in_french(file: Path, functions: set[str]) -> None:
    texts = [COMPOSED.get(text, text) for text in messages(file, functions) if text not in OF_AUTHORS]
    assert [text for text in texts if FRENCH.result(text) == text] == []


@pytest.mark.parametrize("file", [*GRADER, PACK / "cli" / "lab.py", PACK / "cli" / "grade.py"])
def test_each_sentence_that_the_report_says_is_there_in_french(file: Path) -> None:
    calls = [node for node in ast.walk(ast.parse(file.read_text("utf-8"))) if isinstance(node, ast.Call)]
    said = {sample(call.args[0]) for call in calls if name_of(call.func) == "say"}
    assert said - set(FRENCH.sentences) == set()


def test_both_languages_have_the_same_fields() -> None:
    for english, french in FRENCH.sentences.items():
        assert sorted(re.findall(r"\{(\w+)", english)) == sorted(re.findall(r"\{(\w+)", french)), english
        assert re.search(r"\w[:;!?]( |$)", french) is None, f"no space before the sign: {french}"


def test_values_and_texts_of_the_student_stay_as_they_are() -> None:
    values = "min(scan('/scan'), 3) was 0.1, topic('/a').x is unknown: no message received on /a at t = 2 s"
    french = "min(scan('/scan'), 3) valait 0.1, topic('/a').x est inconnu : aucun message reçu sur /a à t = 2 s"
    assert FRENCH.result(values) == french
    near = "no publisher on /a; did you mean '/b'? at t = 3 s"
    assert FRENCH.result(near) == "aucun éditeur sur /a ; vouliez-vous dire '/b' ? à t = 3 s"
    error = "a.py:3: ValueError: f(x) was 3, g is unknown: no, in before_step at t = 1.5 s\n  f(x) was 3"
    assert FRENCH.message(error) == error.replace(", in before_step at", ", dans before_step à")
    assert FRENCH.translated("the door was open") == "the door was open"
    assert FRENCH.translated("run 2") == "exécution 2"


def test_an_error_keeps_its_code_in_french() -> None:
    with pytest.raises(InputError) as found, FRENCH.translated_errors():
        raise InputError("SK-SCEN-007", "no file a.py", help="choose a new folder")
    assert str(found.value) == "SK-SCEN-007 fichier absent : a.py\n    help: choisissez un nouveau dossier"


def test_the_line_of_progress_is_in_french() -> None:
    task = Task("grading", 3, done=1)
    task.translate = FRENCH.message
    assert task_text(task).startswith("notation : 1 sur 3, 0 s")

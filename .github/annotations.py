"""Print the result of `simkit golden check --json` as annotations of GitHub, each at the line of its cause.

python annotations.py golden.json
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any


def annotation(level: str, text: str, file: str | None = None, line: int | None = None, title: str = "") -> str:
    """Return a command of GitHub's workflows; `file` is relative to the present folder if it lies below it."""

    def escaped(value: object, *, is_property: bool) -> str:
        more = {":": "%3A", ",": "%2C"} if is_property else {}
        return "".join({"%": "%25", "\r": "%0D", "\n": "%0A", **more}.get(letter, letter) for letter in str(value))

    if file is not None:
        relative = os.path.relpath(file)
        file = Path(file if relative.startswith("..") else relative).as_posix()
    found = {"file": file, "line": line, "title": title}
    properties = ",".join(f"{k}={escaped(v, is_property=True)}" for k, v in found.items() if v)
    return f"::{level}{' ' if properties else ''}{properties}::{escaped(text, is_property=False)}"


def place(where: str | None) -> tuple[str | None, int | None]:
    """Return the file and the line of `FILE:LINE`."""
    file, _, line = (where or "").rpartition(":")
    return (file, int(line)) if line.isdigit() else (where or None, None)


def annotations(result: dict[str, Any]) -> list[str]:
    """Return an annotation for each cause, or for each failed run without a known cause, and for each diagnostic."""
    lines = []
    for found in result.get("diagnostics", ()):
        level = found["severity"].replace("note", "notice")
        text = "\nhelp: ".join(filter(None, (found["message"], found.get("hint"))))
        lines.append(annotation(level, text, found.get("file"), found.get("line"), found["code"]))
    for run in result.get("results", ()):
        if run["passed"] or "error" in run:
            continue
        title = f"golden run {run['name']} differs"
        effect = run["differences"][-1]["words"] if run["differences"] else "see the report"
        causes = (run.get("explanation") or {}).get("causes") or [{"words": "none found", "where": run["folder"]}]
        for cause in causes:
            proof = "\nproven: with this change undone, the run gives the golden outputs" if cause.get("proven") else ""
            text = f"{effect}\ncause: {cause['words']}{proof}"
            lines.append(annotation("error", text, *place(cause.get("where")), title))
    return lines


if __name__ == "__main__":
    print(*annotations(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))), sep="\n")

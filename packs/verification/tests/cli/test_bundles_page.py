"""The page about bundles does what it says: its commands, one after the other, and its Python."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from simkit.cli import app

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "bundles.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_page_works_from_its_beginning_to_its_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (block,) = re.findall(r"^```sh\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    made, repeated = [shlex.split(line, comments=True)[1:] for line in block.splitlines()]
    assert CliRunner().invoke(app, made).exit_code == 5
    (bundle,) = tmp_path.glob(repeated[1])
    done = CliRunner().invoke(app, [repeated[0], str(bundle)])
    assert done.exit_code == 0, done.stderr
    assert "identical: state" in done.stdout
    (program,) = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    names: dict[str, Any] = {}
    exec(compile(program, "bundles.md", "exec"), names)
    assert names["found"].is_same

"""The Python of docs/certify.md works as it stands there."""

from __future__ import annotations

import functools
import re
from pathlib import Path

import pytest

import simkit_verification.testing.certify

PAGE = (Path(__file__).resolve().parents[1] / "docs" / "certify.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


@pytest.mark.slow
@pytest.mark.parametrize("text", BLOCKS)
def test_a_block_runs(text: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    in_this_process = functools.partial(
        simkit_verification.testing.certify.certify, apart=False
    )  # processes are shown in tests/certify
    monkeypatch.setattr(simkit_verification.testing.certify, "certify", in_this_process)
    exec(compile(text, "certify.md", "exec"), {})
    assert len(capsys.readouterr().out.strip()) == 64  # the state hash, and no difference


def test_there_are_blocks() -> None:
    assert BLOCKS

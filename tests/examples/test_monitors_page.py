"""What `docs/monitors.md` shows works as it stands there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import simkit

PAGE = Path(__file__).resolve().parents[2] / "docs" / "monitors.md"
TEXT = PAGE.read_text(encoding="utf-8")
BODY = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
SAMPLES = re.findall(r"```xml\n(.*?)```", TEXT, flags=re.DOTALL)
OF_THE_WORLD = ("TriggeredPublisher", "LogRecord")


@pytest.mark.needs_packs
def test_its_python_runs(capsys: pytest.CaptureFixture[str]) -> None:
    (text,) = re.findall(r"```python\n(.*?)```", TEXT, flags=re.DOTALL)
    exec(compile(text, str(PAGE), "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    came = next(float(line.split()[0]) for line in lines if line.endswith("ball True"))
    said = next(float(line.split()[0]) for line in lines if line.endswith("the ball is here"))
    assert said == pytest.approx(came + 1.0, abs=1.1e-3)
    assert any(line.endswith(" J") for line in lines)


@pytest.mark.needs_packs
@pytest.mark.parametrize("sample", SAMPLES, ids=lambda text: str(re.search(r"systems::(\w+)", text)[1]))  # type: ignore[index]
def test_its_samples_load_and_run(sample: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    in_world = any(name in sample for name in OF_THE_WORLD)
    model = f'<model name="robot"><link name="base">{BODY}</link>{"" if in_world else sample}</model>'
    performer = "<ref>robot</ref><geometry><box><size>1 1 1</size></box></geometry>"
    plugins = f'<plugin name="gz::sim" filename="dummy"><performer name="p">{performer}</performer></plugin>'
    world = f'<world name="hall">{plugins}{model}{sample if in_world else ""}</world>'
    with simkit.load(f'<sdf version="1.9">{world}</sdf>', strict=True) as sim:
        sim.run(0.05)
        assert [d for d in sim.diagnostics if d.severity != "note"] == []


def test_every_element_of_its_tables_is_read_by_a_plugin() -> None:
    folders = ("simkit/plugins/gz", "simkit/plugins/classic", "packs/gz_python/simkit_gz_python/plugins")
    files = [file for folder in folders for file in sorted((PAGE.parents[1] / folder).glob("*.py"))]
    code = "".join(file.read_text(encoding="utf-8") for file in files)
    rows = [line.split("|")[1] for line in TEXT.splitlines() if line.startswith("| `<")]
    elements = {name for row in rows for name in re.findall(r"<(\w+)", row)}
    assert len(elements) > 20
    assert [
        name for name in sorted(elements) if not re.search(rf"\b{name}\b", code) and "open_circuit" not in name
    ] == []

"""Files of the project for GitHub, containers and citations agree with the code."""

from __future__ import annotations

import json
import re
import runpy
import shlex
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.testing import CliRunner

import simkit
from simkit.cli import app

ROOT = Path(__file__).resolve().parents[1]
REPOSITORY_FILES = "https://github.com/simkit-robotics/simkit/raw/main/docs/images/"
WORLD = """<sdf version="1.9"><world name="w">
  <model name="box"><pose>0 0 2 0 0 0</pose><link name="l"><inertial><mass>2</mass></inertial>
    <collision name="c"><geometry><box><size>1 1 {height}</size></box></geometry></collision>
    <sensor name="imu" type="imu"><update_rate>50</update_rate></sensor></link></model>
  <model name="floor"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
  </collision></link></model></world></sdf>"""


def read(name: str) -> Any:
    return yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))


def project() -> dict[str, Any]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def test_the_workflow_tests_each_python_that_the_classifiers_name() -> None:
    named = [version for each in project()["classifiers"] if (version := each.rpartition(" :: ")[2]).count(".") == 1]
    assert read(".github/workflows/tests.yml")["jobs"]["tests"]["strategy"]["matrix"]["python"] == named


def test_the_citation_names_the_version_and_the_licence_of_the_code() -> None:
    citation = read("CITATION.cff")
    assert citation["version"] == simkit.__version__
    assert project()["license"].split(" AND ")[0] == citation["license"]


def test_the_addresses_of_the_project_name_files_of_the_repository() -> None:
    urls = project()["urls"]
    assert set(urls) == {"Documentation", "Source", "Issues", "Changelog"}
    citation = read("CITATION.cff")
    assert urls["Source"] == citation["repository-code"]
    files = [url.partition("/blob/main/")[2] for url in urls.values() if "/blob/main/" in url]
    assert len(files) == 2 and all((ROOT / file).is_file() for file in files)


def test_the_classifiers_are_those_of_the_package_index() -> None:
    known = pytest.importorskip("trove_classifiers").classifiers
    named = project()["classifiers"]
    assert set(named) <= known and named == sorted(
        named, key=lambda name: re.sub(r"\d+", lambda n: n[0].zfill(3), name)
    )


def test_pictures_of_the_readme_are_those_of_the_repository() -> None:
    pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", (ROOT / "README.md").read_text(encoding="utf-8"))
    assert pictures and not [each for each in pictures if not each.startswith(REPOSITORY_FILES)]  # no badges


def options_of(command: list[str]) -> set[str]:
    return set(re.findall(r"--[\w-]+", CliRunner().invoke(app, [*command, "--help"]).output))


def test_the_commands_of_the_action_and_the_workflows_have_their_options() -> None:
    steps = [
        step
        for name in ("tests", "scheduled", "release")
        for job in read(f".github/workflows/{name}.yml")["jobs"].values()
        for step in job["steps"]
    ]
    lines = [
        line.strip()
        for step in steps + read("action.yml")["runs"]["steps"]
        for line in step.get("run", "").replace("\\\n", " ").splitlines()
    ]
    words = [shlex.split(line.split(">", 1)[0]) for line in lines if re.search(r"\bsimkit (golden|doctor)\b", line)]
    ours = [each[each.index("simkit") + 1 :] for each in words]
    assert [each[0] for each in ours] == ["doctor", "golden", "doctor", "golden"]
    for each in ours:
        used = {word for word in each if word.startswith("--")}
        assert used <= options_of([word for word in each[:2] if word in ("doctor", "golden", "check")])


@pytest.mark.slow  # a search for causes
def test_the_action_shows_the_cause_of_a_difference_at_its_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    annotations = runpy.run_path(str(ROOT / ".github" / "annotations.py"))["annotations"]
    world, run = tmp_path / "w.sdf", CliRunner().invoke
    world.write_text(WORLD.format(height=1), encoding="utf-8")
    assert run(app, ["golden", "record", "w.sdf", "--out", "golden/drop", "--duration", "0.7"]).exit_code == 0
    world.write_text(WORLD.format(height="1.2"), encoding="utf-8")
    (line,) = annotations(json.loads(run(app, ["golden", "check", "golden", "--json"]).stdout))
    place, _, text = line.removeprefix("::").partition("::")
    assert place == "error file=w.sdf,line=3,title=golden run drop differs"
    assert "cause: collision box::l::c: size z 1 → 1.2 m (+20 %25)%0Aproven" in text

    world.write_text(WORLD.format(height="1").replace("<sensor", "<senor"), encoding="utf-8")
    broken = annotations(json.loads(run(app, ["golden", "check", "golden", "--json"]).stdout))
    assert broken[0].startswith("::error file=w.sdf,line=4,title=SK-XML-001::")
    (missing,) = annotations(json.loads(run(app, ["golden", "check", "nothing", "--json"]).stdout))
    assert missing.startswith("::error title=SK-GOLDEN-002::nothing: there is no golden run")

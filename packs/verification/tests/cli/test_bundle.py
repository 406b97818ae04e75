"""`simkit bundle`, `simkit replay` and `simkit run --bundle-on-failure`."""

from __future__ import annotations

import json
import os
import stat
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from simkit.cli import app

SLED = """<sdf version="1.9"><world name="ice"><model name="sled"><pose>0 0 1 0 0 0</pose><link name="base"/>
  <plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl"/>
  <plugin filename="libboom.so" name="Boom"/>
</model></world></sdf>"""
BOOM = """
import simkit

class Boom(simkit.ModelPlugin):
    filenames = ("libboom.so",)

    def load(self, model, params):
        pass

    def after_step(self):
        if self.sim.time > 0.5:
            raise ValueError("no ice")
"""
SCRIPT = "- {at: 0.1, topic: /model/sled/cmd_vel, message: {linear: {x: 0.3}}}\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "sled.sdf").write_text(SLED)
    (tmp_path / "plugins").mkdir()
    (tmp_path / "plugins" / "boom.py").write_text(BOOM)
    (tmp_path / "drive.yaml").write_text(SCRIPT)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def simkit(*words: str) -> Any:
    return CliRunner().invoke(app, list(words))


def test_a_world_is_packed_and_repeated(folder: Path) -> None:
    made = simkit("bundle", "sled.sdf", "-o", "run.zip", "--duration", "0.4", "--script", "drive.yaml", "--seed", "3")
    assert made.exit_code == 0, made.output
    found = simkit("replay", "run.zip", "--json")
    assert found.exit_code == 0
    words = json.loads(found.stdout)
    assert words["same"]
    assert f"state {words['state']}" in made.stdout
    again = simkit("bundle", "sled.sdf", "-o", "run.zip")
    assert again.exit_code == 2
    assert "SK-CLI-016" in again.output


def test_a_scenario_is_packed_and_repeated(folder: Path) -> None:
    (folder / "slide.yaml").write_text(
        "world: sled.sdf\nduration: 0.3\nseed: 4\nset: {sled.self_collide: true}\ncommands: drive.yaml\n"
    )
    assert simkit("bundle", "slide.yaml", "-o", "run.zip").exit_code == 0
    listed = simkit("replay", "run.zip", "--list").stdout
    assert "slide: 0.3 s, seed 4, 1 command" in listed
    assert "sled.self_collide=true" in listed
    assert "/model/sled/cmd_vel" in listed
    assert simkit("replay", "run.zip").exit_code == 0


def test_json_of_a_bundle_is_on_standard_output(folder: Path) -> None:
    sled = (folder / "sled.sdf").read_text()
    (folder / "sled.sdf").write_text(sled.replace("</world>", '<plugin filename="none.so" name="n"/></world>'))
    made = json.loads(simkit("bundle", "sled.sdf", "--duration", "0.1", "-o", "run.zip", "--json").stdout)
    assert "SK-PLUGIN-001" in [each["code"] for each in made["diagnostics"]]
    listed = json.loads(simkit("replay", "run.zip", "--list", "--json").stdout)
    assert listed["end"]["state"] == made["state"]
    extracted = json.loads(simkit("replay", "run.zip", "--extract", "new", "--json").stdout)
    assert Path(extracted["world"]) == Path("new/world/sled.sdf")
    assert extracted["files"] == sum(path.is_file() for path in Path("new").rglob("*"))


@pytest.mark.slow
def test_a_failed_run_leaves_a_bundle_that_fails_in_the_same_way(folder: Path) -> None:
    run = simkit(
        *("run", "sled.sdf", "--duration", "1", "--plugin-path", "plugins", "--script", "drive.yaml", "-q"),
        *("--bundle-on-failure", "kept"),
    )
    assert run.exit_code == 4
    (bundle,) = (folder / "kept").iterdir()
    assert bundle.name.startswith("ice-SK-PLUGIN-004-")
    assert f"simkit replay {Path('kept') / bundle.name}" in run.output.replace("\n", " ")
    refused = simkit("replay", str(bundle))
    assert refused.exit_code == 2
    assert "SK-BUNDLE-005" in refused.output
    found = simkit("replay", str(bundle), "--allow-code")
    assert found.exit_code == 0, found.output
    assert "failed as in the bundle: SK-PLUGIN-004" in found.stdout
    assert "no ice" in found.stdout


@pytest.mark.slow
def test_a_plugin_that_fails_to_load_leaves_a_bundle_too(folder: Path) -> None:
    (folder / "plugins" / "boom.py").write_text(BOOM.replace("pass", "raise ValueError('no ice')"))
    run = simkit("run", "sled.sdf", "--duration", "1", "--plugin-path", "plugins", "--bundle-on-failure", "kept")
    assert run.exit_code == 4, run.output
    (bundle,) = (folder / "kept").iterdir()
    found = simkit("replay", str(bundle), "--allow-code")
    assert found.exit_code == 0, found.output


def test_a_successful_run_leaves_no_bundle(folder: Path) -> None:
    run = simkit("run", "sled.sdf", "--duration", "0.2", "-q", "--bundle-on-failure")
    assert run.exit_code == 0, run.output
    assert not (folder / "bundles").exists()


def test_invalid_input_leaves_no_bundle(folder: Path) -> None:
    run = simkit("run", "none.sdf", "--duration", "0.2", "-q", "--bundle-on-failure")
    assert run.exit_code == 2
    assert not (folder / "bundles").exists()


def test_a_replay_that_differs_exits_with_5(folder: Path) -> None:
    import hashlib

    simkit("bundle", "sled.sdf", "-o", "run.zip", "--duration", "0.4", "--script", "drive.yaml")
    with zipfile.ZipFile("run.zip") as old, zipfile.ZipFile("other.zip", "w") as new:
        page = json.loads(old.read("bundle.json"))
        commands = old.read("commands.jsonl").replace(b"0.3", b"0.4")
        page["files"]["commands.jsonl"] |= {"sha256": hashlib.sha256(commands).hexdigest(), "size": len(commands)}
        page["fingerprint"]["mujoco"] = "\x1b[2J1.0"
        changed = {"bundle.json": json.dumps(page), "commands.jsonl": commands}
        for name in old.namelist():
            new.writestr(name, changed.get(name, old.read(name)))
    found = simkit("replay", "other.zip")
    assert found.exit_code == 5
    assert "state " in found.stdout
    assert "/model/sled/cmd_vel: content differs from t = 0.1 s on" in found.stdout
    assert "mujoco is" in found.stdout
    assert "\x1b" not in found.stdout


def test_an_extracted_world_can_be_loaded(folder: Path) -> None:
    simkit("bundle", "sled.sdf", "-o", "run.zip", "--duration", "0.1")
    assert simkit("replay", "run.zip", "--extract", "out").exit_code == 0
    assert simkit("run", "out/world/sled.sdf", "--duration", "0.1", "-q").exit_code == 0
    assert simkit("bag", "info", "out/last_seconds.mcap").exit_code == 0
    assert simkit("replay", "run.zip", "--extract", "out").exit_code == 2


def test_extracting_writes_all_files_or_none(folder: Path) -> None:
    simkit("bundle", "sled.sdf", "-o", "run.zip", "--duration", "0.1")
    with zipfile.ZipFile("run.zip") as old, zipfile.ZipFile("other.zip", "w") as new:
        for name in old.namelist():
            content = old.read(name)
            new.writestr(name, content[::-1] if name.endswith("last_seconds.mcap") else content)
    before = set(folder.iterdir())
    found = simkit("replay", "other.zip", "--extract", "out")
    assert found.exit_code == 2 and "SK-BUNDLE-001" in found.stderr
    assert set(folder.iterdir()) == before


def test_a_run_in_which_something_does_not_hold_leaves_a_bundle(folder: Path) -> None:
    for asked in (["--assert", "time > 9"], ["--until", "time > 9", "--timeout", "0.2"]):
        run = simkit("run", "sled.sdf", "--duration", "0.2", "-q", "--bundle-on-failure", "kept/", *asked)
        assert run.exit_code == 5, run.output
        (bundle,) = (folder / "kept").iterdir()
        assert bundle.name.startswith("ice-check-")
        found = simkit("replay", str(bundle))
        assert found.exit_code == 0, found.output
        assert "failed in the recorded run: time > 9" in found.stdout
        bundle.unlink()


def test_the_bundle_contains_the_failed_check_of_a_scenario(folder: Path) -> None:
    (folder / "slide.yaml").write_text("world: sled.sdf\nduration: 0.2\ngoals: [time > 9]\n")
    made = simkit("bundle", "slide.yaml", "-o", "run.zip")
    assert made.exit_code == 0
    assert "the run failed; the bundle contains the failure: time > 9" in made.output
    found = simkit("replay", "run.zip")
    assert found.exit_code == 0
    assert "time > 9" in found.stdout


def test_an_unusable_bundle_folder_is_reported_before_the_run(folder: Path) -> None:
    for place in ("sled.sdf", "sled.sdf/deeper"):
        run = simkit("run", "sled.sdf", "--duration", "0.1", "--assert", "time > 9", "--bundle-on-failure", place)
        assert run.exit_code == 2
        assert "SK-CLI-016" in run.output
        assert "state" not in run.output


@pytest.mark.skipif(sys.platform == "win32", reason="it has no pipes that have names")
def test_a_special_file_is_never_replaced(folder: Path) -> None:
    """A device too: for root nothing else would stand in the way."""
    os.mkfifo("pipe.sdf")
    for line in (("bundle", "sled.sdf", "--duration", "0.1"), ("convert", "sled.sdf")):
        done = simkit(*line, "-o", "pipe.sdf", "--force")
        assert done.exit_code == 2
        assert "not a regular file" in done.output
    assert stat.S_ISFIFO((folder / "pipe.sdf").stat().st_mode)


@pytest.mark.skipif(sys.platform == "win32", reason="it has no limit of a file's size")
def test_a_disk_that_is_full_leaves_nothing(folder: Path) -> None:
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    try:
        made = simkit("bundle", "sled.sdf", "-o", "run.zip", "--duration", "0.1")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert made.exit_code == 2
    assert "SK-CLI-016" in made.output
    assert sorted(p.name for p in folder.iterdir()) == ["drive.yaml", "plugins", "sled.sdf"]


KILLED = """
import os, signal, sys
import simkit
from simkit_verification.testing.bundles import keep, open_bundle, write_bundle

with simkit.load("sled.sdf") as sim:
    keep(sim)
    sim.run(0.1)
    wholes = 0
    for last in range(1, 10_000, 9):
        process = os.fork()
        if process == 0:
            count = 0
            def hear(event, words):
                global count
                writes = event == "open" and words[2] & (os.O_WRONLY | os.O_RDWR)
                if writes or event in ("os.rename", "os.remove", "os.mkdir", "os.rmdir", "shutil.rmtree"):
                    count += 1
                    if count == last:
                        os.kill(os.getpid(), signal.SIGKILL)
            sys.addaudithook(hear)
            write_bundle(sim, "run.zip", overwrite=True)
            os._exit(0)
        status = os.waitpid(process, 0)[1]
        if os.path.exists("run.zip"):
            with open_bundle("run.zip") as bundle:
                for name in bundle.manifest.files:
                    bundle.read(name)
            wholes += 1
        if os.WIFEXITED(status):
            assert status == 0
            print(last, wholes, sorted(n for n in os.listdir() if n.startswith(".")))
            break
"""


@pytest.mark.skipif(sys.platform == "win32", reason="it has no SIGKILL")
@pytest.mark.slow
def test_a_process_killed_while_packing_leaves_no_partial_bundle(folder: Path) -> None:
    """At many moments, counted by what is done with files: there is no bundle, or a whole one; the next tidies up."""
    done = subprocess.run([sys.executable, "-c", KILLED], check=True, capture_output=True, text=True)
    last, wholes, left = done.stdout.split(maxsplit=2)
    assert int(last) > 20
    assert int(wholes) >= 1
    assert left.strip() == "[]"

"""Code that a file names runs only with a permission of the person who runs the file.

Each attack is a folder of a stranger. The code in it writes a marker file.
"""

from __future__ import annotations

import json
import pickle
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
import typer

import simkit
from simkit.cli import app
from simkit.code_requests import CODE_REFUSED
from simkit.testing.golden.check import check_golden
from simkit.testing.golden.store import read_golden
from simkit.testing.scenarios.code_permission import permit_code
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario
from simkit_verification.testing.certify import certify
from simkit_verification.testing.grading.exercise import read_exercise
from simkit_verification.testing.grading.exercise_grading import grade

FINDS = Path(__file__).resolve().parents[4] / "shared" / "finds" / "scenario_runs_code"
MARKER = "code_ran"
EVIL = """
from pathlib import Path
import simkit

(Path(__file__).resolve().parent / "code_ran").write_text("1")

class Evil(simkit.WorldPlugin):
    def load(self, parent, params):
        pass

def metric(sim):
    return 1.0

scenario = simkit.RunSpec("plain.sdf", duration=0.02)
"""
WORLD = """<sdf version="1.9"><world name="w">{}<model name="m"><static>true</static><link name="l"/></model>
</world></sdf>"""
PLUGIN = '<plugin name="evil" filename="evil.py:Evil"/>'
SCENARIO = "world: world.sdf\nduration: 0.02\nat_end: ['time > 0']\nplugin_paths: [code]\n"
EXERCISE = SCENARIO + "exercise: {title: Fall}\n"
SWEEP = "world: world.sdf\nduration: 0.02\nseeds: 2\nplugin_paths: [code]\nmetrics: {t: time}\n"
METRIC = "world: plain.sdf\nduration: 0.02\nseeds: 2\nmetrics:\n  t: {python: code/evil.py:metric}\n"
MODULE = "world: plain.sdf\nduration: 0.02\nseeds: 2\nmetrics:\n  t: {python: 'antigravity:fly'}\n"
MERGED = "base: &base\n  plugin_paths: [code]\n"


def run(*words: str) -> tuple[int, str]:
    """Run a command line in this process; return its exit code and its output."""
    output = StringIO()
    with redirect_stdout(output), redirect_stderr(output):
        try:
            code = typer.main.get_command(app).main(list(words), standalone_mode=False)
        except SystemExit as end:
            code = end.code
        except Exception as error:  # noqa: BLE001 - the test prints it
            return 1, f"{output.getvalue()}{error!r}"
    return int(code or 0), output.getvalue()


@pytest.fixture
def stranger(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Folder of a stranger, which is the working directory."""
    (tmp_path / "code").mkdir()
    (tmp_path / "code" / "evil.py").write_text(EVIL)
    (tmp_path / "world.sdf").write_text(WORLD.format(PLUGIN))
    (tmp_path / "plain.sdf").write_text(WORLD.format(""))
    files = {"s.yaml": SCENARIO, "e.yaml": EXERCISE, "sweep.yaml": SWEEP, "metric.yaml": METRIC, "module.yaml": MODULE}
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "own.yaml").write_text(
        "world: plain.sdf\nduration: 0.02\ngoals: ['time > 0']\n"
        "exercise: {title: Own, hand_in: code/evil.py, robot: m}\n"
    )
    (tmp_path / "good.py").write_text(
        "import simkit\nclass Good(simkit.ModelPlugin):\n    def load(self, parent, params):\n        pass\n"
    )
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    for name in [name for name in sys.modules if str(tmp_path) in name]:
        del sys.modules[name]


def golden_of(folder: Path, name: str, **changes: Any) -> Path:
    """Write a golden run whose file has other values of the scenario; return its folder."""
    code, output = run("golden", "record", "plain.sdf", "-o", name, "--duration", "0.02")
    assert code == 0, output
    main = folder / name / "golden.json"
    content = json.loads(main.read_text())
    content["scenario"].update(changes)
    main.write_text(json.dumps(content, indent=1))
    return folder / name


COMMANDS: dict[str, tuple[str, ...]] = {
    "golden record": ("golden", "record", "s.yaml", "-o", "new"),
    "certify": ("certify", "s.yaml", "--runs", "2"),
    "bundle": ("bundle", "s.yaml", "-o", "new.zip"),
    "plot": ("plot", "s.yaml", "/clock.clock.sec", "-o", "p.svg"),
    "grade without a hand-in": ("grade", "e.yaml"),
    "grade with a hand-in": ("grade", "e.yaml", "good.py"),
    "grade with the exercise's own plugin": ("grade", "own.yaml"),
    "sweep": ("sweep", "sweep.yaml", "-o", "rows", "-q"),
    "sweep with a function": ("sweep", "run", "metric.yaml", "-o", "rows", "-q", "--jobs", "2"),
}
GOLDEN: dict[str, dict[str, Any]] = {
    "golden check of a golden run with a folder": {"world": "../world.sdf", "options": {"plugin_paths": ["../code"]}},
    "golden check of a golden run of a scenario": {"file": "../s.yaml"},
    "golden check of a golden run of a scenario in Python": {"file": "../code/evil.py"},
}

SLOW = {
    "certify",
    "grade with a hand-in",
    "grade without a hand-in",
    "grade with the exercise's own plugin",
    "sweep with a function",
}
"""Commands that other tests here cover in part, and that start several processes."""


def command_line(folder: Path, name: str) -> tuple[str, ...]:
    """Return a command line that reads a description of a run with code."""
    if name in COMMANDS:
        return COMMANDS[name]
    golden_of(folder, "g", **GOLDEN[name])
    return ("golden", "check", "g", "--no-causes")


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.slow if name in SLOW else ()) for name in (*COMMANDS, *GOLDEN)],
)
def test_a_command_refuses_code_until_an_option_allows_it(stranger: Path, name: str) -> None:
    words = command_line(stranger, name)
    marker = stranger / "code" / MARKER
    code, output = run(*words)
    assert (code, marker.exists()) == (2, False), output
    assert CODE_REFUSED in output
    assert "--allow-code" in output
    assert "--plugin-path code" in " ".join(output.split())
    other = stranger / "other"
    other.mkdir()
    code, output = run(*words, "--plugin-path", "other")
    assert (code, marker.exists()) == (2, False), output
    for allowed in (("--plugin-path", "code"), ("--allow-code",)):
        shutil.rmtree(stranger / "new", ignore_errors=True)
        shutil.rmtree(stranger / "rows", ignore_errors=True)
        (stranger / "new.zip").unlink(missing_ok=True)
        code, output = run(*words, *allowed)
        assert CODE_REFUSED not in output
        assert code in (0, 5), output
        assert marker.exists(), output
        marker.unlink()
        for module in [module for module in sys.modules if str(stranger) in module]:
            del sys.modules[module]


def test_the_refusal_names_the_line_that_asks(stranger: Path) -> None:
    def refusal(name: str) -> str:
        return run(*command_line(stranger, name))[1]

    assert "s.yaml:4: error SK-SCEN-008" in refusal("golden record")
    assert "metric.yaml:5: error SK-SCEN-008" in refusal("sweep with a function")
    assert "own.yaml:4: error SK-SCEN-008" in refusal("grade with the exercise's own plugin")
    for name, key in zip(GOLDEN, ("plugin_paths", None, "file"), strict=True):
        text = refusal(name)
        lines = (stranger / "g" / "golden.json").read_text().splitlines()
        line = next((n for n, one in enumerate(lines, 1) if f'"{key}"' in one), 0)
        assert f"golden.json:{line}: error SK-SCEN-008" in text if key else "s.yaml:4: error SK-SCEN-008" in text
        shutil.rmtree(stranger / "g")


def test_every_command_with_a_scenario_has_the_option() -> None:
    """A command that is added later cannot forget the option."""

    def walk(command: Any, words: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any]]:
        command = getattr(command, "real", command)
        if not hasattr(command, "commands"):
            yield words, command
            return
        context = typer.Context(command)
        for name in command.list_commands(context):
            yield from walk(command.get_command(context, name), (*words, name))

    seen = set()
    for words, command in walk(typer.main.get_command(app), ()):
        context = typer.Context(command)
        parameters = command.get_params(context)
        shown = " ".join(str(one.metavar) for one in parameters if one.param_type_name == "argument")
        options = {name for one in parameters for name in one.opts}
        if any(word in shown for word in ("SCENARIO", "SWEEP.yaml", "EXERCISE.yaml", "WORLD-or-BAG")):
            seen.add(words[0])
            assert {"--allow-code", "--plugin-path"} <= options, words
    assert {"golden", "certify", "bundle", "plot", "grade", "sweep"} <= seen


def test_a_function_of_a_module_needs_the_permission_for_all_code(stranger: Path) -> None:
    code, output = run("sweep", "module.yaml", "-o", "rows", "--plugin-path", ".")
    assert code == 2
    assert "module.yaml:5: error SK-SCEN-008: metric 't' names the function 'antigravity:fly'" in output
    assert "antigravity" not in sys.modules


@pytest.mark.slow
def test_a_stored_sweep_gives_no_permission(stranger: Path) -> None:
    """The results name their sweep file; a sweep that was allowed once is refused without the option."""
    assert run("sweep", "sweep.yaml", "-o", "rows", "-q", "--allow-code")[0] == 0
    (stranger / "code" / MARKER).unlink()
    for words in (("sweep", "sweep.yaml", "-o", "rows"), ("sweep", "replay", "rows", "0")):
        code, output = run(*words)
        assert (code, CODE_REFUSED in output, (stranger / "code" / MARKER).exists()) == (2, True, False)
    assert run("sweep", "replay", "rows", "0", "--allow-code")[0] == 0


def test_folders_written_in_other_ways_are_requests_too(stranger: Path) -> None:
    for text in ("plugin_paths: code", "plugin_paths: [./code/../code]", "<<: {plugin_paths: [code]}"):
        (stranger / "s.yaml").write_text(f"world: world.sdf\nduration: 0.02\n{text}\n")
        code, output = run("golden", "record", "s.yaml", "-o", "new")
        assert (code, CODE_REFUSED in output) == (2, True), text
    (stranger / "link").symlink_to(stranger / "code")
    (stranger / "empty").mkdir()
    (stranger / "s.yaml").write_text("world: world.sdf\nduration: 0.02\nplugin_paths: [link]\n")
    assert run("golden", "record", "s.yaml", "-o", "new", "--plugin-path", "empty")[0] == 2
    (stranger / "empty" / "link").symlink_to(stranger / "code")
    (stranger / "s.yaml").write_text("world: world.sdf\nduration: 0.02\nplugin_paths: [empty/link]\n")
    assert run("golden", "record", "s.yaml", "-o", "new", "--plugin-path", "empty")[0] == 2
    assert not (stranger / "code" / MARKER).exists()


def test_options_of_a_golden_run_are_no_other_arguments(stranger: Path) -> None:
    golden = golden_of(stranger, "g", options={"plugins": ["evil.py"], "change_world": "x", "plugin_paths": "../code"})
    scenario = read_golden(golden).scenario
    assert scenario.options == {}
    assert [request.path for request in scenario.code_requests if request.is_folder]


PYTHON: dict[str, Callable[[bool], object]] = {
    "open_scenario": lambda allowed: open_scenario(read_scenario("s.yaml"), allow_code=allowed).close(),
    "read_scenario": lambda allowed: open_scenario(read_scenario("s.yaml", allow_code=allowed)).close(),
    "load": lambda allowed: open_scenario(permit_code(read_scenario("s.yaml"), allowed)).close(),
    "certify": lambda allowed: certify(read_scenario("s.yaml"), runs=2, apart=False, allow_code=allowed),
    "grade": lambda allowed: grade(read_exercise("e.yaml"), allow_code=allowed),
    "check_golden": lambda allowed: check_golden("g", causes=False, allow_code=allowed),
    "a golden run": lambda allowed: open_scenario(read_golden("g").scenario, allow_code=allowed).close(),
    "sweep": lambda allowed: simkit.sweep(read_scenario("s.yaml"), seeds=2, jobs=1, allow_code=allowed),
    "sweep in processes": lambda allowed: simkit.sweep(read_scenario("s.yaml"), seeds=2, jobs=2, allow_code=allowed),
}


@pytest.mark.parametrize("name", PYTHON)
@pytest.mark.slow
def test_a_function_refuses_code_until_an_argument_allows_it(stranger: Path, name: str) -> None:
    golden_of(stranger, "g", **GOLDEN["golden check of a golden run with a folder"])
    marker = stranger / "code" / MARKER
    with pytest.raises(simkit.LoadError, match=CODE_REFUSED):
        PYTHON[name](False)
    assert not marker.exists()
    PYTHON[name](True)
    assert marker.exists()


def test_run_scenario_refuses_a_scenario_whose_code_is_not_allowed(stranger: Path) -> None:
    scenario = read_scenario("s.yaml")
    with open_scenario(scenario, allow_code=True) as sim:
        with pytest.raises(simkit.LoadError, match=CODE_REFUSED):
            run_scenario(scenario, sim)
        assert run_scenario(scenario, sim, allow_code=True).passed


def test_a_specification_made_in_python_is_the_callers_own(stranger: Path) -> None:
    spec = simkit.RunSpec("world.sdf", duration=0.02, options={"plugin_paths": ["code"]})
    with open_scenario(spec) as sim:
        assert run_scenario(spec, sim).reason == "duration"
    assert (stranger / "code" / MARKER).exists()


def test_a_request_survives_copies_and_processes(stranger: Path) -> None:
    """A worker that receives a specification gets its refusal, not a right."""
    scenario = replace(pickle.loads(pickle.dumps(read_scenario("s.yaml"))), seed=3)
    with pytest.raises(simkit.LoadError, match=CODE_REFUSED):
        scenario.load_arguments()
    for request in permit_code(scenario, allow_code=True), permit_code(scenario, plugin_paths=["."]):
        assert request.load_arguments()["plugin_paths"] == (Path("code"),)


@pytest.mark.slow
def test_the_fixture_refuses_code_until_an_argument_allows_it(stranger: Path) -> None:
    (stranger / "test_it.py").write_text(
        "def test_refused(sensor_regression):\n    sensor_regression('s.yaml')\n"
        "def test_allowed(sensor_regression):\n    sensor_regression('s.yaml', allow_code=True)\n"
        "def test_one_folder(sensor_regression):\n    sensor_regression('s.yaml', plugin_paths=['code'])\n"
    )
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--simkit-update-golden", "test_it.py"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "1 failed, 2 passed" in done.stdout, done.stdout
    assert CODE_REFUSED in done.stdout


def test_a_permission_does_not_change_a_golden_run(stranger: Path) -> None:
    """A golden run of a scenario follows its file, whichever option allows the code."""
    for words in (("--allow-code",), ("--plugin-path", "code"), ("--plugin-path", ".")):
        assert run("golden", "record", "s.yaml", "-o", "new", "--force", *words)[0] == 0
        stored = json.loads((stranger / "new" / "golden.json").read_text())["scenario"]
        assert (stored["file"], stored["options"]) == ("../s.yaml", {"plugin_paths": ["../code"]})
        assert run("golden", "check", "new", "--plugin-path", "code")[0] == 0


@pytest.mark.slow
def test_golden_runs_are_checked_in_processes_with_the_same_permission(stranger: Path) -> None:
    for name in ("one", "two"):
        assert run("golden", "record", "s.yaml", "-o", f"golden/{name}", "--allow-code")[0] == 0
    (stranger / "code" / MARKER).unlink()
    simkit_ = [sys.executable, "-P", "-m", "simkit", "golden", "check", "golden", "--jobs", "2"]
    refused = subprocess.run(simkit_, capture_output=True, text=True, check=False)
    assert (refused.returncode, CODE_REFUSED in refused.stderr) == (2, True), refused.stderr
    assert not (stranger / "code" / MARKER).exists()
    allowed = subprocess.run([*simkit_, "--allow-code"], capture_output=True, text=True, check=False)
    assert allowed.returncode == 0, allowed.stderr
    assert (stranger / "code" / MARKER).exists()


SHADOWS = ("numpy", "pandas", "cloudpickle", "signal", "pickle", "struct", "random", "json", "yaml", "sitecustomize")


@pytest.mark.slow
def test_no_command_imports_a_file_of_the_working_directory(stranger: Path) -> None:
    """A file that has the name of a module is not imported, also not by child processes."""
    for name in (*SHADOWS, "usercustomize", "mujoco", "ray", "simkit_evil"):
        (stranger / f"{name}.py").write_text(f"open({str(stranger / MARKER)!r}, 'w').write(__file__)\n")
    info = stranger / "evil-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: evil\nVersion: 1\n")
    (info / "entry_points.txt").write_text("[simkit.plugins]\nevil = simkit_evil\n[simkit.sensors]\ne = simkit_evil\n")
    (stranger / "evil.pth").write_text("import simkit_evil\n")
    (stranger / "plain.yaml").write_text("world: plain.sdf\nduration: 0.02\nat_end: ['time > 0']\n")
    (stranger / "named.sdf").write_text(WORLD.format('<plugin name="e" filename="simkit_evil:Evil"/>'))
    (stranger / "loaded.sdf").write_text(
        WORLD.format(
            '<plugin name="gz::sim::systems::PythonSystemLoader" filename="gz-sim-python-system-loader-system">'
            "<module_name>simkit_evil</module_name></plugin>"
        )
    )
    (stranger / "rows.yaml").write_text("world: plain.sdf\nduration: 0.02\nseeds: 2\nmetrics: {t: time}\n")
    lines: tuple[tuple[str, ...], ...] = (
        ("golden", "record", "plain.yaml", "-o", "golden/one"),
        ("golden", "record", "plain.yaml", "-o", "golden/two"),
        ("golden", "check", "golden", "--jobs", "2"),
        ("certify", "plain.yaml", "--runs", "2"),
        ("sweep", "rows.yaml", "-o", "rows", "-q"),
        ("check", "named.sdf"),
        ("run", "named.sdf", "--duration", "0.01", "-q"),
        ("run", "loaded.sdf", "--duration", "0.01", "-q"),
        ("plugin", "list"),
    )
    entry = "import sys; from simkit.cli import main; sys.exit(main())"  # what the installed program runs
    for words in lines:
        done = subprocess.run([sys.executable, "-P", "-c", entry, *words], capture_output=True, text=True, check=False)
        assert not (stranger / MARKER).exists(), (words, (stranger / MARKER).read_text(), done.stderr)
        assert done.returncode in (0, 2), (words, done.stderr)


def test_python_m_simkit_does_not_search_the_working_directory(stranger: Path) -> None:
    for name in ("pandas", "simkit_evil"):
        (stranger / f"{name}.py").write_text(f"open({str(stranger / MARKER)!r}, 'w').write(__file__)\n")
    info = stranger / "evil-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: evil\nVersion: 1\n")
    (info / "entry_points.txt").write_text("[simkit.plugins]\nevil = simkit_evil\n")
    (stranger / "named.sdf").write_text(WORLD.format('<plugin name="e" filename="libevil.so"/>'))
    words = [sys.executable, "-m", "simkit", "run", "named.sdf", "--duration", "0.01", "-q"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert not (stranger / MARKER).exists()


@pytest.mark.slow
def test_commands_that_read_no_description_run_no_file_beside_it(stranger: Path) -> None:
    """A scenario or a program in place of a world is an error, or data."""
    golden_of(stranger, "g", **GOLDEN["golden check of a golden run with a folder"])
    sources = ("s.yaml", "code/evil.py", "sweep.yaml", "e.yaml", "g", "world.sdf")
    for command in ("run", "check", "inspect", "convert", "map", "graph", "vendor", "fetch", "replay", "view"):
        extra = {"run": ("--duration", "0.01"), "convert": ("-o", "c"), "map": ("-o", "m"), "graph": ("-o", "g.svg")}
        extra |= {"vendor": ("-o", "v"), "fetch": ("--dry-run",), "view": ("--html", "v.html")}
        for source in sources:
            run(command, source, *extra.get(command, ()))
            assert not (stranger / "code" / MARKER).exists(), (command, source)


def test_the_report_of_another_state_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The scenario and the golden run that ran code before are refused."""
    if not FINDS.is_dir():
        pytest.skip("the shared folder is not on this machine")
    shutil.copytree(FINDS, tmp_path / "finds")
    for path in (tmp_path / "finds").rglob("*"):
        path.chmod(0o755)
    (tmp_path / "finds").chmod(0o755)
    (tmp_path / "finds" / "evil.py").write_text(EVIL)
    monkeypatch.chdir(tmp_path / "finds")
    for words in (
        ("golden", "record", "s.yaml", "-o", "out"),
        ("golden", "check", "g"),
        ("bundle", "s.yaml", "-o", "b.zip"),
    ):
        code, output = run(*words)
        assert (code, CODE_REFUSED in output) == (2, True), output
        assert not (tmp_path / "finds" / MARKER).exists()

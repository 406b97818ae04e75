"""Import rules of the core and of packs: which room may use which, no circles, and why an import is in a function.

A room is a folder or module directly under `simkit/`, or a pack. An import counts wherever it stands: at the top of a
file, inside a function or under `TYPE_CHECKING`.
"""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "simkit"
PACKS = {file.parent.name: file.parent for file in sorted(ROOT.glob("packs/*/simkit_*/__init__.py"))}
PACKAGES = {"simkit": PACKAGE, **PACKS}

SMALL_MODULES = frozenset(
    {
        "argument_checks",
        "child_process",
        "code_requests",
        "completion",
        "deferred_response",
        "deprecation",
        "diagnostic_record",
        "diagnostics",
        "early_interrupts",
        "entry_points",
        "errors",
        "facade",
        "garbage_collection",
        "float_sum",
        "file_lock",
        "home_folder",
        "in_process",
        "input_file",
        "install_command",
        "interrupts",
        "json_reader",
        "elementary_functions",
        "lifecycle",
        "linear_algebra",
        "matrix_decompositions",
        "msgs",
        "memory_error",
        "moved_modules",
        "mujoco_import",
        "name_conflict",
        "number_text",
        "output_file",
        "packs",
        "params",
        "pose",
        "process_control",
    }
    | {"hidden_text", "json_reader", "linked_files", "project_folder", "template_texts"}
    | {"extend", "lazy_names"}
    | {"run_checks", "run_fields", "run_files", "run_nodes", "run_spec", "run_values"}
    | {"progress", "registry", "save_path", "topic_logger", "trusted_folders", "version", "yaml_reader"}
)
"""Modules at the top that every room may use; they use only each other."""

BELOW_RUNTIME = {"compiler", "scene"}
BELOW_BUILD = {*BELOW_RUNTIME, "loaders", "plugins", "recording", "runtime", "sensors", "writers"}
ROOMS: dict[str, set[str]] = {
    "scene": set(),
    "loaders": {"scene"},
    "compiler": {"loaders", "scene"},
    "writers": {"compiler", "loaders", "scene"},
    "runtime": BELOW_RUNTIME,
    "sensors": {*BELOW_RUNTIME, "loaders", "runtime"},
    "recording": {"runtime", "writers"},
    "plugins": {*BELOW_RUNTIME, "loaders", "recording", "runtime", "sensors"},
    "build": {*BELOW_BUILD, "bridges"},
    "bridges": {"compiler", "loaders", "recording", "runtime", "scene"},
    "gym": set(),
    "live": {"bridges"},
    "testing": {*BELOW_BUILD, "build"},
    "pytest_plugin": {*BELOW_BUILD, "build", "testing"},
    "cli": {*BELOW_BUILD, "bridges", "build", "live", "testing"},
}
"""The rooms that each room may use, beside the small modules."""

PACKS_OF_PACKS = {
    "simkit_identification": {"simkit_learning"},
    "simkit_launch": {"simkit_nodes", "simkit_terminal"},
    "simkit_learning": {"simkit_verification"},
    "simkit_motion": {"simkit_control", "simkit_nodes"},
    "simkit_navigation": {"simkit_nodes"},
    "simkit_robots": {"simkit_control"},
}
"""The packs that each pack may use; every pack may use the core, and only its commands may use `cli`."""

PACK_NAMES = {"simkit.facade": "types and modules of the users' names that packs bring"}
"""Modules of the core that may name a pack, with the reason."""

FRONT = {"__init__", "__main__"}
"""Modules that only hand on what a user imports or runs."""

RE_EXPORTS = {"simkit.extend", "simkit.facade", "simkit.recording", "simkit.sensors", "simkit.testing"}
"""Modules that give other modules' names to users; their imports for type checkers make no circle."""

HEAVY = {
    "action_msgs": "only the Python of ROS has it",
    "av": "optional: the extra `video`",
    "asyncio": "0.03 s; few scripts use it",
    "cbor2": "optional: the extra `rosbridge`",
    "coacd": "optional: the extra `decompose`",
    "coal": "optional: the extra `labs`",
    "cloudpickle": "optional: the extra `experiments`",
    "ctypes": "only functions of Windows need it",
    "cmaes": "optional: the extra `fit`",
    "cv2": "0.1 s",
    "embreex": "optional: has no wheels for some machines",
    "concurrent": "0.02 s; few commands start processes",
    "fcntl": "only some systems have it",
    "gymnasium": "optional: the extra `experiments`",
    "glfw": "optional: the extra `view`",
    "jinja2": "only reports and new plugins need it",
    "lxml": "only files need it",
    "lz4": "only some bags need it",
    "markupsafe": "comes with jinja2",
    "msvcrt": "only some systems have it",
    "resource": "only some systems have it",
    "multiprocessing": "0.02 s; few commands start processes",
    "mapbox_earcut": "only polygons need it",
    "matplotlib": "optional: the extra `labs`",
    "mujoco": "0.23 s, and looks for a renderer",
    "numpy": "0.11 s; the pytest plugin and `--help` do without",
    "optuna": "optional: the extra `search`",
    "OpenGL": "needs a renderer",
    "PIL": "only pictures need it",
    "pandas": "optional: the extra `pandas`",
    "pinocchio": "optional: the extra `labs`",
    "pvlib": "optional: the extra `sun`",
    "pyarrow": "optional: the extra `parquet`",
    "pytest": "only tests have it",
    "ray": "optional: the extra `cluster`",
    "rclpy": "only the Python of ROS has it",
    "rich": "0.05 s",
    "rosbags": "0.04 s; only messages need it",
    "scipy": "0.3 s",
    "trimesh": "0.2 s",
    "termios": "only some systems have it",
    "typer": "only the command line needs it",
    "webbrowser": "only a desktop needs it",
    "websockets": "0.05 s; only servers need it",
    "xacro": "only xacro files need it",
    "yourdfpy": "optional: the extra `second-reader`",
    "yaml": "only YAML files need it",
    "zstandard": "only bags need it",
}
"""Packages that may be imported inside a function, with the reason."""

SLOW_MODULES = {
    "simkit.packs": "15 ms, of `importlib.metadata`; `import simkit` does without",
    "simkit.bridges.live.answering": "4 ms; only a run with a client needs it",
    "simkit.compiler.meshes.convex_decomposition": "10 ms; only meshes need it",
    "simkit.compiler.meshes.convex_pieces": "comes with convex_decomposition",
    "simkit.loaders.meshes.mesh_reader": "4 ms; only meshes need it",
    "simkit.compiler.meshes.surface_patches": "comes with convex_decomposition",
    "simkit.loaders.xacro.expansion": "5 ms; only xacro files need it",
    "simkit.sensors.cameras.rendering.software.software_renderer": "20 ms; only images without OpenGL need it",
    "simkit.runtime.engine.stream_key": "6 ms, of NumPy's generators; only random numbers need it",
}
"""Modules of simkit that may be imported inside a function, with the time that a run without them saves."""

KNOWN_BY_TYPE = {
    "simkit.runtime.handles": (1, 12, "a model returns its links, and a link returns its model"),
    "simkit_launch.launch_modules.launch": (1, 5, "an item is executed with a context, which has handlers with items"),
    "simkit_nodes": (2, 14, "a program returns its threads, a node its executor, and the other way round, as in rclpy"),
}
"""Packages whose modules may import each other for types: number of groups, size of the largest, and the reason."""

KNOWN_FOLDERS = {
    ("simkit_launch", "simkit_launch.frontends", "simkit_launch.launch_modules"): "launch files include each other",
    ("simkit_nodes", "simkit_nodes.python_modules"): "a program has copies of modules that wait in its tasks",
}
"""Folders that may import each other, with the reason; their files have no circles."""

Kind = Literal["module", "function", "typing"]


@dataclass(frozen=True)
class Import:
    """One import of a file.

    Attributes:
        target: full name of what is imported: a module of simkit, or a foreign package's first name.
        kind: where it stands.
    """

    line: int
    target: str
    kind: Kind


@cache
def modules() -> Mapping[str, Path]:
    """Files of the core and of the packs by module name."""
    found = {}
    for folder in PACKAGES.values():
        for path in sorted(folder.rglob("*.py")):
            if path.name.endswith((".launch.py", "_launch.py")):  # a launch file, which no module imports
                continue
            parts = path.relative_to(folder.parent).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def imports(module: str) -> tuple[Import, ...]:
    """Imports of a module, in the order of the file."""
    path = modules()[module]
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    return tuple(_imports(ast.parse(path.read_text(encoding="utf-8"), str(path)), "module", package))


def _imports(node: ast.AST, kind: Kind, package: str) -> Iterator[Import]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.expr):  # no import is in an expression; to visit them takes two thirds of the time
            continue
        inner = kind
        if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef) and kind == "module":
            inner = "function"
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            inner = "typing"
        names: list[str] = []
        if isinstance(child, ast.Import):
            names = [alias.name for alias in child.names]
        elif isinstance(child, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) - child.level + 1] if child.level else []
            base = ".".join([*above, *([child.module] if child.module else [])])
            names = [f"{base}.{alias.name}" for alias in child.names]
        for name in names:
            yield Import(child.lineno, _target(name), kind)
        yield from _imports(child, inner, package)


def _target(name: str) -> str:
    """The module of simkit or a pack that a dotted name lies in, or the first name of a foreign package."""
    if name.split(".")[0] not in PACKAGES:
        return name.split(".")[0]
    while name not in modules():
        name = name.rpartition(".")[0]
    return name


def room_of(module: str) -> str:
    """The folder or module directly under `simkit/` that a module belongs to, or its pack."""
    parts = module.split(".")
    if parts[0] in PACKS:
        return parts[0]
    return parts[1] if len(parts) > 1 else "__init__"


def is_command(module: str) -> bool:
    """Check whether a module belongs to the command line, of the core or of a pack."""
    return module.split(".")[1:2] == ["cli"]


def folder_of(module: str) -> str:
    """The folder of a module, as a dotted name; a module at the top stands for itself.

    The folders in `launch_modules` are one folder: they are those of ROS.
    """
    package = module.split(".")[0]
    if module.startswith("simkit_launch.launch_modules."):
        return "simkit_launch.launch_modules"
    parent = modules()[module].relative_to(PACKAGES[package]).parent.parts
    return ".".join(([package] if package in PACKS else []) + list(parent)) or room_of(module)


def circles(kinds: set[Kind], group: Callable[[str], str] = str) -> list[list[str]]:
    """Groups of modules (or of what `group` makes of them) that import each other, directly or through others."""
    graph: dict[str, set[str]] = defaultdict(set)
    for module in modules():
        for one in imports(module):
            if module in RE_EXPORTS and one.kind == "typing":
                continue
            if one.kind in kinds and one.target in modules() and group(one.target) != group(module):
                graph[group(module)].add(group(one.target))
    reach: dict[str, set[str]] = {}
    for start in graph:
        seen: set[str] = set()
        waiting = [*graph[start]]
        while waiting:
            name = waiting.pop()
            if name not in seen:
                seen.add(name)
                waiting += graph.get(name, ())
        reach[start] = seen
    members = {name for name, seen in reach.items() if name in seen}
    found = {frozenset(other for other in members if other in reach[name] and name in reach[other]) for name in members}
    return sorted(sorted(circle) for circle in found)


@pytest.mark.parametrize("room", sorted({room_of(module) for module in modules()} - FRONT))
def test_a_room_imports_only_the_rooms_that_it_may_use(room: str) -> None:
    if room in PACKS:
        allowed = {*ROOMS, *SMALL_MODULES, *FRONT, room, *PACKS_OF_PACKS.get(room, ())}
    elif f"simkit.{room}" in PACK_NAMES:
        allowed = {*PACKS, *SMALL_MODULES}
    elif f"simkit.{room}" in RE_EXPORTS and room in SMALL_MODULES:
        allowed = {*ROOMS, *SMALL_MODULES}
    elif room in SMALL_MODULES:
        allowed = {*SMALL_MODULES}
    else:
        assert room in ROOMS, f"simkit/{room} has no row in the table; give it one"
        allowed = {*ROOMS[room], *SMALL_MODULES, room}
    wrong = [
        f"{modules()[module].relative_to(ROOT)}:{one.line}: {one.target}"
        for module in modules()
        if room_of(module) == room
        for one in imports(module)
        if one.target in modules() and room_of(one.target) not in allowed and (module, one.target) not in FRONT_USERS
    ]
    assert not wrong, f"{room} may use {sorted(allowed)}, but:\n" + "\n".join(wrong)


def test_the_core_names_no_pack() -> None:
    """A name counts in code, comments and texts."""
    assert PACKS, "no pack found"
    pattern = re.compile(rf"\b({'|'.join(PACKS)})\b")
    named = [
        f"{path.relative_to(ROOT)}: {match[0]}"
        for module, path in modules().items()
        if module.split(".")[0] == "simkit" and module not in PACK_NAMES
        for match in pattern.finditer(path.read_text(encoding="utf-8"))
    ]
    assert not named


def test_only_the_commands_of_a_pack_use_the_command_line() -> None:
    wrong = [
        f"{modules()[module].relative_to(ROOT)}:{one.line}: {one.target}"
        for module in modules()
        if room_of(module) in PACKS and not is_command(module)
        for one in imports(module)
        if one.target in modules() and room_of(one.target) == "cli"
    ]
    assert not wrong


FRONT_USERS = {
    ("simkit.pytest_plugin", "simkit"): "tests load worlds as users do",
}
"""Modules that use simkit as its users do, with the reason."""


def test_subfolders_have_no_circles_by_any_import() -> None:
    circles_of_folders = circles({"module", "function", "typing"}, folder_of)
    assert {tuple(circle) for circle in circles_of_folders} == KNOWN_FOLDERS.keys()


def _is_in(circle: list[str], packages: Iterable[str]) -> bool:
    return any(all(f"{name}.".startswith(f"{package}.") for name in circle) for package in packages)


def test_files_have_no_circles_by_imports_that_run() -> None:
    assert circles({"module", "function"}) == []


def test_modules_know_each_other_by_type_only_where_their_objects_return_each_other() -> None:
    left = circles({"module", "function", "typing"})
    for package, (groups, largest, _) in KNOWN_BY_TYPE.items():
        inside = [circle for circle in left if _is_in(circle, [package])]
        assert len(inside) <= groups and all(len(circle) <= largest for circle in inside), inside
        left = [circle for circle in left if circle not in inside]
    assert not left


def test_an_import_inside_a_function_spares_a_heavy_package() -> None:
    """A module of simkit may be imported late if it takes 3 ms, or loads a heavy package that the file does not load.

    Commands import what they run when they run: each then answers `--help` and a completion within a tenth of a second.
    """
    wrong = []
    for module in modules():
        loaded = _heavy(module)
        for one in imports(module):
            if one.kind != "function" or one.target in HEAVY or (module, one.target) in FRONT_USERS:
                continue
            if one.target in SLOW_MODULES or (is_command(module) and one.target in modules()):
                continue
            if one.target not in modules() or not _heavy(one.target) - loaded:
                wrong.append(f"{modules()[module].relative_to(ROOT)}:{one.line}: {one.target}")
    assert not wrong, "these belong to the top of their files:\n" + "\n".join(wrong)


@cache
def _heavy(module: str) -> frozenset[str]:
    """Heavy packages that come with a module when it is imported."""
    seen: set[str] = set()
    found: set[str] = set()
    waiting = [module]
    while waiting:
        name = waiting.pop()
        if name in seen:
            continue
        seen.add(name)
        parent = name.rpartition(".")[0]
        if parent:
            waiting.append(parent)
        for one in imports(name):
            if one.kind == "module":
                if one.target in HEAVY:
                    found.add(one.target)
                elif one.target in modules():
                    waiting.append(one.target)
    return frozenset(found)


def test_only_loaders_read_xml() -> None:
    """XML ends at the loaders. The module `xacro` of launch files returns documents of Python's library, as in ROS."""
    readers = {module for module in modules() for one in imports(module) if one.target in {"lxml", "xml"}}
    readers.discard("simkit_launch.launch_modules.xacro")
    assert {room_of(reader) for reader in readers} == {"loaders"}


def test_scene_loaders_and_small_modules_work_without_mujoco() -> None:
    users = {module for module in modules() for one in imports(module) if one.target == "mujoco"}
    light = {"scene", "loaders", *SMALL_MODULES} - {"mujoco_import"}
    assert not {module for module in users if room_of(module) in light}


def test_no_more_than_twelve_folders_lie_at_the_top() -> None:
    folders = {path.relative_to(PACKAGE).parts[0] for path in PACKAGE.rglob("*.py") if path.parent != PACKAGE}
    assert len(folders) <= 12, sorted(folders)


def test_no_file_is_longer_than_600_lines() -> None:
    lengths = {str(path.relative_to(ROOT)): path.read_text("utf-8").count("\n") for path in modules().values()}
    assert {name: length for name, length in lengths.items() if length > 600} == {}

"""Accesses to private attributes of other files: the core has few, and each has a place in the table.

An attribute with a leading underscore counts unless the file itself assigns, defines or names it, or reads it from
`self` or `cls`.
"""

from __future__ import annotations

import ast
from collections import Counter
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1] / "simkit"
MOST = 40
NAMED_TUPLE = ("_replace", "_asdict", "_fields")

ALLOWED = {
    "child_process.py": 1,
    "cli/bench_bare_mujoco.py": 3,
    "cli/terminal/blocked_plugins.py": 1,
    "cli/terminal/interruption.py": 1,
    "cli/wall_time_limit.py": 2,
    "early_interrupts.py": 1,
    "loaders/xacro/expression_functions.py": 1,
    "plugins/joints/joint_axis.py": 3,
    "runtime/engine/plugin_faults.py": 1,
    "sensors/rays/numpy_rays.py": 1,
    "process_control.py": 1,
    "writers/mjcf.py": 2,
}
"""Number of accesses in each file; it may only shrink. Functions of Python such as `os._exit` count too."""


def private_accesses(source: str) -> list[str]:
    """Return the accesses of a file to private attributes that it does not define."""
    nodes = list(ast.walk(ast.parse(source)))
    defined: set[str] = set()
    for node in nodes:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in ("self", "cls"):
            defined.add(node.attr)
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            defined.add(node.name)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            defined.add(node.target.id)
        elif isinstance(node, ast.Assign):
            defined |= {target.id for target in node.targets if isinstance(target, ast.Name)}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            defined.add(node.value)
    return [
        ast.unparse(node)
        for node in nodes
        if isinstance(node, ast.Attribute)
        and node.attr.startswith("_")
        and not node.attr.startswith("__")
        and node.attr not in {*NAMED_TUPLE, *defined}
    ]


def test_the_core_reads_few_private_attributes_of_other_files() -> None:
    found = Counter(
        {
            str(path.relative_to(PACKAGE)): len(private_accesses(path.read_text(encoding="utf-8")))
            for path in sorted(PACKAGE.rglob("*.py"))
        }
    )
    assert {file: count for file, count in found.items() if count} == ALLOWED
    assert found.total() <= MOST


def test_an_attribute_of_another_file_counts() -> None:
    assert private_accesses("drive._odometry.reckon()") == ["drive._odometry"]
    assert private_accesses("class A:\n def f(self, other):\n  self._x = other._x") == []

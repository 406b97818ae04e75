"""Sums of floats have the same bits on every version of Python: simkit adds floats with `float_sum`.

From Python 3.12 on, the built-in `sum` compensates the rounding errors of floats. The built-in is allowed where it adds
integers or arrays, and where this can be seen:

- each term is an integer literal, a comparison, `not …`, `len(…)`, `int(…)`, or made of these with `+ - * <<` or
  `… if … else …`; or the call is `sum(map(len, …))`;
- the sum begins with an array: `sum(…, np.zeros(…))`;
- its file and argument stand in `INTEGERS`, with what it counts.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from simkit.float_sum import float_sum

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = [ROOT / "simkit", *sorted(ROOT.glob("packs/*/simkit_*"))]

INTEGERS = {
    ("bridges/live/loopback_socket.py", "flags"): "flags of a file",
    ("cli/bag.py", "e.count for e in exports"): "messages",
    ("testing/golden/compare/runs.py", "golden.diagnostics.get(code, 0) for code in LEFT_OUT_CODES"): "warnings",
    ("testing/golden/compare/runs.py", "now.values()"): "warnings",
    ("cli/bag_record.py", "lost.values()"): "messages",
    ("simkit_fuel/cli/fetch.py", "resource.size or 0 for resource in new"): "bytes",
    ("cli/golden.py", "path.stat().st_size for path in out_.iterdir()"): "bytes",
    ("cli/golden.py", "r.verdict is not None and r.verdict.passed for r in results"): "runs that passed",
    ("simkit_launch/programs/republish_topic.py", "size for _, size in self._sent"): "bytes",
    (
        "runtime/communication/endpoint_table.py",
        "each.active and (not getattr(each, 'yields', False)) for each in self._endpoints.get(name, ())",
    ): "servers",
    ("simkit_verification/cli/replay.py", "f['size'] for f in manifest.files.values()"): "bytes",
    ("cli/terminal/output.py", "notes.values()"): "notes",
    ("cli/terminal/topic_sources.py", "self.lost_by_topic().values()"): "messages",
    ("simkit_terminal/cli/terminal/topic_rates.py", "sizes"): "bytes",
    ("compiler/meshes/convex_decomposition.py", "p.is_solid for p in pieces"): "solid pieces",
    ("compiler/meshes/parallel_conversion.py", "sizes.values()"): "bytes",
    ("compiler/meshes/parallel_conversion.py", "sizes[file] for file in files"): "bytes",
    ("simkit_identification/fitting/fit.py", "recording.size for recording in recordings"): "readings",
    ("simkit_identification/fitting/problem.py", "reading.values.size for reading in self.readings"): "readings",
    ("simkit_learning/sweeps/report.py", "n for status, n in statuses.items() if status != 'ok'"): "runs",
    (
        "loaders/sdf/solid_moments.py",
        "_is_inside(outline[0], other) for j, other in enumerate(outlines) if j != i",
    ): "outlines around another",
    ("msgs/type_limits.py", "count_node(node) for _, node in fields"): "values of a type",
    ("plugins/ros_parameter_files.py", "item.leaves() for item in inside"): "parameters",
    ("recording/bags/mcap_file.py", "counts.values()"): "messages",
    ("recording/bags/mcap_writer.py", "self._counts.values()"): "messages",
    ("recording/bags/mcap_writer.py", "sizes"): "bytes",
    ("recording/bags/reader.py", "topic.count for topic in self.topics"): "messages",
    (
        "recording/bags/reader.py",
        "(folder / name).stat().st_size for name in self.files if (folder / name).is_file()",
    ): "bytes",
    ("recording/export/bag_folder.py", "t.count for t in topics"): "messages",
    ("recording/graphs/layered_layout.py", "position[neighbour] for neighbour in sides[name]"): "positions in a column",
    ("recording/topic_counts.py", "row.count for row in self.rows"): "messages",
    ("runtime/communication/topic_bus.py", "li.active for li in self._listeners.get(topic, ())"): "active subscribers",
    ("simkit_verification/testing/bundles/bundle_writer.py", "entry['size'] for entry in table.values()"): "bytes",
    ("testing/golden/array_packing.py", "_size(entry) for entry in self._entries"): "bytes",
    (
        "testing/golden/record_encoding.py",
        "array.size for _, table in fields.tables.values() for array in table.values()",
    ): "numbers",
    ("writers/zip_archive.py", "sizes"): "bytes",
}
"""File and argument of each other `sum` of integers or booleans, with what it counts."""


def _is_integer(node: ast.expr) -> bool:
    """Check whether an expression is an integer or a boolean, whatever its names are."""
    match node:
        case ast.Constant(value=value):
            return isinstance(value, int)
        case ast.Compare() | ast.UnaryOp(op=ast.Not()):
            return True
        case ast.BoolOp(values=values):
            return all(map(_is_integer, values))
        case ast.IfExp(body=body, orelse=other):
            return _is_integer(body) and _is_integer(other)
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult() | ast.LShift(), right=right):
            return _is_integer(left) and (_is_integer(right) or isinstance(node.op, ast.LShift))
        case ast.Call(func=ast.Name(id=name)):
            return name in ("len", "int")
    return False


def _is_allowed(call: ast.Call) -> bool:
    match call.args:
        case [ast.GeneratorExp(elt=term) | ast.ListComp(elt=term)] if _is_integer(term):
            return True
        case [ast.Call(func=ast.Name(id="map"), args=[ast.Name(id="len"), _])]:
            return True
        case [_, ast.Call(func=ast.Attribute(value=ast.Name(id="np"), attr="zeros"))]:
            return True
    return False


def _refused_sums(source: str) -> Iterator[tuple[int, str]]:
    """Yield line and argument of each use of the built-in `sum` that may add floats."""
    if re.search(r"\bsum\b", source) is None:  # to parse all files takes seconds
        return
    tree = ast.parse(source)
    calls = [
        n for n in ast.walk(tree) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name) and n.func.id == "sum"
    ]
    called = {id(call.func) for call in calls}
    for call in calls:
        if not _is_allowed(call):
            argument = ast.unparse(call.args[0])
            yield call.lineno, argument[1:-1] if isinstance(call.args[0], ast.GeneratorExp) else argument
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and node.id == "sum" and id(node) not in called:
            yield node.lineno, "sum as a value"


def test_the_built_in_sum_adds_only_integers_and_arrays():
    found = {
        (path.relative_to(package if package.name == "simkit" else package.parent).as_posix(), argument): line
        for package in PACKAGES
        for path in sorted(package.rglob("*.py"))
        for line, argument in _refused_sums(path.read_text(encoding="utf-8"))
    }
    refused = {
        f"{file}:{line}": argument for (file, argument), line in found.items() if (file, argument) not in INTEGERS
    }
    assert not refused, "use simkit.float_sum.float_sum for floats; add integers to INTEGERS"
    assert not INTEGERS.keys() - found.keys(), "these are in no file: remove them from INTEGERS"


@pytest.mark.parametrize(
    "text",
    [
        "sum(values)",
        "sum(v * v for v in values)",
        "sum(abs(v) for v in values)",
        "sum([0.5, len(values)])",
        "sum(1.0 for v in values)",
        "sum(2 * v for v in values)",
        "sum(map(abs, values))",
        "max(map(sum, rows))",
        "sum(values, 0.0)",
    ],
)
def test_sums_that_may_add_floats_are_found(text):
    assert list(_refused_sums(text))


@pytest.mark.parametrize(
    "text",
    [
        "sum(v > 1 for v in values)",
        "sum(not v for v in values)",
        "sum(len(v) + 1 for v in values)",
        "sum(1 << v for v in values)",
        "sum(map(len, values))",
        "sum((m * c for m, c in pairs), np.zeros(3))",
        "values.sum()",
        "np.sum(values)",
        "math.fsum(values)",
    ],
)
def test_sums_of_integers_and_arrays_are_allowed(text):
    assert not list(_refused_sums(text))


def test_a_sum_of_floats_rounds_after_each_addition():
    assert float_sum([0.1] * 10) == 0.9999999999999999
    assert float_sum([1.0, 1e100, 1.0, -1e100]) == 0.0


def test_a_sum_of_nothing_and_of_integers_is_an_integer():
    assert [type(float_sum(values)) for values in ([], [1, 2], [True])] == [int, int, int]

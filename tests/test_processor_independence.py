"""No code of simkit uses functions of NumPy whose bits depend on the processor, except where bits do not matter.

BLAS and LAPACK (`@`, `dot`, `np.linalg`) choose their code by the processor, and so do NumPy's `exp`, `log`, `tan` and
others for whole arrays. An unstable sort orders equal keys by the width of the processor's registers.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = [ROOT / "simkit", *sorted(ROOT.glob("packs/*/simkit_*"))]
FILES = {
    path.relative_to(package if package.name == "simkit" else package.parent).as_posix(): path
    for package in PACKAGES
    for path in sorted(package.rglob("*.py"))
}
"""Files by their names: those of the core without, those of packs with the name of their package."""

BLAS = frozenset(
    [
        "dot",
        "vdot",
        "inner",
        "matmul",
        "tensordot",
        "vecdot",
        "matvec",
        "vecmat",
        "convolve",
        "correlate",
        "cov",
        "corrcoef",
        "polyfit",
    ]
)
BY_PROCESSOR = frozenset(
    [
        "exp",
        "exp2",
        "expm1",
        "log",
        "log2",
        "log10",
        "log1p",
        "tan",
        "arcsin",
        "arccos",
        "arctan",
        "arctan2",
        "sinh",
        "cosh",
        "tanh",
        "arcsinh",
        "arccosh",
        "arctanh",
        "cbrt",
        "power",
        "float_power",
        "pow",
        "asin",
        "acos",
        "atan",
        "atan2",
        "asinh",
        "acosh",
        "atanh",
        "logaddexp",
        "logaddexp2",
    ]
)
SORTS = frozenset(("argsort", "argpartition"))
ARRAYS = ("np.", ".T", ".matrix", ".reshape", "xmat", "rotation", "_axes", "jacobian")
EXCEPTIONS = {
    # file: reason why equal bits do not matter there
    "linear_algebra.py": "squared_length uses vdot only far from the limit with which it is compared",
    "sensors/rays/numpy_rays.py": "rays are chosen with a margin that is wider than any rounding",
    "simkit_identification/fitting/search.py": "analysis of finished recordings by SciPy; no run reads its bits",
    "simkit_identification/fitting/uncertainty.py": "analysis of finished recordings by SciPy; no run reads its bits",
    "simkit_identification/fitting/validation.py": "analysis of finished recordings by SciPy; no run reads its bits",
    "simkit_learning/sweeps/sensitivity.py": "a report, which no run reads",
    "cli/bench_bare_mujoco.py": "it measures MuJoCo without simkit",
}


def _is_of_numpy(node: ast.Attribute) -> bool:
    """Check whether an expression begins with `np.NAME` or `np.NAME.NAME`; its text takes ten times as long."""
    value = node.value.value if isinstance(node.value, ast.Attribute) else node.value
    return isinstance(value, ast.Name) and value.id == "np"


def _names(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield (line, reason) for each use of a function that depends on the processor."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute):
            text = ast.unparse(node) if _is_of_numpy(node) else ""
            if text.startswith("np.linalg.") and text.count(".") == 2 and node.attr not in ("LinAlgError", "norm"):
                yield node.lineno, f"{text} uses LAPACK; use simkit.linear_algebra"
            elif text.startswith("np.") and text.count(".") == 1 and node.attr in BLAS:
                yield node.lineno, f"{text} uses BLAS; use simkit.linear_algebra"
            elif text.startswith("np.") and text.count(".") == 1 and node.attr in BY_PROCESSOR:
                yield node.lineno, f"{text} depends on the processor; use simkit.elementary_functions"
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            if node.func.attr not in (*SORTS, "norm", "einsum"):
                continue
            keywords = {k.arg: ast.unparse(k.value) for k in node.keywords}
            if node.func.attr in SORTS and keywords.get("kind") != "'stable'":
                yield node.lineno, "an unstable sort orders equal keys by processor; add kind='stable'"
            elif ast.unparse(node.func) == "np.linalg.norm" and "axis" not in keywords:
                yield node.lineno, "the norm of one vector uses BLAS; use simkit.linear_algebra.norm"
            elif ast.unparse(node.func) == "np.einsum" and "optimize" in keywords:
                yield node.lineno, "an optimised einsum uses BLAS"
        elif isinstance(node, ast.BinOp | ast.AugAssign) and isinstance(node.op, ast.MatMult):
            text = ast.unparse(node)
            if "Pose(" not in text and any(word in text for word in ARRAYS):
                yield node.lineno, f"`{text}` is a product of arrays; use simkit.linear_algebra.matmul"
        elif isinstance(node, ast.ImportFrom | ast.Import):
            modules = [node.module or ""] if isinstance(node, ast.ImportFrom) else [alias.name for alias in node.names]
            if any(module.startswith(("scipy.linalg", "numpy.linalg")) for module in modules):
                yield node.lineno, "LAPACK; use simkit.linear_algebra"


def _problems(text: str) -> list[str]:
    if not re.search(r"\bnp\.|argsort|argpartition|norm\b|einsum| @=? |linalg", text):  # half of the files: 3 s
        return []
    return [f"{line}: {reason}" for line, reason in _names(ast.parse(text))]


def test_no_module_uses_functions_whose_bits_depend_on_the_processor() -> None:
    found = []
    for name, path in FILES.items():
        if name not in EXCEPTIONS:
            found += [f"{name}:{problem}" for problem in _problems(path.read_text("utf-8"))]
    assert not found, "\n".join(found)


def test_every_exception_is_still_needed() -> None:
    for name in EXCEPTIONS:
        assert _problems(FILES[name].read_text("utf-8")), f"{name} needs no exception any more"


@pytest.mark.parametrize(
    "text",
    [
        "np.linalg.solve(a, b)",
        "np.linalg.norm(v)",
        "np.vdot(a, b)",
        "np.exp(a)",
        "a.argsort()",
        "np.einsum('ij,jk', a, b, optimize=True)",
        "a.T @ b",
        "x = pose.matrix @ v",
        "from scipy.linalg import solve",
    ],
)
def test_each_kind_of_use_is_found(text: str) -> None:
    assert _problems(text)


@pytest.mark.parametrize(
    "text",
    ["np.linalg.norm(v, axis=1)", "np.sin(a)", "np.argsort(a, kind='stable')", "link.pose @ offset", "math.exp(x)"],
)
def test_functions_with_the_same_bits_everywhere_are_allowed(text: str) -> None:
    assert not _problems(text)

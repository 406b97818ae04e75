"""Write type stubs of the installed MuJoCo, so that mypy checks how simkit uses it: python .ci/mujoco_stubs.py.

MuJoCo ships none. mypy's own generator reads its signatures; what follows mends what it cannot know: arrays of a
specification take any sequence, an enumeration's member is an integer, and a compiled model has its type.
The stubs are written to .mypy_stubs/, which the configuration names and git ignores.
"""

from __future__ import annotations

import re
from pathlib import Path

from mypy.stubgen import main as generate_stubs

STUBS = Path(__file__).resolve().parents[1] / ".mypy_stubs"
MODULES = ("_callbacks", "_constants", "_enums", "_errors", "_functions", "_render", "_specs", "_structs", "_version")

DESCRIPTORS = '''
class _FloatArray:
    """An array that is read as float64 and set from any sequence."""
    def __get__(self, instance: object, owner: object = ...) -> numpy.typing.NDArray[numpy.float64]: ...
    def __set__(self, instance: object, value: numpy.typing.ArrayLike) -> None: ...

class _SingleArray:
    """An array that is read as float32 and set from any sequence."""
    def __get__(self, instance: object, owner: object = ...) -> numpy.typing.NDArray[numpy.float32]: ...
    def __set__(self, instance: object, value: numpy.typing.ArrayLike) -> None: ...

class _IntArray:
    """An array that is read as int32 and set from any sequence."""
    def __get__(self, instance: object, owner: object = ...) -> numpy.typing.NDArray[numpy.int32]: ...
    def __set__(self, instance: object, value: numpy.typing.ArrayLike) -> None: ...

'''


def main() -> None:
    """Generate the stubs and mend them."""
    names = [part for module in MODULES for part in ("-m", f"mujoco.{module}")]
    generate_stubs(["-q", "--include-private", *names, "-o", str(STUBS)])
    folder = STUBS / "mujoco"
    imports = [f"from mujoco.{module} import *\n" for module in MODULES if module != "_version"]
    text = "".join(imports) + "\n__version__: str\nPLUGINS_DIR: str\n\nclass GLContext:\n"
    text += "    def __init__(self, max_width: int, max_height: int) -> None: ...\n"
    text += "    def make_current(self) -> None: ...\n    def free(self) -> None: ...\n"
    (folder / "__init__.pyi").write_text(text, encoding="utf-8")
    for name in MODULES:
        path = folder / f"{name}.pyi"
        path.write_text(mended(path.read_text(encoding="utf-8"), name), encoding="utf-8")


def mended(text: str, name: str) -> str:
    """Return the stub of one module with looser setters and without what mypy cannot parse."""
    text = text.replace("import flags\n", "")
    text = re.sub(r"typing\.Annotated\[(numpy\.typing\.NDArray\[[\w.]+\])(?:, '[^']*')+\]", r"\1", text)
    if name == "_enums":
        return re.sub(r"^class (mjt\w+):", r"class \1(int):", text, flags=re.MULTILINE)
    if name == "_functions":
        text = re.sub(r"(\bflg_\w+|\bcompute\w*): bool\b", r"\1: int | bool", text)
        return re.sub(r"numpy\.typing\.NDArray\[numpy\.(?:uint8|bool)\]( \| None)?", "typing.Any", text)
    if name in {"_specs", "_structs"}:
        for kind, descriptor in (("float64", "_FloatArray"), ("float32", "_SingleArray"), ("int32", "_IntArray")):
            attribute = rf"^(    \w+): numpy\.typing\.NDArray\[numpy\.{kind}\]$"
            text = re.sub(attribute, rf"\1: {descriptor}", text, flags=re.MULTILINE)
        text = re.sub(r"\bcollections\.abc\.Sequence\[typing\.SupportsFloat[^\]]*\]", "numpy.typing.ArrayLike", text)
        text = re.sub(r"(def compile\(.*\) ->) object", r"\1 mujoco._structs.MjModel", text)
        recompiled = r"\1 tuple[mujoco._structs.MjModel, mujoco._structs.MjData]"
        text = re.sub(r"(def recompile\(.*\) ->) object", recompiled, text)
        text = re.sub(r"^(    \w+): MjFloatVec$", r"\1: _SingleArray", text, flags=re.M)
        text = re.sub(r"(tausmooth: [^=,]+),", r"\1 = ...,", text)
        at = text.index("\nclass ")
        text = text[:at] + "\n" + DESCRIPTORS + text[at:]
    return text


if __name__ == "__main__":
    main()

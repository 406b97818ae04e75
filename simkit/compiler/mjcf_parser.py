"""Parser for MJCF files with MuJoCo; its messages become diagnostics at the user's own lines.

Only MuJoCo's parser can resolve the defaults, classes, replication and attachment of a file. The MJCF loader receives
this parser as an argument, so that no loader imports MuJoCo.
"""

from __future__ import annotations

import base64
import json
import re
import subprocess
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import mujoco

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.loaders.resources.loader import MjcfText

RANGE_TIMEOUT: Final = 30.0
"""Wall-time limit [s] for measuring length ranges."""

_MESSAGE_PLACE: Final = re.compile(r"\n?Element (?:name )?'([^']*)'(?:, id \d+)?(?:, line (\d+))?(?:, column \d+)?\s*$")
_MESSAGE_LINE: Final = re.compile(r"\bline (?:number=)?(\d+)", re.IGNORECASE)
_UNKNOWN_NAME: Final = re.compile(
    r"(\w+) (?:target )?'([^']*)' (?:not found|for actuator)|unknown \w+ (?:\w+ )*'([^']*)'"
)

_HINTS: Final = {
    "free joint can only be used on top level": "move its body into <worldbody>, or give it other joints",
    "larger than mjMINVAL": "give the body an <inertial>, or a geom with mass, or remove its joints",
    "positive eigenvalues": "check the signs and units of the <inertial>",
    "must be positive in geom": "give each number of size a value above 0",
    "repeated name": "rename one of them",
    "A + B >= C": "correct the <inertial>, or set <compiler balanceinertia='true'/>",
}
"""Remedies for messages of the engine, by a part of the message."""

LengthRanges = dict[str, tuple[float, float]]

_RANGE_SCRIPT: Final = """
import base64, json, sys
import mujoco
mujoco.set_mju_user_warning(lambda text: None)
given = json.load(sys.stdin)
models, assets = ({k: base64.b64decode(v) for k, v in given[kind].items()} for kind in ("models", "assets"))
try:
    model = mujoco.MjSpec.from_string(given["text"], include=models, assets=assets).compile()
except Exception as problem:
    json.dump({"problem": str(problem)}, sys.stdout)
else:
    json.dump({"ranges": model.actuator_lengthrange.tolist()}, sys.stdout)
"""


@dataclass(frozen=True)
class CompiledFile:
    """MJCF file compiled by MuJoCo on its own; see `simkit.loaders.resources.loader.CompiledMjcf`."""

    spec: mujoco.MjSpec
    model: mujoco.MjModel
    data: mujoco.MjData
    document: Callable[[], mujoco.MjSpec]

    @property
    def is_aligned(self) -> bool:
        """True if compiling rotates a free body to the axes of its inertia."""
        free = [j for j in self.spec.joints if int(j.type) == 0]
        return any(int(j.align) == 1 or (int(j.align) == 2 and self.spec.compiler.alignfree) for j in free)

    @property
    def has_gravity(self) -> bool:
        """True if the file's flags enable gravity."""
        return not int(self.model.opt.disableflags) & int(mujoco.mjtDisableBit.mjDSBL_GRAVITY)

    @property
    def allows_sleep(self) -> bool:
        """True if the file's flags allow bodies at rest to sleep."""
        return bool(int(self.model.opt.enableflags) & int(mujoco.mjtEnableBit.mjENBL_SLEEP))

    def name(self, kind: str, number: int) -> str:
        """Return the name of an element; `kind` is MuJoCo's word (`BODY`, `JOINT`, ...)."""
        return str(mujoco.mj_id2name(self.model, getattr(mujoco.mjtObj, f"mjOBJ_{kind}"), number))


class MjcfParser:
    """MuJoCo's parser and compiler, for the MJCF loader; see `simkit.loaders.resources.loader.MjcfParser`."""

    def schema_text(self) -> str:
        """Return MuJoCo's own table of elements and attributes."""
        return str(mujoco.mj_printSchema(False, False))

    def compile(self, file: MjcfText, diagnostics: Diagnostics, in_axes_of_file: bool = False) -> CompiledFile | None:
        """Compile a file. Return its specification and model, or record an error and return None."""
        with _collect_warnings() as engine_warnings:
            try:
                spec = open_specification(file)
                ranges: LengthRanges | None = None
                if _needs_length_ranges(spec):
                    names = [actuator.name for actuator in spec.actuators]
                    ranges = measure_length_ranges(file, names, file.root.where, diagnostics)
                    if ranges is None:
                        return None
                document = partial(open_specification, file, ranges, in_axes_of_file)
                spec = document()
                model = spec.compile()
            except (ValueError, RuntimeError, MemoryError, mujoco.FatalError) as problem:
                _report_refusal(str(problem), file, diagnostics)
                return None
        for text in dict.fromkeys(engine_warnings):
            message, where = _locate_message(text, file)
            diagnostics.warning("SK-MJCF-008", f"MuJoCo warns: {message}", where)
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        return CompiledFile(spec, model, data, document)


def open_specification(
    file: MjcfText, ranges: LengthRanges | None = None, in_axes_of_file: bool = False
) -> mujoco.MjSpec:
    """Return a new `mujoco.MjSpec` of a file in which every element has a name.

    Args:
        file: the file.
        ranges: known length ranges of actuators, so that the compiler does not measure them.
        in_axes_of_file: True to keep the file's frame of a body with a free joint, even if the file asks MuJoCo to
            align the frame with the inertia.

    Raises:
        ValueError: MuJoCo refuses the file.
    """
    with _collect_warnings():
        spec = mujoco.MjSpec.from_string(file.text, include=dict(file.models), assets=dict(file.assets))
        name_everything(spec)
        spec.compiler.fusestatic = spec.compiler.discardvisual = False  # every element must be accessible by name
        for actuator in spec.actuators if ranges is not None else ():
            actuator.lengthrange = ranges[actuator.name] if ranges else actuator.lengthrange
        if ranges is not None:
            spec.compiler.LRopt.useexisting = True
        if in_axes_of_file:
            spec.compiler.alignfree = False
            for joint in spec.joints:
                joint.align = False
    return spec


def _needs_length_ranges(spec: mujoco.MjSpec) -> bool:
    """Check whether the compiler would measure length ranges of muscles or of actuators that the file selects."""
    mode, gain, bias = int(spec.compiler.LRopt.mode), mujoco.mjtGain, mujoco.mjtBias
    gains, biases = [gain.mjGAIN_MUSCLE], [bias.mjBIAS_MUSCLE]
    if mode == int(mujoco.mjtLRMode.mjLRMODE_MUSCLEUSER):
        gains, biases = [*gains, gain.mjGAIN_USER], [*biases, bias.mjBIAS_USER]
    is_all = mode == int(mujoco.mjtLRMode.mjLRMODE_ALL)
    return mode > 0 and any(
        (is_all or a.gaintype in gains or a.biastype in biases)
        and not (spec.compiler.LRopt.useexisting and float(a.lengthrange[0]) < float(a.lengthrange[1]))
        for a in spec.actuators
    )


def measure_length_ranges(
    file: MjcfText, names: list[str], where: Where, diagnostics: Diagnostics
) -> LengthRanges | None:
    """Return the length ranges of a file's actuators by name; None, with an error recorded, if they cannot be measured.

    The error contains the reason, also if the file does not compile for a reason without relation to length ranges.
    """
    files = {"models": file.models, "assets": file.assets}
    texts = {kind: {k: base64.b64encode(v).decode() for k, v in contents.items()} for kind, contents in files.items()}
    task = json.dumps({"text": file.text, **texts})
    try:
        done = subprocess.run(
            [sys.executable, "-I", "-c", _RANGE_SCRIPT],
            input=task.encode(),
            capture_output=True,
            timeout=RANGE_TIMEOUT,
            check=False,
        )
        answer = json.loads(done.stdout) if done.returncode == 0 else {}
    except (subprocess.TimeoutExpired, OSError, ValueError):
        answer = {}
    if "ranges" in answer:
        return {name: (low, high) for name, (low, high) in zip(names, answer["ranges"], strict=False)}
    reason = answer.get("problem", f"the measurement did not converge within {RANGE_TIMEOUT:g} s")
    diagnostics.error(
        "SK-MJCF-014",
        f"the length ranges of the muscles cannot be measured: {' '.join(str(reason).split())}",
        where,
        "give each muscle its lengthrange, or its tendon or joint a range and <lengthrange uselimit='true'/>",
    )
    return None


@contextmanager
def _collect_warnings() -> Iterator[list[str]]:
    """Collect the engine's warnings instead of writing them to the terminal and to a log file."""
    texts: list[str] = []
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(texts.append)
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            yield texts
        texts += [str(w.message) for w in caught if str(w.message) not in texts]
    finally:
        mujoco.set_mju_user_warning(before)


def _report_refusal(text: str, file: MjcfText, diagnostics: Diagnostics) -> None:
    message, where = _locate_message(text, file)
    match = _UNKNOWN_NAME.search(message)
    hint = next((hint for part, hint in _HINTS.items() if part in message), "")
    if match is not None:
        name = match[2] or match[3] or ""
        hint = did_you_mean(name, _element_names(file))
    diagnostics.error("SK-MJCF-001", f"MuJoCo refuses the file: {message}", where, hint)


def _locate_message(text: str, file: MjcfText) -> tuple[str, Where]:
    """Return a message of the engine as one line without its line number, and that line number as a file position."""
    text = text.strip().removeprefix("XML Error: ").removeprefix("Error: ")
    where = file.root.where
    place = _MESSAGE_PLACE.search(text)
    line = place[2] if place is not None and place[2] else None
    if place is not None:
        text = text[: place.start()] + (f" (element {place[1]!r})" if place[1] else "")
    elif (match := _MESSAGE_LINE.search(text)) is not None:
        line = match[1]
    if line is not None:
        where = file.where(int(line))
    return " ".join(text.split()), where


def _element_names(file: MjcfText) -> Iterable[str]:
    stack = [file.root]
    while stack:
        element = stack.pop()
        if element.attribute("name"):
            yield element.attribute("name")
        stack += element.children


# ---------------------------------------------------------------------- every element has a name


def name_everything(spec: mujoco.MjSpec) -> None:
    """Name each unnamed element reproducibly: bodies by number, others by their owner."""
    bodies = list(spec.bodies)
    _name_elements(bodies[1:], lambda _, i: f"body{i + 1}")
    for body in bodies:
        owner = "world" if body.name == "world" else body.name
        _name_elements(
            body.joints, lambda j, i, owner=owner: f"{owner}_{'free' if int(j.type) == 0 else 'joint'}{i or ''}"
        )
        _name_elements(body.geoms, lambda _, i, owner=owner: f"{owner}_geom{i}")
        _name_elements(body.sites, lambda _, i, owner=owner: f"{owner}_site{i}")
        _name_elements(body.cameras, lambda _, i, owner=owner: f"{owner}_camera{i}")
        _name_elements(body.lights, lambda _, i, owner=owner: f"{owner}_light{i}")
    _make_names_unique(spec)
    for kind in (
        "actuators", "sensors", "equalities", "tendons", "excludes", "pairs", "keys", "textures", "skins", "flexes",
        "materials", "meshes", "hfields",
    ):  # fmt: skip
        word = {"equalities": "equality", "flexes": "flex", "meshes": "mesh"}.get(kind, kind[:-1])
        _name_elements(getattr(spec, kind), lambda _, i, word=word: f"{word}{i}")


def _name_elements(elements: Iterable[Any], make_name: Callable[..., str]) -> None:
    elements = list(elements)
    taken = {e.name for e in elements if e.name}
    for i, element in enumerate(elements):
        if element.name:
            continue
        name = base = make_name(element, i)
        k = 1
        while name in taken:
            k += 1
            name = f"{base}_{k}"
        element.name = name
        taken.add(name)


def _make_names_unique(spec: mujoco.MjSpec) -> None:
    """Rename generated names that equal a name in the file."""
    for kind in ("joints", "geoms", "sites", "cameras", "lights"):
        seen: set[str] = set()
        for element in getattr(spec, kind):
            name, k = element.name, 1
            while name in seen:
                k += 1
                name = f"{element.name}_{k}"
            if name != element.name:
                element.name = name
            seen.add(name)

"""MuJoCo's parser and compiler on a gathered file; what they say becomes diagnostics at the user's own lines.

The one place in this room that knows the engine: its parser alone can say what defaults, classes, replication and
attachment make of a file.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any, Final

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.loaders.mjcf.bundle import Bundle
from simkit.loaders.mjcf.ranges import Ranges, measured_ranges

_PLACE: Final = re.compile(r"\n?Element (?:name )?'([^']*)'(?:, id \d+)?(?:, line (\d+))?(?:, column \d+)?\s*$")
_LINE: Final = re.compile(r"\bline (?:number=)?(\d+)", re.IGNORECASE)
_UNKNOWN: Final = re.compile(r"(\w+) (?:target )?'([^']*)' (?:not found|for actuator)|unknown \w+ (?:\w+ )*'([^']*)'")

Opened = tuple[Any, Any, Callable[[], Any]]
"""A specification, the model it compiles to, and what makes such a specification again."""


def open_specification(bundle: Bundle, ranges: Ranges | None = None, in_axes_of_file: bool = False) -> Any:
    """A fresh `mujoco.MjSpec` of a file in which every element has a name.

    Args:
        ranges: length ranges of actuators, so that compiling need not measure them.
        in_axes_of_file: bodies with a free joint keep the frame that the file gives them, whatever it says of aligning
            them with their inertia.

    Raises:
        ValueError: MuJoCo refuses it.
    """
    import mujoco

    with _quietly():
        spec = mujoco.MjSpec.from_string(bundle.text, include=dict(bundle.models), assets=dict(bundle.assets))
        name_everything(spec)
        spec.compiler.fusestatic = spec.compiler.discardvisual = False  # all of it can be asked for by name
        for actuator in spec.actuators if ranges is not None else ():
            actuator.lengthrange = ranges[actuator.name] if ranges else actuator.lengthrange
        if ranges is not None:
            spec.compiler.LRopt.useexisting = True
        if in_axes_of_file:
            spec.compiler.alignfree = False
            for joint in spec.joints:
                joint.align = False
    return spec


def _wants_ranges(spec: Any) -> bool:
    """Whether compiling would measure the length of an actuator (a muscle, or whatever the file's mode says)."""
    import mujoco

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


def is_aligned(spec: Any) -> bool:
    """Whether compiling turns a free body into the axes of its inertia."""
    free = [j for j in spec.joints if int(j.type) == 0]
    return any(int(j.align) == 1 or (int(j.align) == 2 and spec.compiler.alignfree) for j in free)


def open_and_compile(bundle: Bundle, diagnostics: Diagnostics, in_axes_of_file: bool = False) -> Opened | None:
    """The specification of a file, and the model it compiles to on its own; None, with an error, where it does not."""
    import mujoco

    with _quietly() as said:
        try:
            spec = open_specification(bundle)
            ranges: Ranges | None = None
            if _wants_ranges(spec):
                names = [actuator.name for actuator in spec.actuators]
                ranges = measured_ranges(bundle, names, bundle.root.where, diagnostics)
                if ranges is None:
                    return None
            document = partial(open_specification, bundle, ranges, in_axes_of_file)
            spec = document()
            model = spec.compile()
        except (ValueError, RuntimeError, MemoryError, mujoco.FatalError) as problem:
            _refused(str(problem), bundle, diagnostics)
            return None
    for text in dict.fromkeys(said):
        message, where = _located(text, bundle)
        diagnostics.warning("SK-MJCF-008", f"MuJoCo warns: {message}", where)
    return spec, model, document


@contextmanager
def _quietly() -> Iterator[list[str]]:
    """What the engine warns of, instead of on the terminal and in a log file in the working folder."""
    import mujoco

    said: list[str] = []
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(said.append)
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            yield said
        said += [str(w.message) for w in caught if str(w.message) not in said]
    finally:
        mujoco.set_mju_user_warning(before)


def _refused(text: str, bundle: Bundle, diagnostics: Diagnostics) -> None:
    message, where = _located(text, bundle)
    found = _UNKNOWN.search(message)
    hint = ""
    if found is not None:
        name = found[2] or found[3] or ""
        hint = did_you_mean(name, _names(bundle))
    diagnostics.error("SK-MJCF-001", f"MuJoCo refuses the file: {message}", where, hint)


def _located(text: str, bundle: Bundle) -> tuple[str, Where]:
    """A message of the engine in one line, without its line number, and the place that this number means."""
    text = text.strip().removeprefix("XML Error: ").removeprefix("Error: ")
    where = bundle.root.where
    place = _PLACE.search(text)
    line = place[2] if place is not None and place[2] else None
    if place is not None:
        text = text[: place.start()] + (f" (element {place[1]!r})" if place[1] else "")
    elif (found := _LINE.search(text)) is not None:
        line = found[1]
    if line is not None:
        where = bundle.where(int(line))
    return " ".join(text.split()), where


def _names(bundle: Bundle) -> Iterable[str]:
    stack = [bundle.root]
    while stack:
        element = stack.pop()
        if element.attribute("name"):
            yield element.attribute("name")
        stack += element.children


# ---------------------------------------------------------------------- every element has a name


def name_everything(spec: Any) -> None:
    """Gives a name to each element without one, always the same: bodies by number, others by what they belong to."""
    bodies = list(spec.bodies)
    _name(bodies[1:], "body", lambda _, i: f"body{i + 1}")
    for body in bodies:
        owner = "world" if body.name == "world" else body.name
        _name(body.joints, "", lambda j, i, owner=owner: f"{owner}_{'free' if int(j.type) == 0 else 'joint'}{i or ''}")
        _name(body.geoms, "", lambda _, i, owner=owner: f"{owner}_geom{i}")
        _name(body.sites, "", lambda _, i, owner=owner: f"{owner}_site{i}")
        _name(body.cameras, "", lambda _, i, owner=owner: f"{owner}_camera{i}")
        _name(body.lights, "", lambda _, i, owner=owner: f"{owner}_light{i}")
    _unique(spec)
    for kind in (
        "actuators", "sensors", "equalities", "tendons", "excludes", "pairs", "keys", "textures", "skins", "flexes",
        "materials", "meshes", "hfields",
    ):  # fmt: skip
        word = {"equalities": "equality", "flexes": "flex", "meshes": "mesh"}.get(kind, kind[:-1])
        _name(getattr(spec, kind), word, lambda _, i, word=word: f"{word}{i}")


def _name(elements: Any, _kind: str, named: Any) -> None:
    elements = list(elements)
    taken = {e.name for e in elements if e.name}
    for i, element in enumerate(elements):
        if element.name:
            continue
        name = base = named(element, i)
        k = 1
        while name in taken:
            k += 1
            name = f"{base}_{k}"
        element.name = name
        taken.add(name)


def _unique(spec: Any) -> None:
    """A name made for one body's part may be another body's own: those made later step aside."""
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


# ---------------------------------------------------------------------- what others here ask of the engine


def schema_text() -> str:
    """The engine's own table of elements and attributes."""
    import mujoco

    return str(mujoco.mj_printSchema(False, False))


def first_state(model: Any) -> Any:
    """A state of a model as its file stands, with the poses of all bodies."""
    import mujoco

    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return data


def name_of(model: Any, kind: str, number: int) -> str:
    """The name of an element; `kind` is the engine's word (`BODY`, `JOINT`, ...)."""
    import mujoco

    return str(mujoco.mj_id2name(model, getattr(mujoco.mjtObj, f"mjOBJ_{kind}"), number))


def has_gravity(model: Any) -> bool:
    """Whether the file's flags leave gravity on."""
    import mujoco

    return not int(model.opt.disableflags) & int(mujoco.mjtDisableBit.mjDSBL_GRAVITY)


def may_sleep(model: Any) -> bool:
    """Whether the file's flags let sleep what rests."""
    import mujoco

    return bool(int(model.opt.enableflags) & int(mujoco.mjtEnableBit.mjENBL_SLEEP))

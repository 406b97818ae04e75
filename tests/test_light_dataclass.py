"""Classes of `simkit.light_dataclass` behave as those of Python's decorator."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
from dataclasses import FrozenInstanceError, asdict, field, fields, is_dataclass, replace
from typing import ClassVar

import pytest

from simkit import light_dataclass

PYTHON, LIGHT = dataclasses.dataclass, light_dataclass.dataclass


def point(decorator):
    @decorator(frozen=True, slots=True)
    class Point:
        """A point."""

        x: float
        y: float = 0.0
        names: list[str] = field(default_factory=list)
        length: float = field(init=False, default=1.0)
        kind: ClassVar[str] = "point"

        def double(self):
            return replace(self, x=2 * self.x)

    return Point


def other_shapes(decorator):
    @decorator
    class Open:
        a: int = 1
        made: dict[str, int] = field(default_factory=dict, init=False)
        later: int = field(init=False, default=2)

    @decorator(frozen=True)
    class Frozen:
        a: int
        b: int = field(default=3, repr=False)

        def __post_init__(self):
            if self.a < 0:
                raise ValueError("a is negative")

    @decorator(slots=True, kw_only=True)
    class Keywords:
        b: int = 2
        a: str

    @decorator(frozen=True, eq=False)
    class Identity:
        a: int = 1

    @decorator(frozen=True)
    class OwnMethods:
        a: int = 1

        def __repr__(self):
            return "own"

        def __eq__(self, other):
            return True

        def __hash__(self):
            return 7

    @decorator(frozen=True)
    class OwnEquality:
        a: int = 1

        def __eq__(self, other):
            return True

    @decorator(frozen=True, slots=True)
    class Nothing:
        pass

    @decorator(frozen=True, repr=False)
    class NoText:
        a: int = 1

    @decorator(frozen=True)
    class Compared:
        a: int = 1
        b: list[int] = field(default_factory=list, compare=False)
        c: tuple[int, ...] = field(default=(1, 2), hash=False)

    return Open, Frozen, Keywords, Identity, OwnMethods, OwnEquality, Nothing, Compared, NoText


PAIRS = [*zip((point(PYTHON), *other_shapes(PYTHON)), (point(LIGHT), *other_shapes(LIGHT)), strict=True)]
ARGUMENTS = {"Point": (1.0,), "Frozen": (4,)}


def made(cls):
    return cls(a="text") if cls.__name__ == "Keywords" else cls(*ARGUMENTS.get(cls.__name__, ()))


def outcome(action, *arguments, **keywords):
    """Return the value of a call, or the type and text of its error."""
    try:
        return action(*arguments, **keywords)
    except Exception as error:  # noqa: BLE001 - every error counts
        return type(error), str(error)


@pytest.mark.parametrize("python, light", PAIRS)
def test_texts_values_and_parameters_are_those_of_python(python, light):
    one, other = made(python), made(light)
    assert repr(one).partition(" at 0x")[0] == repr(other).partition(" at 0x")[0]
    assert str(inspect.signature(python)) == str(inspect.signature(light))
    assert python.__match_args__ == light.__match_args__
    assert hasattr(one, "__dict__") == hasattr(other, "__dict__")
    assert [f.name for f in fields(python)] == [f.name for f in fields(light)] and is_dataclass(other)
    assert outcome(asdict, one) == outcome(asdict, other)
    assert repr(python.__dataclass_params__) == repr(light.__dataclass_params__)
    for arguments, keywords in (((), {}), ((1, 2, 3, 4, 5), {}), ((), {"strange": 1}), ((-1,), {})):
        texts = [str(outcome(cls, *arguments, **keywords)) for cls in (python, light)]
        assert texts[0].partition(" at 0x")[0] == texts[1].partition(" at 0x")[0]


@pytest.mark.parametrize("python, light", PAIRS)
def test_equality_and_hash_are_those_of_python(python, light):
    for cls in (python, light):
        assert (made(cls) == made(cls)) == (cls.__name__ != "Identity")
    assert made(python) != made(light) or "Own" in python.__name__
    one, other = outcome(hash, made(python)), outcome(hash, made(light))
    assert one == other or python.__name__ == "Identity"


@pytest.mark.parametrize("python, light", PAIRS)
@pytest.mark.parametrize("name", ["a", "x", "other"])
def test_changes_are_refused_as_by_python(python, light, name):
    one, other = made(python), made(light)
    for action in (lambda item: setattr(item, name, 5), lambda item: delattr(item, name)):
        texts = [str(outcome(action, item)) for item in (one, other)]
        # the error of Python's own class with slots is about `super`
        assert texts[0] == texts[1] or ("super(" in texts[0] and "FrozenInstanceError" in texts[1])


def test_copies_replacements_and_defaults_are_those_of_python():
    light = point(LIGHT)
    first, second = light(1.0), light(1.0)
    first.names.append("a")
    assert second.names == [] and copy.deepcopy(first) == first and first.double() == light(2.0, names=["a"])
    with pytest.raises(FrozenInstanceError, match="cannot assign to field 'x'"):
        first.x = 2.0
    with pytest.raises(ValueError, match="init=False"):
        replace(first, length=3.0)


@LIGHT(frozen=True, slots=True)
class Base:
    """Class whose objects are pickled."""

    a: int
    b: float = float("nan")


@LIGHT(frozen=True, slots=True)
class Derived(Base):
    """Class with the fields of another."""

    c: str = "c"


@PYTHON(frozen=True)
class DerivedByPython(Base):
    """Class of Python's decorator with the fields of a light class."""

    c: str = "c"


@pytest.mark.parametrize("cls", [Base, Derived, DerivedByPython])
def test_objects_are_pickled_and_derived(cls):
    found = cls(1, 2.0)
    again = pickle.loads(pickle.dumps(found))
    assert again == found and hash(again) == hash(found) and again is not found
    assert repr(again).startswith(f"{cls.__name__}(a=1, b=2.0")
    assert Base(1) == Base(1, Base(2).b)  # the same NaN, as in a comparison of tuples
    with pytest.raises(FrozenInstanceError):
        again.a = 2


def test_an_object_that_contains_itself_has_a_text():
    @LIGHT
    class Loop:
        a: object = None

    loop = Loop()
    loop.a = loop
    assert repr(loop).endswith("Loop(a=...)")

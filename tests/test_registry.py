"""Registries: a class is found by the names that its file writes down, and nothing else is imported for it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import pytest

from simkit.loaders import loader_kinds
from simkit.plugins.discovery.find_plugin_class import plugin_kinds
from simkit.registry import Kinds
from simkit.sensors import sensor_kinds

KINDS: tuple[Callable[[], Any], ...] = (plugin_kinds, sensor_kinds, loader_kinds)

ANIMALS = '''"""A package of its own."""


class Animal:
    called: tuple[str, ...] = ()
'''
DOG = """from animals import Animal

names = ("not a class's",)


def bark():
    called = ("nobody",)
    return called


class Dog(Animal):
    called = (
        "Dog",  # "Wolf" is another
        'Hound',
    )


class Cat(Animal):
    called: tuple[str, ...] = ("Cat",)
"""
BIRDS = """from animals import Animal


class Bird(Animal):
    called = tuple(f"bird {n}" for n in range(2))
"""


@pytest.fixture
def animals(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Kinds[Any]]:
    """A registry of the classes in a package of three modules; `broken` cannot be imported."""
    package = tmp_path / "animals"
    (package / "feathered").mkdir(parents=True)
    files = {"__init__": ANIMALS, "dog": DOG, "broken": "raise RuntimeError", "feathered/__init__": ""}
    for name, text in {**files, "feathered/birds": BIRDS}.items():
        (package / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    base = __import__("animals").Animal
    yield Kinds("animals", "animals.nobody", base, lambda cls: [n.lower() for n in cls.called], ("called",), str.lower)
    for name in [n for n in sys.modules if n.partition(".")[0] == "animals"]:
        del sys.modules[name]


@pytest.mark.parametrize("kinds", KINDS)
def test_every_class_is_found_by_the_names_in_its_file(kinds: Callable[[], Any]) -> None:
    full = kinds()
    fresh = Kinds(full._package, full._group, full._base, full._names, full._attributes, full._spell)
    for name in list(full):
        assert name in fresh
        assert fresh[name] is full[name]
    assert set(fresh.written) == set(full)


def test_only_the_module_of_a_class_is_imported_to_find_it(animals: Kinds[Any]) -> None:
    assert animals["hound"].__name__ == "Dog"
    assert animals["cat"].__name__ == "Cat"
    assert "animals.feathered.birds" not in sys.modules


def test_computed_names_are_found(animals: Kinds[Any]) -> None:
    assert animals["bird 1"].__name__ == "Bird"
    assert animals.written == {"dog": "Dog", "hound": "Hound", "cat": "Cat", "bird 0": "bird 0", "bird 1": "bird 1"}


def test_lock_files_of_an_editor_and_missing_folders_have_no_modules(animals: Kinds[Any], tmp_path: Path) -> None:
    (tmp_path / "animals" / ".#dog.py").symlink_to("someone@computer.1234")
    sys.modules["animals"].__path__.append(str(tmp_path / "missing"))
    assert animals["bird 1"].__name__ == "Bird"


@pytest.mark.parametrize("name", ["wolf", "nobody", "not a class's", ""])
def test_a_name_without_a_class_is_not_found(animals: Kinds[Any], name: str) -> None:
    assert name not in animals
    with pytest.raises(KeyError):
        animals[name]


def test_two_classes_with_one_name_are_reported_when_all_classes_are_listed(
    animals: Kinds[Any], tmp_path: Path
) -> None:
    (tmp_path / "animals" / "broken.py").write_text(DOG)
    with pytest.raises(RuntimeError, match=r"'dog' is claimed by animals\.\w+ and by animals\.\w+"):
        len(animals)


def test_an_entry_point_without_a_class_of_the_base_is_skipped_with_a_warning(
    animals: Kinds[Any], caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    points = [EntryPoint("dog", "animals.dog:Dog", "zoo"), EntryPoint("stray", "json", "zoo")]
    monkeypatch.setattr("simkit.registry.entry_points_of", lambda group: points)
    assert [cls.__name__ for source in animals._foreign for cls in animals._classes(source)] == ["Dog"]
    (warning,) = caplog.messages
    assert warning.startswith("package json: entry point stray (json): <module 'json'")
    assert warning.endswith("is not a subclass of Animal")


LOOK_UPS = """
import sys
from simkit.plugins.discovery.find_plugin_class import plugin_kinds
from simkit.sensors import sensor_kinds
assert "imu" in sensor_kinds() and "gz-sim-imu-system" in plugin_kinds() and "no-such-plugin" not in plugin_kinds()
assert not {"zoo.heavy", "zoo.unused"} & set(sys.modules), "a look-up imported the classes of another package"
assert sensor_kinds()["scale"].__name__ == "Scale" and "zoo.unused" not in sys.modules
"""
SCALE = """import simkit.sensors.environment.altimeter


class Scale(simkit.sensors.environment.altimeter.Altimeter):
    kinds = ("scale",)
"""
UNUSED = """from simkit import WorldPlugin


class Unused(WorldPlugin):
    filenames = ("unused",)
"""


def test_a_look_up_imports_no_class_of_other_packages_that_has_another_name(tmp_path: Path) -> None:
    files = {
        "zoo/__init__.py": "",
        "zoo/heavy.py": SCALE,
        "zoo/unused.py": UNUSED,
        "zoo-1.0.dist-info/METADATA": "Metadata-Version: 2.1\nName: zoo\nVersion: 1.0\n",
        "zoo-1.0.dist-info/entry_points.txt": "[simkit.sensors]\nscale = zoo.heavy:Scale\n"
        "[simkit.plugins]\nunused = zoo.unused:Unused\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", LOOK_UPS], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_a_class_of_another_package_with_a_taken_name_is_left_out_of_the_list_with_a_warning(
    animals: Kinds[Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "animals" / "broken.py").unlink()
    (tmp_path / "wolves.py").write_text(DOG)
    points = [EntryPoint("dog", "wolves:Dog", "zoo")]
    monkeypatch.setattr("simkit.registry.entry_points_of", lambda group: points)
    assert animals["dog"].__module__ == "animals.dog", "simkit's own class comes first"
    assert list(animals) == ["bird 0", "bird 1", "cat", "dog", "hound"]
    assert animals["dog"].__module__ == "animals.dog"
    place = f"package wolves: {tmp_path / 'wolves.py'}:11"
    assert caplog.messages == [f"{place}: class Dog cannot have the name 'dog', 'hound' of animals.dog.Dog"]


def test_a_class_that_another_module_defines_is_found_through_its_entry_point(
    animals: Kinds[Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "jackals.py").write_text(DOG.replace('"Dog"', '"Wolf"').replace("'Hound'", "'Jackal'"))
    (tmp_path / "forest.py").write_text("from jackals import Dog")
    points = [EntryPoint("wolf", "forest:Dog", "zoo")]
    monkeypatch.setattr("simkit.registry.entry_points_of", lambda group: points)
    assert animals["jackal"].__module__ == "jackals"


def test_a_load_imports_neither_the_kinds_that_it_does_not_use_nor_the_message_types() -> None:
    program = "import sys, simkit; simkit.load('empty'); print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    imported = set(done.stdout.split())
    assert "simkit.plugins.world.clock_and_statistics" in imported
    unwanted = {
        "simkit.plugins.gz.visual_properties",
        "simkit.sensors.rays.lidar",
        "rosbags",
        "scipy",
        "trimesh",
        "urllib.request",
    }
    assert not unwanted & imported

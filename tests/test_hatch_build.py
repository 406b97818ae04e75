"""The build: declared packs are in the wheel, a missing one stops it, and `SIMKIT_PACKS=none` leaves them out."""

from __future__ import annotations

import importlib.util
import tomllib
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[1]
pytest.importorskip("hatchling")


@pytest.fixture(scope="module")
def build() -> ModuleType:
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A checkout with the packs `boats` and `cars`."""
    monkeypatch.delenv("SIMKIT_PACKS", raising=False)
    (tmp_path / "pyproject.toml").write_text('[tool.simkit]\npacks = ["boats", "cars"]\n')
    for name in ("boats", "cars"):
        package = tmp_path / "packs" / name / f"simkit_{name}"
        package.mkdir(parents=True)
        (package / "__init__.py").touch()
        (package.parent / "pack.toml").write_text(f'name = "{name}"\npackage = "simkit_{name}"\n')
    return tmp_path


def test_each_pack_has_its_entry_point(build: ModuleType, checkout: Path) -> None:
    assert {name: folder.name for name, folder in build.declared_packs(checkout).items()} == {
        "boats": "simkit_boats",
        "cars": "simkit_cars",
    }


def test_the_pytest_plugin_of_a_pack_has_an_entry_point(build: ModuleType, checkout: Path) -> None:
    (checkout / "packs" / "cars" / "simkit_cars" / "pytest_plugin.py").touch()
    hook = build.PackEntryPoints(str(checkout), {"entry-points": {"pytest11": {"simkit": "simkit.pytest_plugin"}}})
    metadata: dict[str, dict[str, dict[str, str]]] = {}
    hook.update(metadata)
    assert metadata["entry-points"] == {
        "pytest11": {"simkit": "simkit.pytest_plugin", "simkit_cars": "simkit_cars.pytest_plugin"},
        "simkit.packs": {"boats": "simkit_boats", "cars": "simkit_cars"},
    }


def test_the_core_alone_has_none(build: ModuleType, checkout: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SIMKIT_PACKS", "none")
    assert build.declared_packs(checkout) == {}
    monkeypatch.setenv("SIMKIT_PACKS", "boats")
    with pytest.raises(ValueError, match="SIMKIT_PACKS=boats: expected all or none"):
        build.declared_packs(checkout)


def test_the_core_alone_has_the_names_of_the_plugins_that_it_lacks(build: ModuleType, checkout: Path) -> None:
    plugins = checkout / "packs" / "boats" / "simkit_boats" / "plugins"
    plugins.mkdir()
    (plugins / "sail.py").write_text(
        """
class Sail:
    filenames: tuple = ()
    filenames = ("libsail.so", "sail-system")
    hooks = ("hoist",)
    size = ("large",)
"""
    )
    (checkout / "packs" / "boats" / "simkit_boats" / "cli").mkdir()
    (checkout / "packs" / "boats" / "simkit_boats" / "cli" / "harbour.py").touch()
    (checkout / "packs" / "boats" / "simkit_boats" / "sensors").mkdir()
    (checkout / "packs" / "boats" / "simkit_boats" / "sensors" / "log.py").write_text(
        "class Log:\n    kinds = ('log', 'chip_log')\n    names = ('no plugin',)\n"
    )
    step = checkout / "packs" / "boats" / "simkit_boats" / "cli" / "demo_steps" / "sailing"
    step.mkdir(parents=True)
    (step / "step.toml").touch()
    names = build.left_out_names(checkout)
    assert names["filenames"] == {"libsail.so": "boats", "sail-system": "boats"}
    assert names["hooks"] == {"hoist": "boats"} and names["entities"] == {} and "size" not in names
    assert names["kinds"] == {"log": "boats", "chip_log": "boats"} and names["names"] == {}
    assert names["commands"] == {"harbour": "boats"} and names["demo_steps"] == {"sailing": "boats"}


@pytest.mark.parametrize(
    ("gone", "says"),
    [
        ("packs/cars/pack.toml", r"declares the packs \['boats', 'cars'\]; the folder packs has \['boats'\]"),
        ("packs/cars/simkit_cars/__init__.py", "names the package simkit_cars, which is missing"),
    ],
)
def test_a_declared_pack_that_is_missing_stops_the_build(
    build: ModuleType, checkout: Path, gone: str, says: str
) -> None:
    (checkout / gone).unlink()
    with pytest.raises(ValueError, match=says):
        build.declared_packs(checkout)


def test_this_checkout_has_the_packs_that_are_installed(build: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    """After a change of the packs in a checkout, `pip install -e .` is needed again."""
    from simkit.packs import shipped_packs

    monkeypatch.delenv("SIMKIT_PACKS", raising=False)
    names = {pack.name: pack.package for pack in shipped_packs()}
    assert names == {name: folder.name for name, folder in build.declared_packs(ROOT).items()}
    table = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert len(names) == len(table["tool"]["simkit"]["packs"])

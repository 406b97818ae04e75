"""Users' names that packs bring: lazy, and with an error that names a missing pack."""

from __future__ import annotations

import subprocess
import sys

import pytest

from simkit.facade import MODULES

NAMES = [name for name in MODULES if name.startswith("simkit.")]
"""Users' names in the package; the others are attributes of its objects."""

WITHOUT_PACKS = """
import sys

class Missing:
    def find_spec(self, name, *_):
        if name.startswith("simkit_"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Missing())
import simkit
"""


def run(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


@pytest.mark.needs_packs
@pytest.mark.parametrize("name", NAMES)
def test_a_name_of_a_pack_is_imported_on_first_use(name: str) -> None:
    text = f"import sys, simkit; print('{MODULES[name]}' in sys.modules, {name} is not None, {name} is {name})"
    assert run(text).split() == ["False", "True", "True"]


@pytest.mark.parametrize("name", NAMES)
def test_without_its_pack_a_name_says_which_pack_is_missing(name: str) -> None:
    pack = MODULES[name].partition(".")[0].removeprefix("simkit_")
    text = f"{WITHOUT_PACKS}\ntry:\n    {name}\nexcept simkit.InputError as error:\n    print(error)"
    assert f"SK-INPUT-004 {name} needs the pack {pack}, which is not installed\n    help: install" in run(text)


@pytest.mark.needs_packs
def test_the_module_and_the_attribute_gym_are_one() -> None:
    check = "print(first is simkit.gym, first.make is simkit.gym.make)"
    code = f"import simkit; first = simkit.gym; import simkit.gym; {check}"
    assert run(code).split() == ["True", "True"]


def test_without_its_pack_the_module_gym_says_which_pack_is_missing() -> None:
    text = f"{WITHOUT_PACKS}\ntry:\n    import simkit.gym\nexcept simkit.InputError as error:\n    print(error)"
    assert "SK-INPUT-004 simkit.gym needs the pack learning" in run(text)

"""Choice of the realism of a run: `ideal`, `datasheet`, the name of a set, or a YAML file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Final

from simkit.diagnostics import Diagnostics, file_hint, name_hint
from simkit.packs import pack_folders
from simkit.scene import SceneModel, SceneWorld
from simkit.sensors.realism.change import Change
from simkit.sensors.realism.datasheet import Datasheet
from simkit.sensors.realism.ideal import Ideal
from simkit.sensors.realism.model_change import change_model
from simkit.sensors.realism.realism_file import FromFile, read_realism_file

IDEAL_OR_DATASHEET: Final = ("datasheet", "ideal")
_SUFFIXES: Final = (".yaml", ".yml")


class Realism:
    """Change of all sensors of a run: of those of the world, and of those of models that are spawned later.

    Args:
        make_change: function that returns a new change for one world or model.
    """

    def __init__(self, make_change: Callable[[Diagnostics], Change]) -> None:
        self._make_change = make_change

    def world(self, world: SceneWorld, diagnostics: Diagnostics) -> SceneWorld:
        """Return a world with changed sensors; notes and errors go to `diagnostics`."""
        change = self._make_change(diagnostics)
        models = tuple(change_model(model, change.sensor, change.plugin) for model in world.models)
        change.report(is_world=True)
        return replace(world, models=models)

    def model(self, model: SceneModel, diagnostics: Diagnostics) -> SceneModel:
        """Return a spawned model with changed sensors."""
        change = self._make_change(diagnostics)
        changed = change_model(model, change.sensor, change.plugin)
        change.report(is_world=False)
        return changed


def is_file_name(choice: str) -> bool:
    """Check whether a choice is the name of a file, not a word or the name of a set."""
    return choice.endswith(_SUFFIXES)


def _find_file(name: str, find: Callable[[str], Path | None]) -> Path | None:
    try:
        return Path(name) if Path(name).is_file() else find(name)
    except (OSError, ValueError):  # the text is not a valid file name
        return None


def realism_sets() -> Mapping[str, Path]:
    """Return the files of the sets of simkit and of the packs, by name."""
    folders = (Path(__file__).parent / "sets", *map(Path, pack_folders("sensors/realism/sets")))
    files = (file for folder in folders for suffix in _SUFFIXES for file in sorted(folder.glob(f"*{suffix}")))
    return {file.stem: file for file in files}


def read_realism(choice: str, find: Callable[[str], Path | None], diagnostics: Diagnostics) -> Realism | None:
    """Return the realism of a choice; None after an error.

    Args:
        choice: `ideal`, `datasheet`, name of a set, or file.
        find: function that finds the file of a path or URI; None if there is no such file.
        diagnostics: collection of the problems.
    """
    if choice == "ideal":
        return Realism(Ideal)
    if choice == "datasheet":
        return Realism(Datasheet)
    sets = realism_sets()
    path = sets.get(choice) or (_find_file(choice, find) if is_file_name(choice) else None)
    if path is None:
        known = (*IDEAL_OR_DATASHEET, *sets)
        if is_file_name(choice):
            message = f"cannot find the file of realism, {choice!r}"
            hint = file_hint(choice, _SUFFIXES) or f"--realism takes FILE or one of {', '.join(known)}"
        else:
            message = f"realism: found {choice!r}, expected {', '.join(known)} or a file that ends with .yaml"
            hint = name_hint(choice, known)
        diagnostics.error("SK-SENSOR-274", message, hint=hint)
        return None
    rules = read_realism_file(path, diagnostics, is_set=choice in sets)
    return None if rules is None else Realism(partial(FromFile, rules=rules))

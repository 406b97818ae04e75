"""Functions that a simulation needs from the code that loaded its world, and the state to which a reset returns."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from simkit.errors import InputError
from simkit.runtime.engine.entity_structure import SensorsAndPlugins
from simkit.scene import SceneModel

if TYPE_CHECKING:
    from simkit.diagnostics import Diagnostics
    from simkit.run_spec import RunSpec
    from simkit.runtime.engine.snapshot import Snapshot
    from simkit.scene import SceneWorld

ModelLoader = Callable[..., SceneModel]
SensorsAndPluginsMaker = Callable[..., SensorsAndPlugins]


@dataclass(frozen=True, kw_only=True)
class WorldSource:
    """Functions that read and write files for a simulation, because this package knows no file format.

    Attributes:
        load_model: function that reads a model to spawn, called as `(source, diagnostics, *, name, pose, taken)`.
        make_parts: function that makes the sensors and plugins of a model and prepares a spec for them.
        leave_out: function that leaves out the sensors and plugins with errors, which become warnings; it returns False
            if there are other errors.
        write_sdf: function that writes a world as SDF text; None for none.
        resolve_world: function that returns the world of the file with other overrides; None for none.
        list_models: function that returns the sources of the models that can be spawned, by name.
        check_source: function that raises InputError for a source that a client may not spawn; None to allow all.
        file_arguments: arguments of the xacro file of the world, with their values.
        xacro_overrides: those of the arguments that overrides gave.
    """

    load_model: ModelLoader
    make_parts: SensorsAndPluginsMaker
    leave_out: Callable[[Diagnostics], bool] = lambda _: False
    write_sdf: Callable[[SceneWorld], str] | None = None
    resolve_world: Callable[[Sequence[str], Diagnostics], SceneWorld] | None = None
    list_models: Callable[[], dict[str, str]] = dict
    check_source: Callable[[str], None] | None = None
    file_arguments: Mapping[str, str] = field(default_factory=dict)
    xacro_overrides: Mapping[str, str] = field(default_factory=dict)


class LoadedState:
    """State to which a reset returns, with the world and the specification that belong to it.

    Args:
        world: world of the state.
        run_spec: specification of the run; None for a simulation that `simkit.load` has not made.

    Attributes:
        world: world of the state.
        run_spec: specification of the run, with the present overrides.
    """

    def __init__(self, world: SceneWorld, run_spec: RunSpec | None) -> None:
        self.world, self.run_spec = world, run_spec
        self._snapshot: Snapshot | None = None

    @property
    def is_complete(self) -> bool:
        """True after the load."""
        return self._snapshot is not None

    @property
    def snapshot(self) -> Snapshot:
        """The state; InputError while the world is being loaded."""
        if self._snapshot is None:
            text = "the world is still being loaded, so there is no state to reset to"
            raise InputError("SK-CORE-004", text, shows_code=False)
        return self._snapshot

    def change(self, snapshot: Snapshot, world: SceneWorld | None = None) -> None:
        """Replace the state, and the world if it differs."""
        self._snapshot = snapshot
        self.world = self.world if world is None else world

    def change_overrides(self, overrides: Sequence[str]) -> None:
        """Replace the overrides in the specification of the run."""
        if self.run_spec is not None:
            self.run_spec = replace(self.run_spec, overrides=tuple(overrides))

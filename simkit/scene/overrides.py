"""`--set PATH=VALUE`: replacement of values of a loaded scene, before anything is built from the scene.

PATH is `physics`, `world`, `scene`, or a scoped entity, then element names with dots:
`tb3::base_scan::lds.update_rate`, `tb3::base_scan::lds.ray.scan.horizontal.samples`, `physics.max_step_size`,
`scene.quality`, `tb3::drive_plugin.max_wheel_torque`. `docs/experiments.md` describes the paths.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from simkit.diagnostics import Diagnostic, did_you_mean
from simkit.errors import InputError
from simkit.number_text import counted
from simkit.pose import Pose
from simkit.scene.entity_paths import AREAS, Entity, EntityPaths, replace_at
from simkit.scene.model import SceneLink, SceneModel, ScenePlugin, SceneSensor
from simkit.scene.override_fields import INERTIA, MASS, MU, MU2, Field, fields_of
from simkit.scene.override_poses import copies, move_held_model, move_link, pose_of, set_pose
from simkit.scene.override_values import POSE, ValueKind
from simkit.scene.param_paths import has_parameter, set_parameter
from simkit.scene.world import Scene, SceneWorld

_CODE = "SK-CLI-014"
SOURCE_PREFIX = "--set "
XACRO = "xacro."


Overrides = Sequence[str] | Mapping[str, object]
"""Texts `PATH=VALUE`, or values by path."""


def override_texts(overrides: Overrides) -> Sequence[str]:
    """Return overrides as texts. Values may be numbers, truth values, texts, and lists of numbers."""
    if not isinstance(overrides, Mapping):
        return overrides
    return tuple(f"{path}={value_text(value)}" for path, value in overrides.items())


def value_text(value: object) -> str:
    """Return a value as the text of an override; numbers keep all their bits."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str) or not hasattr(value, "__iter__"):
        return str(value)
    return " ".join(map(value_text, value))


def apply_overrides(scene: Scene, overrides: Sequence[str]) -> Scene:
    """Return the scene with every `PATH=VALUE` applied, in the given order; numbers of copies come first.

    Raises:
        InputError: SK-CLI-014 no such entity or element (the closest is named), or an invalid value.
    """
    if not overrides:
        return scene
    problems = _Problems()
    parsed = []
    for text in overrides:
        with problems:
            item = _Override(text)
            if not item.is_argument(scene):
                parsed.append(item)
    world = scene.world
    for item in (item for item in parsed if item.path.endswith(".count")):
        with problems:
            world = item.copy_model(world)
    paths = EntityPaths(world)
    rest, explicit = [], set()
    for item in (item for item in parsed if not item.path.endswith(".count")):
        with problems:
            explicit |= {(target.path, field) for target, field in item.named(paths)}
            rest.append(item)
    for item in rest:
        with problems:
            world = paths.world = item.apply(world, paths, explicit)
    problems.raise_if_any()
    return _with_world(scene, world, parsed)


class _Problems:
    """Errors of overrides, which are raised together."""

    def __init__(self) -> None:
        self._found: list[str] = []

    def __enter__(self) -> None:
        """Begin to collect the error of one override."""

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> bool:
        if isinstance(error, InputError):
            self._found.append(str(error))
            return True
        return False

    def raise_if_any(self) -> None:
        """Raise one InputError with all errors."""
        if self._found:
            raise InputError(_CODE, "\n".join(self._found), shows_code=False)


def xacro_overrides(overrides: Sequence[str]) -> dict[str, str]:
    """Return the arguments for a xacro file among the overrides, which have the form `xacro.NAME=VALUE`."""
    parsed = (_Override(text) for text in overrides if text.strip().startswith(XACRO))
    return {item.path.removeprefix(XACRO): item.value for item in parsed}


def _with_world(scene: Scene, world: SceneWorld, parsed: Sequence[_Override]) -> Scene:
    """Return the scene with a changed world in the form in which it was loaded."""
    placed = {item.path.rpartition(".pose")[0] for item in parsed if item.path.endswith((".pose", ".pose.z"))}
    standing = tuple(name for name in scene.standing if name not in placed)
    if scene.worlds:
        return replace(scene, worlds=(world, *scene.worlds[1:]), standing=standing)
    if scene.model is not None and len(world.models) == 1:
        return replace(scene, model=world.models[0], around=replace(world, models=()), standing=standing)
    return replace(scene, worlds=(world,), model=None, light=None, around=None, standing=standing)


def check_used(diagnostics: Iterable[Diagnostic]) -> None:
    """Raise an error if an override was not read, because the sensor or plugin has no element of that name.

    Raises:
        InputError: SK-CLI-014 with the closest name.
    """
    for problem in diagnostics:
        if problem.code == "SK-PARAM-003" and (problem.file or "").startswith(SOURCE_PREFIX):
            hint = f"; {problem.hint}" if problem.hint else ""
            raise InputError(_CODE, f"{problem.file}: {problem.message}{hint}")


class _Override:
    """One override, which returns changed copies of the world."""

    def __init__(self, text: str) -> None:
        path, equals, value = text.partition("=")
        self.text, self.path, self.value = text, path.strip(), value.strip()
        if not equals or not self.path:
            raise self._error("write PATH=VALUE, such as physics.max_step_size=0.002")

    def _error(self, reason: str) -> InputError:
        return InputError(_CODE, f"{SOURCE_PREFIX}{self.text}: {reason}")

    def is_argument(self, scene: Scene) -> bool:
        """Check whether the override is an argument of a xacro file, which was used when the file was read."""
        name = self.path.removeprefix(XACRO)
        if name == self.path:
            return False
        if name not in scene.arguments:
            hint = did_you_mean(name, scene.arguments) or _listed(list(scene.arguments))
            raise self._error(f"the file has no xacro argument {name!r}; {hint}")
        return True

    # ------------------------------------------------------------------ copies

    def copy_model(self, world: SceneWorld) -> SceneWorld:
        """Return the world with several copies of a model."""
        name = self.path.removesuffix(".count")
        names = [model.name for model in world.models]
        if name not in names:
            raise self._error(f"only a top-level model has a count; {did_you_mean(name, names) or _listed(names)}")
        if not self.value.isascii() or not self.value.isdigit():
            raise self._error(f"found {self.value!r}; expected a whole number of at least 0")
        model = world.models[names.index(name)]
        if int(self.value) == 1:
            return world
        if any(nested.mjcf is not None for nested in model.all_models()):
            raise self._error("a model in MuJoCo's own format cannot be copied; spawn its file several times")
        new = copies(model, int(self.value))
        taken = {m.name for m in new} & {n for n in names if n != name}
        if taken:
            raise self._error(f"the world has a model {min(taken)!r} already")
        at = names.index(name)
        return replace(world, models=(*world.models[:at], *new, *world.models[at + 1 :]))

    # ------------------------------------------------------------------ finding the entities

    def named(self, paths: EntityPaths) -> list[tuple[Entity, str]]:
        """Return the entities that the path names, each with the element below it; raise InputError without any."""
        entities = paths.find(self.path)
        if entities:
            return [(entity, _full_element(paths.item(entity), element)) for entity, element in entities]
        if paths.has(self.path) or self.path in AREAS:
            raise self._error(f"{self.path!r} needs an element, as in {self.path}.element=value")
        outer, colons, last = self.path.rpartition("::")
        unknown = outer + colons + last.split(".")[0]
        hint = did_you_mean(unknown, paths.names()) or "simkit inspect --paths lists all paths"
        raise self._error(f"no entity {unknown!r}; {hint}")

    # ------------------------------------------------------------------ changing them

    def apply(self, world: SceneWorld, paths: EntityPaths, explicit: set[tuple[str, str]]) -> SceneWorld:
        """Return the world in which every entity that the path names has the new value.

        Args:
            world: the world.
            paths: its entities by path.
            explicit: all entities and elements that the overrides name.
        """
        targets = self.named(paths)
        if "*" in self.path:  # a pattern adds no element to a sensor or plugin if another entity has the element
            targets = [t for t in targets if _has_element(paths.item(t[0]), t[1])] or targets
        refusals: list[InputError] = []
        for entity, element in targets:
            paths.world = world
            try:
                world = self._changed(world, paths, entity, element, explicit)
            except _NoElementError as refusal:
                refusals.append(refusal)
        if len(refusals) == len(targets):
            raise refusals[0]
        return world

    def _changed(
        self, world: SceneWorld, paths: EntityPaths, entity: Entity, element: str, explicit: set[tuple[str, str]]
    ) -> SceneWorld:
        item, holders = paths.item(entity), paths.holders(entity)
        if element == "pose" or element.startswith("pose."):
            return self._moved(world, entity, item, holders, element)
        field_name, part, field = _field_of(entity, item, element)
        if field is not None:
            new = self._written(item, field, part)
            if field.element == MU and (entity.path, MU2) in explicit:
                new = replace(new, surface=replace(new.surface, mu2=item.surface.mu2))
            if field.element == MASS and any((entity.path, e) in explicit for e in (INERTIA, *_inertia_parts())):
                new = replace(new, inertial=replace(new.inertial, inertia=item.inertial.inertia))
            if (isinstance(item, SceneSensor) and field_name == "update_rate") or (
                isinstance(item, SceneSensor) and field_name == "topic"
            ):
                new = self._with_parameter(new, field_name)
        elif isinstance(item, (SceneSensor, ScenePlugin)):
            if element in ("name", "type"):
                raise self._error(f"<{element}> cannot be set")
            new = self._with_parameter(item, element)
        else:
            raise self._no_element(entity, item, element)
        return replace_at(world, entity.location, new) if new is not item else world

    def _with_parameter(self, item: Any, element: str) -> Any:
        try:
            return replace(item, params=set_parameter(item.params, element, self.value, SOURCE_PREFIX + self.text))
        except ValueError as problem:
            raise self._error(str(problem)) from None

    def _written(self, item: Any, field: Field, part: str) -> Any:
        old = field.read(item)
        if old is None and part:
            raise self._error(f"{field.element!r} has no value yet; set all components together")
        value = self._parsed(field.kind, old, part)
        return item if value is old else field.write(item, value)

    def _parsed(self, kind: ValueKind, old: object, part: str) -> Any:
        """Return the new value; the old object if the text is that of the old value."""
        text = kind.replace_part(old, part, self.value) if part else self.value
        if old is not None and text == kind.format(old):
            return old
        try:
            return kind.parse(text)
        except (ValueError, OverflowError):
            allowed = "a number" if part else kind.allowed
            raise self._error(f"found {self.value!r}; expected {allowed}") from None

    def _moved(self, world: SceneWorld, entity: Entity, item: object, holders: list[Any], element: str) -> SceneWorld:
        old = pose_of(item, holders)
        part = element.removeprefix("pose").removeprefix(".")
        if old is None or (part and part not in POSE.parts):
            raise self._no_element(entity, item, element)
        pose: Pose = self._parsed(POSE, old, part)
        if part in ("x", "y", "z") or self.value.split()[3:] == POSE.format(old).split()[3:]:
            pose = old if pose is old else Pose(pose.position, old.quaternion)  # the rotation keeps its exact bits
        if pose is old:
            return world
        owner = entity.location[:-1]
        if isinstance(item, SceneModel):
            return replace_at(world, owner, move_held_model(holders[-1], item, pose))
        if isinstance(item, SceneLink):
            return replace_at(world, owner, move_link(holders[-1], item, pose))
        return replace_at(world, entity.location, set_pose(item, pose, holders))

    def _no_element(self, entity: Entity, item: Any, element: str) -> InputError:
        known = [field.element for field in _all_fields(entity, item)]
        known += ["pose"] if not entity.path or entity.path not in AREAS else []
        if element.startswith("axis2.") and not any(name.startswith("axis2.") for name in known):
            return _NoElementError(self._error(f"joint {entity.path!r} has {counted(len(item.axes), 'axis', 'axes')}"))
        ends = {name.rpartition(".")[2]: name for name in known}
        hint = did_you_mean(element, [*known, *ends]) or _listed(known)
        return _NoElementError(self._error(f"the element {element!r} cannot be set here; {hint}"))


class _NoElementError(InputError):
    """Refusal of an entity that has no such element; another entity of the same name may have it."""

    def __init__(self, error: InputError) -> None:
        super().__init__(_CODE, str(error), shows_code=False)


def _listed(names: Sequence[str]) -> str:
    return "expected " + ", ".join(names) if names else "there is none"


def _inertia_parts() -> list[str]:
    return [f"{INERTIA}.{part}" for part in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")]


def _all_fields(entity: Entity, item: object) -> Sequence[Field]:
    return AREAS.get(entity.area) or fields_of(item)


def _full_element(item: object, element: str) -> str:
    """Return the full name of an element that is written without its first names, such as `mu`."""
    known = [field.element for field in fields_of(item)]
    head = next((name for name in known if element == name or element.startswith(name + ".")), None)
    if head is not None or isinstance(item, (SceneSensor, ScenePlugin)):
        return element
    ends = [name for name in known if name.endswith("." + element)]
    if not ends:
        last = element.rpartition(".")[0]
        ends = [f"{name}.{element.rpartition('.')[2]}" for name in known if last and name.endswith("." + last)]
    return ends[0] if len(ends) == 1 else element


def _has_element(item: object, element: str) -> bool:
    """Check whether an entity has an element; a sensor or plugin may read elements that its file leaves out."""
    if element.split(".")[0] == "pose":
        return not isinstance(item, ScenePlugin)
    if isinstance(item, (SceneSensor, ScenePlugin)) and has_parameter(item.params, element):
        return True
    return any(element == f.element or element.rpartition(".")[0] == f.element for f in fields_of(item))


def _field_of(entity: Entity, item: object, element: str) -> tuple[str, str, Field | None]:
    """Return the field's element, the component or an empty text, and the field; None for the field if unknown."""
    for field in _all_fields(entity, item):
        if element == field.element:
            return element, "", field
        head, _, part = element.rpartition(".")
        if head == field.element and part in field.kind.parts:
            return head, part, field
    return element, "", None

"""Simulation as an environment of Gymnasium."""

from __future__ import annotations

import copy
import pickle
from array import array
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final, NoReturn, SupportsFloat, cast

import gymnasium
import numpy as np
import numpy.typing as npt

from simkit import Plugin, Simulation, apply_overrides, render_view
from simkit.diagnostics import shorten
from simkit.errors import ArgumentTypeError, InputError, SimulationDiverged
from simkit.plugins.discovery.python_plugins import copied_plugins
from simkit.scene.overrides import override_texts
from simkit.testing import count_left_out, log_left_out, newly_left_out, open_scenario
from simkit.testing.conditions.binder import bind_value
from simkit.testing.conditions.syntax_tree import UndecidedValue
from simkit.testing.conditions.value_types import NUMBER, TRUTH
from simkit.testing.conditions.world_view import WorldView
from simkit_learning.environments.actions import Actions
from simkit_learning.environments.observations import Observations, no_message
from simkit_learning.environments.specification import (
    EnvironmentSpec,
    Info,
    Problems,
    ResetOptions,
    Value,
    invalid,
)
from simkit_learning.sweeps.parameter_space import (
    InvalidSpace,
    ParameterSpace,
    ParameterValue,
    Spaces,
    Values,
    parameter_space,
)
from simkit_learning.sweeps.sweep_spec import fill_template, split_values

IMAGE_SIZE: Final = (480, 360)
"""Width and height of the images of `render` [px]."""
_LONGEST_WAIT: Final = 1.0  # [s] of simulated time for the first message of an observed topic


_OF_EPISODE: Final = (
    *("values", "memory", "action", "observation", "first_tick", "last_tick", "np_random"),
    *("_has_ended", "_begun", "_sent", "_is_seeded"),
)
"""Attributes of an episode; a new episode has new objects."""


@dataclass(frozen=True, slots=True)
class EpisodeState:
    """State of an environment that `SimulationEnv.restore_episode` brings back.

    Attributes:
        snapshot: state of the simulation.
        attributes: attributes of the environment.
        variables: values that occur in expressions.
        positions: integrated positions of commanded velocities.
        messages: newest messages of the observed topics.
    """

    snapshot: Any
    attributes: tuple[Any, ...]
    variables: Values
    positions: tuple[npt.NDArray[np.float64] | None, ...]
    messages: Mapping[str, object]


class SimulationEnv(gymnasium.Env[Any, Any]):
    """Environment of a simulated world; `simkit.gym.make` makes it.

    The same seed and the same actions give the same observations and rewards, bit for bit. A run without a seed in
    `reset` uses the seed of the run specification.

    Args:
        spec: specification.
        render_mode: "rgb_array" for images by `render`; None for none.
        size: width and height of the images [px].

    Attributes:
        spec_of_env: specification.
        sim, values, memory, action, observation: as `specification.Environment` describes them.
        first_tick: tick at which the episode began.
        last_tick: tick at which the episode is truncated; None for no limit.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012 (Gymnasium's type)

    observation_space: Any  # a box, or a dictionary of boxes by name
    sim: Simulation
    _loaded_overrides: tuple[str, ...]
    steps: int
    first_tick: int
    last_tick: int | None
    observations: Observations
    actions: Actions
    _reward: Callable[[], SupportsFloat]
    _terminated: Callable[[], SupportsFloat]
    _success: Callable[[], SupportsFloat] | None
    _expressions: dict[str, Callable[[], SupportsFloat]]
    _begun: tuple[Mapping[str, object], ResetOptions | None] | None

    def __init__(
        self, spec: EnvironmentSpec, render_mode: str | None = None, size: tuple[int, int] = IMAGE_SIZE
    ) -> None:
        if render_mode is not None and (not isinstance(render_mode, str) or render_mode != "rgb_array"):
            raise invalid(f"render_mode: found {render_mode!r}; expected 'rgb_array' or None")
        if not (isinstance(size, (tuple, list)) and len(size) == 2 and all(type(n) is int and n > 0 for n in size)):
            raise invalid(f"size: found {size!r}; expected width and height of the images, such as (480, 360)")
        self.spec_of_env, self.render_mode, self._size = spec, render_mode, (size[0], size[1])
        self._is_closed = self._has_ended = False
        self.metadata = {**self.metadata, "render_fps": max(1, round(1.0 / spec.control_period))}
        self._spaces = _parameter_spaces(spec.randomise)
        self.values: Values = {}
        self.memory: dict[str, Any] = {}
        self._variables: Values = {}
        self._is_seeded = False
        self._begun = None
        self._sent = array("d")  # eight bytes for each number of an action of the episode, for `clone`
        self.np_random = np.random.default_rng(spec.run.seed)
        self._draw(self.np_random, {})
        self._open(self._overrides())
        self._begin(spec.run.seed)
        self.observation_space = self.observations.space
        self.action_space = self.actions.space

    # ------------------------------------------------------------------ Gymnasium

    def reset(self, *, seed: int | None = None, options: ResetOptions | None = None) -> tuple[Any, Info]:
        """Begin an episode.

        Args:
            seed: seed of everything that is drawn from now on; None continues.
            options: `{"values": {name: value}}` sets values instead of drawing them.

        Returns:
            First observation and info.
        """
        self.check_open()
        if seed is not None and (isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0):
            raise invalid(f"reset: found the seed {seed!r}; expected a whole number of at least 0, or None")
        values = self._checked_values(options)
        if seed is None and not self._is_seeded:
            seed = self.spec_of_env.run.seed
        super().reset(seed=None if seed is None else int(seed))
        self._is_seeded = True
        self._begun = self.np_random.bit_generator.state, options
        self._draw(self.np_random, values)
        self._apply_values(int(self.np_random.integers(1 << 31)))
        self._has_ended = False
        return self.observation, self._info()

    def step(self, action: npt.ArrayLike) -> tuple[Any, float, bool, bool, Info]:
        """Send an action, advance by one control period, and return observation, reward, both ends, and info.

        A simulation that diverges truncates the episode; the info then has the text of the error as "diverged". A node
        that ends the run truncates it, too.
        """
        if self._begun is None or self._has_ended or self._is_closed:
            self.check_open()
            problem = "after the end of the episode" if self._has_ended else "before reset"
            raise invalid(f"step was called {problem}", "call reset first", "SK-GYM-005")
        self.action = self.actions.send(action)
        self._sent.extend(self.action)
        try:
            self.sim.step(self.steps)
            self.sim.check_nodes()
            self.observation = self.observations.read()
        except SimulationDiverged as error:
            self._has_ended = True
            return self.observation, 0.0, False, True, {"time": self.sim.time, "diverged": str(error)}
        reward, is_over = float(self._reward()), bool(self._terminated())
        is_late = bool(self.sim.ended_by) or (self.last_tick is not None and self.sim.tick >= self.last_tick)
        self._has_ended = is_over or is_late
        return self.observation, reward, is_over, is_late and not is_over, self._info()

    def render(self) -> npt.NDArray[np.uint8] | None:
        """Return an image of the world from outside, shape (height, width, 3)."""
        if self.render_mode is None:
            return None
        return render_view(self.sim, *self._size)

    def close(self) -> None:
        """Close the world; a second call has no effect."""
        self._is_closed = True
        self._close_world()

    def __reduce__(self) -> NoReturn:
        reason = "an environment cannot be pickled, because it holds a simulation of this process"
        raise ArgumentTypeError(f"{reason}; pickle env.spec_of_env and make simkit.gym.SimulationEnv of it")

    def check_open(self) -> None:
        if self._is_closed:
            raise invalid("the environment is closed", "make it again with simkit.gym.make", "SK-GYM-005")

    def _close_world(self) -> None:
        if "sim" in vars(self):
            self._view_of_sim.close()
            self.sim.close()

    # ------------------------------------------------------------------ copies

    def clone(self) -> SimulationEnv:
        """Return another environment in the same state; the same actions then give the same results.

        The copy loads its own world and restores a snapshot; it repeats the episode if the state is not only numbers.
        """
        self.check_open()
        other = SimulationEnv(self.spec_of_env, self.render_mode, self._size)
        if self._begun is None:
            return other
        other._is_seeded = True
        other.np_random = np.random.Generator(type(self.np_random.bit_generator)())
        if not self._copy_state(other):
            self._repeat(other)
        other.np_random.bit_generator.state = self.np_random.bit_generator.state
        return other

    def episode_state(self) -> EpisodeState:
        """Return the present state, for `restore_episode` of this environment."""
        snapshot = self.sim.snapshot(compact=True)
        attributes = tuple(getattr(self, name) for name in _OF_EPISODE)
        positions = tuple(None if each.wanted is None else each.wanted.copy() for each in self.actions.integrals)
        return EpisodeState(snapshot, attributes, self._variables, positions, self._view_of_sim.present_messages())

    def restore_episode(self, state: EpisodeState) -> None:
        """Return to a state of another episode of this environment."""
        for name, value in zip(_OF_EPISODE, state.attributes, strict=True):
            setattr(self, name, value)
        if state.variables != self._variables:
            self._variables = state.variables
            if self._uses_variables:
                self._bind()
        self.sim.restore(state.snapshot)
        self._view_of_sim.restore_messages(state.messages)
        for integral, wanted in zip(self.actions.integrals, state.positions, strict=True):
            integral.wanted = None if wanted is None else wanted.copy()

    def _copy_state(self, other: SimulationEnv) -> bool:
        """Bring a new environment of this specification into the present state by a snapshot.

        Returns:
            False, and the other is unchanged, if expressions have messages or histories, the drawn values have loaded
            another world, or the memory has objects of the simulation.
        """
        if self._view_of_sim.remembers or self._loaded_overrides != other._loaded_overrides:
            return False
        try:
            memory, snapshot = pickle.dumps(self.memory), pickle.dumps(self.sim.snapshot())
        except (TypeError, AttributeError, pickle.PicklingError):
            return False
        other.values, other._variables = dict(self.values), self._variables
        if other._uses_variables:
            other._bind()
        other.sim.restore(pickle.loads(snapshot))
        other.memory = pickle.loads(memory)
        other.action, other.observation = self.action.copy(), copy.deepcopy(self.observation)
        for name in ("first_tick", "last_tick", "_has_ended", "_begun", "_sent"):
            setattr(other, name, copy.deepcopy(getattr(self, name)))
        for mine, copied in zip(self.actions.integrals, other.actions.integrals, strict=True):
            copied.wanted = None if mine.wanted is None else mine.wanted.copy()
        return True

    def _repeat(self, other: SimulationEnv) -> None:
        """Repeat the episode so far in another environment."""
        assert self._begun is not None
        state, options = self._begun
        other.np_random.bit_generator.state = copy.deepcopy(state)
        other.reset(options=dict(options) if options else None)
        for action in np.array(self._sent).reshape(-1, len(self.actions.names)):
            other.step(action)

    # ------------------------------------------------------------------ for functions of the environment

    @property
    def time(self) -> float:
        """Simulated time since the reset [s]."""
        return (self.sim.tick - self.first_tick) * self.sim.timestep

    @property
    def view(self) -> WorldView:
        """View of the world for expressions."""
        return self._view_of_sim

    def expression(self, source: str) -> Callable[[], SupportsFloat]:
        """Return a function that returns the present value of an expression; it is kept for later episodes.

        Raises:
            InputError: the expression has an error, or its value is not a number, true or false.
        """
        text = self.with_variables(source)
        if text not in self._expressions:
            self._expressions[text] = self._getter(text)
        return self._expressions[text]

    def with_variables(self, text: str) -> str:
        """Return a text in which each `{name}` of a variable is replaced by its value."""
        return str(fill_template(text, self._variables)) if self._variables else text

    # ------------------------------------------------------------------ episodes

    def _checked_values(self, options: object) -> Values:
        """Return the values that the options of `reset` set."""
        if options is None:
            return {}
        values = options.get("values", {}) if isinstance(options, Mapping) else {}
        if not isinstance(values, Mapping) or not isinstance(options, (Mapping, type(None))):
            raise invalid(
                f'reset: found the options {shorten(repr(options), 60)}; expected {{"values": {{name: value}}}}'
            )
        unknown = [name for name in values if name not in self.values]
        unknown += [f"options[{name!r}]" for name in options or {} if name != "values"]
        if unknown:
            known = ", ".join(self.values) or "none"
            raise invalid(f"reset: found {', '.join(map(str, unknown))}; the values of this environment are: {known}")
        return dict(values)

    def _draw(self, random: np.random.Generator, values: Values) -> None:
        """Draw the values of an episode; `values` replaces some of them."""
        drawn: dict[str, ParameterValue] = {}
        for space in self._spaces:
            if space.levels is not None:
                drawn[space.names[0]] = space.levels[int(random.integers(len(space.levels)))]
            else:
                drawn.update(space.values(random.random(len(space.names)).tolist()))
        self.values = {**drawn, **values}
        self._variables = split_values(self.values)[1]

    def _overrides(self) -> tuple[str, ...]:
        return (*self.spec_of_env.run.overrides, *override_texts(split_values(self.values)[0]))

    def _apply_values(self, seed: int) -> None:
        """Reset the world with the present values."""
        overrides, was_opened = self._overrides(), False
        if overrides == self._loaded_overrides:
            self.sim.reset(seed)
        elif apply_overrides(self.sim, overrides, seed):
            self._loaded_overrides = overrides
        else:
            self._close_world()
            self._open(overrides)
            self.sim.reset(seed)
            was_opened = True
        if not was_opened and (self._uses_variables or self._view_of_sim.remembers or self.sim.nodes):
            self._bind_when_possible()  # without messages, counts and histories of the last episode
        self._begin(seed)

    def _begin(self, seed: int) -> None:
        """Begin the episode at the present state: call `on_reset` and make the first observation."""
        spec = self.spec_of_env
        self.memory, self._sent = {}, array("d")
        self.actions.clear()
        self.action = np.zeros(len(self.actions.names))
        if spec.on_reset is not None:
            spec.on_reset(self)
        waited = 0.0
        while True:
            try:
                self.observation = self.observations.read()
                break
            except UndecidedValue as reason:
                if waited >= _LONGEST_WAIT:
                    raise no_message(reason, waited) from None
                self.sim.step(self.steps)
                waited += spec.control_period
        self.first_tick = self.sim.tick
        limit = spec.time_limit
        self.last_tick = None if limit is None else self.first_tick + max(1, round(limit / self.sim.timestep))

    def _info(self) -> Info:
        info: Info = {"time": self.time}
        if self._success is not None:
            info["is_success"] = bool(self._success())
        return info

    # ------------------------------------------------------------------ the world

    def _open(self, overrides: tuple[str, ...]) -> None:
        spec = self.spec_of_env
        _check_unused(spec.run.plugins)
        run = replace(spec.run, overrides=overrides, plugins=copied_plugins(spec.run.plugins))
        self.sim = open_scenario(run)
        self._check_left_out()
        self._loaded_overrides = overrides
        self.steps = round(spec.control_period / self.sim.timestep)
        if self.steps < 1 or abs(self.steps * self.sim.timestep - spec.control_period) > 1e-9:
            period, step = spec.control_period, self.sim.timestep
            self.sim.close()
            raise invalid(f"control_period: found {period:g} s; expected a multiple of the step, {step:g} s")
        self._view_of_sim = WorldView(self.sim)
        try:
            self._bind_when_possible()
        except BaseException:
            self.sim.close()
            raise

    def _check_left_out(self) -> None:
        """Store and log what the world runs without; a later world may not lack more."""
        now = count_left_out(self.sim.diagnostics)
        if "left_out" not in self.metadata:
            self.metadata["left_out"] = now
            log_left_out(now)
        if names := newly_left_out(self.metadata["left_out"], now):
            self.sim.close()
            text = f"with the values {self.values} the world is without {', '.join(names)}, which it had before"
            raise invalid(text, "remove these values from randomise, or correct the world", "SK-GYM-006")

    def _bind_when_possible(self) -> None:
        """Bind, after the nodes of the run had time to create their topics, such as those of spawned controllers."""
        waited = 0.0
        while True:
            try:
                self._bind()
                return
            except InputError:
                if not self.sim.nodes or waited >= _LONGEST_WAIT:
                    raise
            self.sim.step(self.steps)
            self.sim.check_nodes()
            waited += self.spec_of_env.control_period

    def _bind(self) -> None:
        """Bind observations, actions, reward and ends to the simulation."""
        spec, problems = self.spec_of_env, Problems()
        self._view_of_sim.close()
        self._view_of_sim = WorldView(self.sim)
        self._expressions = {}
        try:
            self.observations = Observations(self, spec.observation, spec.sync)
        except InputError as error:
            problems.add(error, "")
        if "actions" not in vars(self) or self.actions.sim is not self.sim:
            try:
                self.actions = Actions(self.sim, spec.action, spec.control_period, spec.scaled_actions)
            except InputError as error:
                problems.add(error, "")
        getters: dict[str, Callable[[], SupportsFloat]] = {}
        for name in ("reward", "terminated", "success"):
            value = getattr(spec, name)
            try:
                getters[name] = self._getter(value)
            except InputError as error:
                problems.add(error, name)
        problems.raise_all()
        self._reward, self._terminated = getters["reward"], getters["terminated"]
        self._success = getters["success"] if spec.success is not None else None
        self._view_of_sim.open()
        if not spec.samples_all:
            self.observations.take_over_sensors()

    @property
    def _uses_variables(self) -> bool:
        """True if expressions contain variables, whose values are new in each episode."""
        if not self._variables:
            return False
        spec = self.spec_of_env
        texts = str((spec.observation, spec.reward, spec.terminated, spec.success))
        return any("{" + name + "}" in texts for name in self._variables)

    def _getter(self, value: Value | None) -> Callable[[], SupportsFloat]:
        """Return the function that returns the present value of a reward or an end."""
        if not isinstance(value, str):
            return (lambda: value(self)) if callable(value) else (lambda: value or 0.0)
        part = bind_value(self.with_variables(value), self._view_of_sim, (NUMBER, TRUTH), "the value")

        def get() -> SupportsFloat:
            try:
                return cast(SupportsFloat, part.get())
            except UndecidedValue:
                return 0.0

        return get


def _check_unused(plugins: Iterable[object]) -> None:
    """Check that no open simulation has loaded one of the plugins; it would stop following its commands.

    Raises:
        InputError: SK-GYM-001 an open simulation has loaded a plugin.
    """
    for item in plugins:
        plugin = item[1] if isinstance(item, tuple) and len(item) == 2 else item
        if isinstance(plugin, Plugin) and "sim" in vars(plugin) and not plugin.sim.engine.is_closed:
            name = type(plugin).__name__
            raise invalid(f"plugins: an open simulation has loaded this {name}", f"create another one: {name}(...)")


def _parameter_spaces(randomise: Spaces) -> list[ParameterSpace]:
    problems, spaces = Problems(), []
    for names, description in randomise.items():
        try:
            spaces.append(parameter_space(names, description))
        except InvalidSpace as error:
            problems.add(invalid(str(error)), f"randomise {names!r}")
    problems.raise_all()
    return spaces

"""Specification of an environment for learning: a run, observations, actions, reward, end and random values."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Generic, Literal, Protocol, SupportsFloat, TypeAlias, TypedDict, TypeVar

from simkit import RunSpec
from simkit.diagnostics import shorten
from simkit.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from simkit import Simulation
    from simkit.scene.overrides import Overrides
    from simkit.testing.conditions.world_view import WorldView
    from simkit_learning.environments.array_view import ArrayView
    from simkit_learning.environments.message_arrays import Array
    from simkit_learning.sweeps.parameter_space import Spaces, Values

INVALID: Final = "SK-GYM-001"
INVALID_ACTION: Final = "SK-GYM-002"
NO_MESSAGE: Final = "SK-GYM-003"

Autoreset = Literal["next_step", "same_step", "disabled"]
"""Start of the next episode of several environments, as Gymnasium defines these words."""
Info: TypeAlias = dict[str, Any]
"""Further results of a reset or a step by name, as Gymnasium defines them."""
ResetOptions: TypeAlias = dict[str, Any]
"""Options of `reset` by name, as Gymnasium defines them."""
Result = TypeVar("Result", covariant=True)
"""Result of a function of an environment: a number or an array."""


class Environment(Protocol):
    """Environment as its functions use it.

    Attributes:
        sim: simulation; its state may be read at any time, without noise.
        values: values drawn at the last reset, by path or name of a variable.
        memory: data of functions of the environment; empty after each reset.
        action: last action within its bounds; zeros after a reset.
        observation: last observation.
    """

    sim: Simulation
    values: Values
    memory: dict[str, Any]
    action: npt.NDArray[np.float64]
    observation: Array | dict[str, Array]

    @property
    def np_random(self) -> np.random.Generator:
        """Random numbers of the environment, from the seed of `reset`."""

    @property
    def time(self) -> float:
        """Simulated time since the reset [s]."""

    @property
    def view(self) -> WorldView:
        """View of the world for expressions."""

    def expression(self, source: str) -> Callable[[], SupportsFloat]:
        """Return a function that returns the present value of an expression."""

    def with_variables(self, text: str) -> str:
        """Return a text in which each `{name}` of a variable is replaced by its value."""


@dataclass(frozen=True)
class Batched(Generic[Result]):
    """Function of one environment, with the same function of all environments of a batch.

    Attributes:
        of_one: function of an environment.
        of_all: function of an `ArrayView`, whose arrays have the environment as their first axis.
    """

    of_one: Callable[[Environment], Result]
    of_all: Callable[[ArrayView], npt.ArrayLike]

    def __call__(self, env: Environment) -> Result:
        return self.of_one(env)


Value = str | float | bool | Callable[[Environment], SupportsFloat]
"""Number, expression of the condition language, or function of the environment."""


@dataclass(frozen=True)
class Observation:
    """Source of one observation, with bounds.

    Attributes:
        source: topic, scoped name of a sensor, joint, link or model, expression, or function of the environment.
        low, high: bounds of the values, for all or for each; None for the bounds of the source.
        truth: observe a sensor without its noise.
        sectors: number of equal groups of neighbouring values; the observation has the smallest value of each group.
            None for all values.
    """

    source: str | Callable[[Environment], npt.ArrayLike]
    low: npt.ArrayLike | None = None
    high: npt.ArrayLike | None = None
    truth: bool = False
    sectors: int | None = None


@dataclass(frozen=True)
class JointVelocities:
    """Action on a trajectory controller: velocities, which are integrated to positions within the joint limits.

    Attributes:
        joints: names of the joints.
        limit: greatest velocity [rad/s, m/s]; None for the velocity limits of the joints.
    """

    joints: tuple[str, ...]
    limit: float | None = None


ObservationSource = str | Observation | Callable[[Environment], "npt.ArrayLike"]
ActionTarget = Mapping[str, tuple[float, float]] | Sequence[str] | tuple[float, float] | JointVelocities | None
"""Bounds by field or joint, names of joints, bounds of an effort, or None for the bounds of the world."""


def _is_positive(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and 0.0 < value < math.inf


def _is_value(value: object) -> bool:
    return isinstance(value, (bool, int, float, str)) or callable(value)


def _is_flag(value: object) -> bool:
    return isinstance(value, bool)


_VALUE: Final = "a number, an expression, or a function of the environment"
_CHECKS: Final[Mapping[str, tuple[str, Callable[[object], bool]]]] = {
    "action": (
        'a joint, or targets with their bounds, such as {"/cmd_vel": {"linear.x": (0.0, 0.2)}}',
        lambda value: isinstance(value, (str, Mapping)),
    ),
    "reward": (_VALUE, _is_value),
    "terminated": (_VALUE, _is_value),
    "success": (f"{_VALUE}, or None", lambda value: value is None or _is_value(value)),
    "randomise": ("spaces by path or name of a variable", lambda value: isinstance(value, Mapping)),
    "on_reset": ("a function of the environment, or None", lambda value: value is None or callable(value)),
    "control_period": ("a positive number of seconds", _is_positive),
    "time_limit": ("a positive number of seconds, or None", lambda value: value is None or _is_positive(value)),
    "scaled_actions": ("True or False", _is_flag),
    "sync": ("True or False", _is_flag),
    "samples_all": ("True or False", _is_flag),
}
"""Expected values of options, and their checks."""


@dataclass(frozen=True)
class EnvironmentSpec:
    """Specification of an environment.

    Attributes:
        run: world with its seed, overrides and load options.
        observation: one source, or sources by name.
        action: one target, or targets with their bounds.
        reward: reward of a step.
        terminated: end of an episode by the task.
        success: success of an episode, for `info["is_success"]`; None for a task without it.
        randomise: spaces of the values drawn at each reset, by path of an override or by name of a variable.
        on_reset: function of the environment, called at each reset before the first observation.
        control_period: simulated time of a step [s].
        time_limit: simulated time after which an episode is truncated [s]; None for no limit.
        scaled_actions: actions are numbers from -1 to 1, which stand for the bounds of their targets.
        sync: take a sample of each observed sensor at every step, so that no observation is old.
        samples_all: sample every sensor at its rate; False samples only those that are observed or have a subscriber,
            which is faster. Functions must not read other sensors then.
    """

    run: RunSpec
    observation: ObservationSource | Mapping[str, ObservationSource]
    action: str | Mapping[str, ActionTarget]
    reward: Value = 0.0
    terminated: Value = False
    success: Value | None = None
    randomise: Spaces = field(default_factory=dict)
    on_reset: Callable[[Environment], None] | None = None
    control_period: float = 0.1
    time_limit: float | None = None
    scaled_actions: bool = False
    sync: bool = True
    samples_all: bool = True

    def __post_init__(self) -> None:
        """Check the types of all options.

        Raises:
            InputError: SK-GYM-001 options are invalid; the message lists all of them.
        """
        problems = Problems()
        for name, (expected, is_valid) in _CHECKS.items():
            value = getattr(self, name)
            if not is_valid(value):
                problems.add(invalid(f"found {shorten(repr(value), 60)}; expected {expected}"), name)
        problems.raise_all()


class EnvironmentOptions(TypedDict, total=False):
    """Options of `simkit.gym.make` and `make_vec`: fields of `EnvironmentSpec`, and those of the run and the images.

    Attributes:
        overrides: further overrides of the run.
        seed: seed of the run.
        render_mode: "rgb_array" for images by `render`.
        size: width and height of the images [px].
    """

    observation: ObservationSource | Mapping[str, ObservationSource]
    action: str | Mapping[str, ActionTarget]
    reward: Value
    terminated: Value
    success: Value | None
    randomise: Spaces
    on_reset: Callable[[Environment], None] | None
    control_period: float
    time_limit: float | None
    scaled_actions: bool
    sync: bool
    samples_all: bool
    overrides: Overrides
    seed: int | None
    render_mode: str | None
    size: tuple[int, int]


class Problems:
    """List of the problems of a specification, for one error that lists all of them."""

    def __init__(self) -> None:
        self._problems: list[tuple[str, str]] = []

    def add(self, error: InputError, name: str) -> None:
        """Add an error of the part `name`; an error with the problems of several parts has their names already."""
        text = str(error).removeprefix(error.code).strip()
        self._problems.append((f"{error.code} {name}: {text}" if name else str(error), error.code))

    def raise_all(self) -> None:
        """Raise an error with all problems; do nothing if there is none."""
        if self._problems:
            raise InputError(self._problems[0][1], "\n".join(text for text, _ in self._problems), shows_code=False)


def invalid(message: str, hint: str = "", code: str = INVALID) -> InputError:
    """Return an error about the specification of an environment."""
    return InputError(code, message, help=hint)

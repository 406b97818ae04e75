"""Noise processes of a sensor: they advance, restart and are restored together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from simkit.argument_checks import check_list, checked_number, wrong_value
from simkit.errors import InputError
from simkit.sensors.noise import Noise, NoiseModel
from simkit.sensors.sample import Memory, NoiseProcess, Reading, ReadingFunction, Sample


class SettableNoise:
    """Attribute with the noise of a sensor's channels; a noise model, or a number, that is set changes the noise."""

    def __get__(self, sensor: NoiseKeeper | None, owner: type) -> Any:
        return self if sensor is None else vars(sensor).get("_noise")

    def __set__(self, sensor: NoiseKeeper, value: Any) -> None:
        if value is None or isinstance(value, Noise):
            vars(sensor)["_noise"] = value  # the kind makes its noise
        else:
            sensor.change_noise(value)


class NoiseKeeper:
    """Base class of `Sampler` with the sensor's noise processes."""

    scoped: str

    def __init__(self) -> None:
        self._noises: list[NoiseProcess] = []
        self._evolving: tuple[NoiseProcess, ...] = ()

    def change_noise(self, value: float | NoiseModel | Sequence[NoiseModel]) -> None:
        """Change the noise: a standard deviation or a model for all channels, or a model for each channel.

        Raises:
            InputError: SK-CORE-006 the sensor has no noise of channels, as an image.
        """
        noises = self._channel_noises()
        if not noises:
            help_ = f"set it before the load, with overrides=['{self.scoped}.….noise.stddev=…']"
            message = f"the noise of sensor {self.scoped!r} cannot change during a run"
            raise InputError(f"SK-CORE-006 {message}\n    help: {help_}", "SK-CORE-006")
        count = sum(len(noise.models) for noise in noises)
        if isinstance(value, NoiseModel):
            models = [value] * count
        elif isinstance(value, (int, float)):
            models = [NoiseModel(stddev=checked_number(value, "noise", 0.0))] * count
        else:
            check_list(value, NoiseModel, "noise", "noise models")
            models = list(value)
        if len(models) != count:
            raise wrong_value("noise", f"a number, a NoiseModel or {count} NoiseModels", value)
        self._finish_kept_samples()
        for noise in noises:
            noise.change(models[: len(noise.models)])
            models = models[len(noise.models) :]
        self._noise_changed()

    def noise_models(self) -> list[NoiseModel]:
        """Return the noise model of each channel."""
        return [model for noise in self._channel_noises() for model in noise.models]

    def _channel_noises(self) -> list[Noise]:
        """Return the noise of the measured values; an IMU's orientation, for example, has further noise."""
        main: Noise | None = vars(self).get("_noise")
        return [main] if main is not None else [noise for noise in self._noises if isinstance(noise, Noise)]

    def _finish_kept_samples(self) -> None:
        """Finish the samples that still need the noise of their time."""

    def _noise_changed(self) -> None:
        """Adapt to changed noise."""
        self._evolving = tuple(noise for noise in self._noises if noise.evolves)

    def evolve(self, index: int, dt: float) -> None:
        """Advance noise that has a state by `dt` [s], also for samples without a reader; 0 at the first sample."""
        for noise in self._noises:
            if noise.evolves:
                noise.evolve(index, dt)

    def restart(self) -> None:
        """Return to t = 0, and draw the constant biases again."""
        for noise in self._noises:
            noise.restart()

    def memory(self) -> object:
        """Return the state that continues from sample to sample, as values that are never modified."""
        return tuple((noise.state, getattr(noise, "models", ())) for noise in self._noises)

    def remember(self, memory: Memory) -> None:
        """Restore the state that `memory` returned."""
        is_changed = False
        for noise, (state, models) in zip(self._noises, memory, strict=True):
            if isinstance(noise, Noise) and noise.models != models:
                noise.change(models)
                is_changed = True
            noise.state = state
        if is_changed:
            self._noise_changed()

    def _with_noise_of(self, sample: Sample, make: ReadingFunction, reading: Reading, number: int) -> object:
        """Call `make(reading, number)` while the noise has its state of that sample."""
        now = [noise.state for noise in self._evolving]
        for noise, state in zip(self._evolving, sample.noise_states, strict=True):
            noise.state = state
        try:
            return make(reading, number)
        finally:
            for noise, state in zip(self._evolving, now, strict=True):
                noise.state = state

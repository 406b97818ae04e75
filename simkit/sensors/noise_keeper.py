"""Noise processes of a sensor: they advance, restart and are restored together."""

from __future__ import annotations

from simkit.sensors.sample import Memory, NoiseProcess, Reading, ReadingFunction, Sample


class NoiseKeeper:
    """Base class of `Sampler` with the sensor's noise processes."""

    def __init__(self) -> None:
        self._noises: list[NoiseProcess] = []
        self._evolving: tuple[NoiseProcess, ...] = ()

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
        return tuple(noise.state for noise in self._noises)

    def remember(self, memory: Memory) -> None:
        """Restore the state that `memory` returned."""
        for noise, state in zip(self._noises, memory, strict=True):
            noise.state = state

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

"""Named random streams: a draw depends only on seed, scoped name, channel and sample index."""

from __future__ import annotations

import hashlib
import weakref
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from simkit.in_process import InProcess

if TYPE_CHECKING:
    from simkit.runtime.engine.stream_key import StreamKey

Values = npt.NDArray[np.float64]
_BLOCK_VALUES = 8192


def _name_words(scoped: str, channel: str) -> tuple[int, ...]:
    """Return the hash of a stream's name as four numbers of 32 bits."""
    name = hashlib.blake2b(f"{scoped}\0{channel}".encode(), digest_size=16).digest()
    return tuple(int.from_bytes(name[i : i + 4], "little") for i in range(0, 16, 4))


class RandomStream(InProcess):
    """Random numbers for the samples of one channel.

    Samples are drawn in blocks, each from its own counter. Any index can be drawn without the previous ones, while
    consecutive indices cost a table look-up. A block is drawn in pieces, each as long as all before it, because many
    episodes of learning need only a few samples; the numbers are the same.
    """

    def __init__(self, seed: int, scoped: str, channel: str, width: int) -> None:
        self.scoped, self.channel, self.width = scoped, channel, int(width)
        self._rows = max(1, _BLOCK_VALUES // max(1, self.width))
        self._seed: int | None = None
        self._key: StreamKey | None = None
        self._name: tuple[int, ...] = ()
        self._drawn = 0
        self.reseed(seed)

    @property
    def seed(self) -> int | None:
        """Present seed."""
        return self._seed

    def reseed(self, seed: int) -> None:
        """Set another seed; the same seed keeps the numbers that are drawn already."""
        if seed != self._seed:
            self._seed, self._key = seed, None
            self._normal_block = self._uniform_block = -1

    def independent_copy(self) -> RandomStream:
        """Return a stream with the same numbers, which keeps its seed when the simulation gets another."""
        assert self._seed is not None
        return RandomStream(self._seed, self.scoped, self.channel, self.width)

    def generator(self, index: int, purpose: int = 0) -> np.random.Generator:
        """Return a new generator for one index."""
        if self._key is None:  # many streams of a world are never drawn from
            from simkit.runtime.engine.stream_key import StreamKey  # 6 ms: NumPy's generators

            assert self._seed is not None
            self._name = self._name or _name_words(self.scoped, self.channel)
            self._key = StreamKey(self._seed, self._name)
        counter = np.array((0, 0, index, purpose), dtype=np.uint64)
        key: Any = self._key  # NumPy's type hints name only one class of the interface
        return np.random.Generator(np.random.Philox(key, counter=counter))

    def normal(self, index: int) -> Values:
        """Return the standard normal numbers of a sample, shape (width,); a view that must not be written to."""
        block, row = divmod(index, self._rows)
        if block != self._normal_block or row >= self._drawn:
            self._draw_normals(block, row)
        values: Values = self._normals[row]
        return values

    def _draw_normals(self, block: int, row: int) -> None:
        """Draw the numbers of a block up to a row, or further."""
        if block != self._normal_block:
            self._normals, self._drawn = np.empty((self._rows, self.width)), 0
            self._normal_generator = self.generator(block, 1)
            self._normal_block = block
        end = min(self._rows, max(row + 1, 2 * self._drawn))
        self._normal_generator.standard_normal(out=self._normals[self._drawn : end])
        self._drawn = end

    def normals(self, index: int, most: int) -> Values:
        """Return the standard normal numbers of up to `most` samples from `index` on, shape (count, width).

        The result ends at the end of the block.
        """
        block, row = divmod(index, self._rows)
        last = min(row + most, self._rows) - 1
        if block != self._normal_block or last >= self._drawn:
            self._draw_normals(block, last)
        return self._normals[row : last + 1]

    def uniform(self, index: int) -> Values:
        """Return the numbers of a sample, uniform within ±1, shape (width,); a view that must not be written to."""
        block, row = divmod(index, self._rows)
        if block != self._uniform_block:
            self._uniforms = self.generator(block, 2).uniform(-1.0, 1.0, (self._rows, self.width))
            self._uniform_block = block
        values: Values = self._uniforms[row]
        return values


class RandomStreams:
    """All random streams of a run.

    Args:
        seed: any integer; its absolute value and its sign both count.

    Attributes:
        seed: present seed.
    """

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self._folded_seed = self._fold(seed)
        self._streams: weakref.WeakSet[RandomStream] = weakref.WeakSet()

    @staticmethod
    def _fold(seed: int) -> int:
        return 2 * seed if seed >= 0 else -2 * seed - 1

    def stream(self, scoped: str, channel: str, width: int = 1) -> RandomStream:
        """Return the stream of a channel of an entity."""
        stream = RandomStream(self._folded_seed, scoped, channel, width)
        self._streams.add(stream)
        return stream

    def words(self, scoped: str, channel: str, index: int) -> np.random.Generator:
        """Return a generator for the bulk numbers of one sample, such as those of an image."""
        return RandomStream(self._folded_seed, scoped, channel, 1).generator(index)

    def reseed(self, seed: int) -> None:
        """Set another seed for all present and future streams."""
        self.seed = seed
        self._folded_seed = self._fold(seed)
        for stream in self._streams:
            stream.reseed(self._folded_seed)

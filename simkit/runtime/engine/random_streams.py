"""Named random streams: a draw depends only on seed, scoped name, channel and sample index."""

from __future__ import annotations

import hashlib
import weakref

import numpy as np
import numpy.typing as npt

from simkit.in_process import InProcess

Values = npt.NDArray[np.float64]
_BLOCK_VALUES = 8192


def _stream_key(seed: int, scoped: str, channel: str) -> npt.NDArray[np.uint64]:
    name = hashlib.blake2b(f"{scoped}\0{channel}".encode(), digest_size=16).digest()
    entropy = (seed, *(int.from_bytes(name[i : i + 4], "little") for i in range(0, 16, 4)))
    return np.asarray(np.random.SeedSequence(entropy).generate_state(2, np.uint64), dtype=np.uint64)


class RandomStream(InProcess):
    """Random numbers for the samples of one channel.

    Samples are drawn in blocks, each from its own counter. Any index can be drawn without the previous ones, while
    consecutive indices cost a table look-up.
    """

    def __init__(self, seed: int, scoped: str, channel: str, width: int) -> None:
        self.scoped, self.channel, self.width = scoped, channel, int(width)
        self._rows = max(1, _BLOCK_VALUES // max(1, self.width))
        self.reseed(seed)

    def reseed(self, seed: int) -> None:
        self._key = _stream_key(seed, self.scoped, self.channel)
        self._normal_block = self._uniform_block = -1

    def generator(self, index: int, purpose: int = 0) -> np.random.Generator:
        """Return a new generator for one index."""
        counter = np.array((0, 0, index, purpose), dtype=np.uint64)
        return np.random.Generator(np.random.Philox(key=self._key, counter=counter))

    def normal(self, index: int) -> Values:
        """Return the standard normal numbers of a sample, shape (width,); a view that must not be written to."""
        block, row = divmod(index, self._rows)
        if block != self._normal_block:
            self._normals = self.generator(block, 1).standard_normal((self._rows, self.width))
            self._normal_block = block
        values: Values = self._normals[row]
        return values

    def normals(self, index: int, most: int) -> Values:
        """Return the standard normal numbers of up to `most` samples from `index` on, shape (count, width).

        The result ends at the end of the block.
        """
        self.normal(index)
        row = index % self._rows
        return self._normals[row : row + most]

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

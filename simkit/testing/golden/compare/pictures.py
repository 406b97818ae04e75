"""Comparison of pictures: the part that changed, the size of the change, and the structural similarity."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from simkit.number_text import counted
from simkit.run_spec import Tolerance
from simkit.testing.golden.compare.difference import Difference
from simkit.testing.golden.compare.number_columns import compare_column
from simkit.testing.golden.compare.tolerances import FieldTerms, time_text
from simkit.testing.run_record.message_recorder import TILE
from simkit.testing.run_record.record import Array, Column, Pictures, Stream

_DEPTH = 2.0**-10  # [m]
Ranked = list[tuple[float, Difference]]


def compare_pictures(
    golden: Stream, run: Stream, tolerance: Tolerance, is_exact: bool, count: int, notes: list[str]
) -> Ranked:
    """Compare the pictures of a topic.

    Args:
        golden: Stream of the golden run.
        run: Stream of the new run, of the same topic.
        tolerance: Tolerance of the topic.
        is_exact: True if bits must be equal.
        count: Number of messages to compare.
        notes: List to which differences within the tolerance are appended.
    """
    mine, other = golden.pictures, run.pictures
    if tolerance.ignore or not count:
        return []
    if mine is None or other is None:
        holder = "the golden run" if other is None else "the new run"
        notes.append(f"{run.topic}: only {holder} stores small pictures; they are not compared")
        return []
    form = _format_difference(run, mine, other)
    if form is not None:
        return [(math.inf, form)]
    both = np.intersect1d(mine.messages, other.messages)
    messages = both[both < count]
    changed = None
    if mine.hashes is not None and other.hashes is not None:
        known = min(count, len(mine.hashes), len(other.hashes))
        changed = np.flatnonzero(mine.hashes[:known] != other.hashes[:known])
    pair = _CommonPictures(run, mine.at(messages), other.at(messages), tolerance, is_exact, count, messages, changed)
    if mine.small.dtype.kind == "f" or other.small.dtype.kind == "f":
        ranked = _depths(pair, notes)
    else:
        ranked = _colours(pair, notes)
    return _with_hashes(pair, ranked) if is_exact else ranked


@dataclass(frozen=True)
class _CommonPictures:
    """Pictures of the messages for which both runs stored a picture.

    Attributes:
        stream: Stream of the new run.
        golden, run: Pictures of the golden run and of the new run.
        tolerance, is_exact, count: See `compare_pictures`.
        messages: Messages whose pictures both runs stored.
        changed: Messages whose original pictures differ, known from hashes of all pictures; None if unknown.
    """

    stream: Stream
    golden: Pictures
    run: Pictures
    tolerance: Tolerance
    is_exact: bool
    count: int
    messages: npt.NDArray[np.int64]
    changed: npt.NDArray[np.intp] | None

    @property
    def all_stored(self) -> bool:
        """True if the pictures of all messages are stored."""
        return len(self.messages) == self.count

    def seconds(self, row: int) -> float:
        """Return the time of a row's message [s]."""
        return float(self.stream.times_ns[int(self.messages[row])]) * 1e-9

    def when(self, row: int) -> str:
        """Return the time of a row's message as text."""
        return time_text(self.seconds(row))

    def similarity(self, row: int) -> float:
        """Return the structural similarity of a row's pictures."""
        return structural_similarity(self.golden.small[row], self.run.small[row])


def _format_difference(run: Stream, mine: Pictures, other: Pictures) -> Difference | None:
    """Compare the sizes and encodings of pictures; return None if they are equal."""
    changes = []
    if mine.shape != other.shape:
        changes.append(f"{mine.shape[1]} × {mine.shape[0]} px became {other.shape[1]} × {other.shape[0]} px")
    if mine.encoding != other.encoding:
        changes.append(f"encoding {mine.encoding} became {other.encoding}")
    if not changes and mine.small.shape[1:] != other.small.shape[1:]:
        changes.append("the stored size of pictures changed (picture: in the scenario)")
    if not changes:
        return None
    time = float(run.times_ns[0]) * 1e-9 if len(run.times_ns) else 0.0
    words = f"{run.topic}: {', '.join(changes)}"
    return Difference(run.topic, "", "picture", time, math.nan, "", words, "the same size and encoding", 0)


def _with_hashes(pair: _CommonPictures, ranked: Ranked) -> Ranked:
    """Correct the time of the first difference by the hashes of all pictures; only some pictures are stored."""
    if pair.changed is None or not pair.changed.size:
        return ranked
    first = int(pair.changed[0])
    time = float(pair.stream.times_ns[first]) * 1e-9
    if not ranked:
        words = f"{pair.stream.topic}: pictures differ from {time_text(time)}, in {len(pair.changed)} of {pair.count}"
        words += "" if pair.all_stored else ", but in no stored picture"
        difference = Difference(pair.stream.topic, "", "picture", time, math.nan, "", words, "the same bits", first)
        return [(1.0, difference)]
    excess, difference = ranked[0]
    if first < difference.index:
        words = f"{difference.words}; the first picture that differs, at {time_text(time)}, is not stored"
        ranked = [(excess, replace(difference, time=time, index=first, words=words)), *ranked[1:]]
    return ranked


# ---------------------------------------------------------------------- colours


def _colours(pair: _CommonPictures, notes: list[str]) -> Ranked:
    count, topic = len(pair.messages), pair.stream.topic
    if not count:
        return []
    changed = _changed_tiles(pair)
    apart = np.abs(pair.golden.small.astype(np.int16) - pair.run.small).reshape(count, -1).mean(axis=1)
    suspects = np.flatnonzero((apart > 0.0) | changed.any(axis=1))
    if not suspects.size:
        return []
    tolerance = pair.tolerance
    failing, allowed = suspects, "the same bits"
    if not pair.is_exact:
        image, least = float(tolerance.image or 0.0), float(1.0 if tolerance.ssim is None else tolerance.ssim)
        failing = np.array([i for i in suspects if apart[i] > image or pair.similarity(int(i)) < least], np.intp)
        allowed = f"a mean difference of {image:g} of 255, similarity {least:g}"
    if not failing.size:
        worst = int(np.argmax(apart))
        notes.append(
            f"{topic}: pictures differ by {apart[worst]:.2g} of 255 on average, within {allowed} "
            f"(similarity {pair.similarity(worst):.3f} at {pair.when(worst)})"
        )
        return []
    first = int(failing[0])
    words = f"{topic}: {_changed_part_text(changed[first], pair.golden)}{_brightness(pair, first)}"
    words += f", similarity {pair.similarity(first):.3f}, {_development_text(pair, failing, apart)}"
    size, index = float(apart[failing].max()), int(pair.messages[first])
    difference = Difference(topic, "", "picture", pair.seconds(first), size, "of 255", words, allowed, index)
    return [(float(apart.max()) / max(0.1, float(tolerance.image or 0.1)), difference)]


def _changed_tiles(pair: _CommonPictures) -> npt.NDArray[np.bool_]:
    """Compare the tiles of each picture; the result has shape (messages, tiles)."""
    a, b = pair.golden.tiles, pair.run.tiles
    if a.shape != b.shape:
        return np.zeros((len(pair.messages), 1), bool)
    return np.asarray((a != b).reshape(len(a), -1))


def _changed_part_text(changed: npt.NDArray[np.bool_], mine: Pictures) -> str:
    """Describe the changed tiles: `12 of 300 tiles changed (x 0 to 64, y 0 to 48 px)`."""
    number, total = int(changed.sum()), changed.size
    if not number:
        return "pictures changed"
    if number == total:
        return "the whole picture changed"
    columns = mine.tiles.shape[2]
    y, x = np.divmod(np.flatnonzero(changed), columns)
    box = [int(x.min()) * TILE, int(y.min()) * TILE]
    box += [min(mine.shape[1], (int(x.max()) + 1) * TILE), min(mine.shape[0], (int(y.max()) + 1) * TILE)]
    place = f"x {box[0]} to {box[2]}, y {box[1]} to {box[3]} px"
    return f"{number} of {counted(total, 'tile')} changed ({place})"


def _brightness(pair: _CommonPictures, row: int) -> str:
    """Describe the mean change and whether the picture became brighter or darker."""
    shift = pair.run.small[row].astype(np.float64) - pair.golden.small[row]
    mean, size = float(shift.mean()), float(np.abs(shift).mean())
    if size < 0.005:
        return ", not visible in the reduced picture"
    words = f" by {size:.2g} of 255 on average"
    if abs(mean) > 0.8 * size:
        words += ", brighter" if mean > 0 else ", darker"
    return words


# ---------------------------------------------------------------------- depths


def _depths(pair: _CommonPictures, notes: list[str]) -> Ranked:
    """Compare depths [m]; if the reduced pictures are equal, compare the tiles of the full pictures."""
    mine, other, topic = pair.golden.small, pair.run.small, pair.stream.topic
    stream = replace(pair.stream, times_ns=pair.stream.times_ns[pair.messages], words={})
    terms = FieldTerms(stream, "", pair.tolerance, pair.is_exact, len(pair.messages), "m")
    finding = compare_column(
        terms, Column(mine, None, _rounding_step(mine)), Column(other, None, _rounding_step(other))
    )
    if finding.difference is not None:
        index = int(pair.messages[finding.difference.index])
        return [(finding.excess, replace(finding.difference, kind="picture", index=index))]
    changed = _changed_tiles(pair)
    if not pair.is_exact or not changed.any():
        if finding.excess > 0.1:
            notes.append(f"{topic}: pictures differ within {terms.allowed}")
        return []
    first = int(np.argmax(changed.any(axis=1)))
    part = _changed_part_text(changed[first], pair.golden)
    words = f"{topic}: {part}, not visible in the reduced picture, from {pair.when(first)}"
    index = int(pair.messages[first])
    return [(1.0, Difference(topic, "", "picture", pair.seconds(first), math.nan, "m", words, "the same bits", index))]


def _rounding_step(depths: Array) -> float:
    """Return the step to which stored depths are rounded; 0 if they are not rounded."""
    finite = depths[np.isfinite(depths)]
    return _DEPTH if np.array_equal(finite, np.rint(finite / _DEPTH) * _DEPTH) else 0.0


# ---------------------------------------------------------------------- time


def _development_text(pair: _CommonPictures, failing: npt.NDArray[np.intp], apart: Array) -> str:
    """Describe the first time, the number of pictures and the largest difference."""
    first = int(failing[0])
    number, rest, things = (
        len(failing),
        len(pair.messages) - first,
        "pictures" if pair.all_stored else "stored pictures",
    )
    if pair.is_exact and pair.changed is not None:  # every picture has a hash, even if the picture is not stored
        index = int(pair.messages[first])
        number, rest, things = int((pair.changed >= index).sum()), pair.count - index, "pictures"
    words = f"{'from' if number > 1 else 'at'} {pair.when(first)}"
    if number < rest:
        words += f", in {number} of {rest} {things}"
    worst = int(failing[int(np.argmax(apart[failing]))])
    if worst > first and apart[worst] > 1.5 * apart[first]:
        words += f", up to {apart[worst]:.2g} of 255 at {pair.when(worst)}"
    return words


def structural_similarity(golden: Array, run: Array, peak: float = 255.0) -> float:
    """Return the structural similarity of two pictures of the same size; 1 for equal pictures.

    Args:
        golden: Picture of shape (height, width) or (height, width, channels).
        run: Picture of the same shape.
        peak: Largest possible value.

    Source: Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from error visibility to structural similarity",
    IEEE Trans. Image Processing 13(4), 2004: Gaussian window of 11 px, 1.5 px; K = 0.01, 0.03.
    """
    import cv2

    a, b = golden.astype(np.float64), run.astype(np.float64)

    def blur(image: Array) -> Array:
        return np.asarray(cv2.GaussianBlur(image, (11, 11), 1.5, borderType=cv2.BORDER_REFLECT_101))

    mean_a, mean_b = blur(a), blur(b)
    variance_a, variance_b = blur(a * a) - mean_a**2, blur(b * b) - mean_b**2
    covariance = blur(a * b) - mean_a * mean_b
    c1, c2 = (0.01 * peak) ** 2, (0.03 * peak) ** 2
    similarity = ((2 * mean_a * mean_b + c1) * (2 * covariance + c2)) / (
        (mean_a**2 + mean_b**2 + c1) * (variance_a + variance_b + c2)
    )
    return float(similarity.mean())

"""Points along a line."""

from __future__ import annotations

import cmath

__all__ = ["LineIterator"]


class LineIterator:
    """Points along a line, from its first to its last one.

    Args:
        x0: x of the first point.
        y0: y of the first point.
        x1: x of the last point.
        y1: y of the last point.
        step_size: distance of the points along x; along y for a line with one x.

    Raises:
        TypeError: an argument is no number.
        ValueError: the line has no length, or the step is not positive.
    """

    def __init__(self, x0: float, y0: float, x1: float, y1: float, step_size: float = 1.0) -> None:
        values = {"x0": x0, "y0": y0, "x1": x1, "y1": y1, "step_size": step_size}
        for name, value in values.items():
            if type(value) not in (int, float):
                raise TypeError(f"{name} must be a number (int or float)")
        if step_size <= 0:
            raise ValueError("step_size must be a positive number")
        if x0 == x1 and y0 == y1:
            raise ValueError("Line has zero length (All 4 points have same coordinates)")
        self.x0_, self.y0_, self.x1_, self.y1_ = x0, y0, x1, y1
        self.x_, self.y_, self.step_size_ = x0, y0, step_size
        self.valid_ = True
        if x0 != x1:
            self.m_ = (y1 - y0) / (x1 - x0)
            self.b_ = y1 - self.m_ * x1

    def isValid(self) -> bool:
        """Check whether the line goes on."""
        return self.valid_

    def advance(self) -> None:
        """Go to the next point; after the last one, the line is no longer valid."""
        along_x = self.x0_ != self.x1_
        value, first, last = (self.x_, self.x0_, self.x1_) if along_x else (self.y_, self.y0_, self.y1_)
        step = self.step_size_ if last > first else -self.step_size_
        following = round(self.clamp(value + step, min(first, last), max(first, last)), 5)
        if (value >= last if last > first else value <= last) or following == value:
            self.valid_ = False
        elif along_x:
            self.x_, self.y_ = following, round(self.m_ * following + self.b_, 5)
        else:
            self.y_ = following

    def getX(self) -> float:
        """Return x of the present point."""
        return self.x_

    def getY(self) -> float:
        """Return y of the present point."""
        return self.y_

    def getX0(self) -> float:
        """Return x of the first point."""
        return self.x0_

    def getY0(self) -> float:
        """Return y of the first point."""
        return self.y0_

    def getX1(self) -> float:
        """Return x of the last point."""
        return self.x1_

    def getY1(self) -> float:
        """Return y of the last point."""
        return self.y1_

    def get_line_length(self) -> complex:
        """Return the length of the line, as a complex number as in Nav2."""
        dx, dy = self.x1_ - self.x0_, self.y1_ - self.y0_
        return cmath.sqrt(dx * dx + dy * dy)

    def clamp(self, n: float, min_n: float, max_n: float) -> float:
        """Return the number nearest to `n` between two others."""
        return min(max(n, min_n), max_n)

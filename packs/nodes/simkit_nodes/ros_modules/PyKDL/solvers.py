"""Forward and inverse kinematics of chains of KDL; their methods have KDL's names."""

from __future__ import annotations

import copy
from typing import Any, Final

import numpy as np

from simkit.linear_algebra import matmul, norm, solve
from simkit_nodes.ros_modules.PyKDL.chains import Chain, Floats, Jacobian, JntArray
from simkit_nodes.ros_modules.PyKDL.frame_functions import diff
from simkit_nodes.ros_modules.PyKDL.frames import Frame, Twist

__all__ = [
    "ChainFkSolverPos",
    "ChainFkSolverPos_recursive",
    "ChainIkSolverPos",
    "ChainIkSolverPos_LMA",
    "ChainIkSolverPos_NR",
    "ChainIkSolverPos_NR_JL",
    "ChainIkSolverVel",
    "ChainIkSolverVel_pinv",
    "ChainIkSolverVel_wdls",
    "ChainJntToJacSolver",
    "SolverI",
]

_TEXTS: Final = {
    0: "No error",
    1: "Converged but degraded solution",
    -1: "Failed to converge",
    -2: "Undefined value",
    -3: "Internal data structures not up to date with Chain",
    -4: "The size of the input does not match the internal state",
    -5: "The maximum number of iterations is exceeded",
    -6: "The requested index is out of range",
}


class SolverI:
    """Solver of a chain; its functions return 0, or a number that `strError` explains."""

    E_DEGRADED, E_NOERROR, E_NO_CONVERGE, E_UNDEFINED = 1, 0, -1, -2
    E_NOT_UP_TO_DATE, E_SIZE_MISMATCH, E_MAX_ITERATIONS_EXCEEDED, E_OUT_OF_RANGE = -3, -4, -5, -6

    def __init__(self, chain: Chain) -> None:
        self._chain, self._error = chain, self.E_NOERROR

    def getError(self) -> int:
        """Return the last result."""
        return self._error

    def strError(self, error: int) -> str:
        """Return the text of a result."""
        return _TEXTS.get(error, "UNKNOWN ERROR")

    def updateInternalDataStructures(self) -> None:
        """Accept a chain that has changed; nothing is stored about it."""

    def _has_size(self, *arrays: JntArray) -> bool:
        return all(array.rows() == self._chain.getNrOfJoints() for array in arrays)

    def _result(self, error: int) -> int:
        self._error = error
        return error


class ChainFkSolverPos(SolverI):
    """Solver for the frame of the tip."""

    def JntToCart(self, q_in: JntArray, p_out: Any, segmentNr: int = -1) -> int:
        """Calculate the frame at the end of a chain.

        Args:
            q_in: values of the joints.
            p_out: frame that receives the result, or a list that receives the frames of all segments.
            segmentNr: number of segments; -1 for all.
        """
        count = self._chain.getNrOfSegments() if segmentNr < 0 else segmentNr
        if not self._has_size(q_in):
            return self._result(self.E_SIZE_MISMATCH)
        if count > self._chain.getNrOfSegments():
            return self._result(self.E_OUT_OF_RANGE)
        frames = [Frame()]
        for segment, value, _ in list(self._chain._with_values(q_in))[:count]:
            frames.append(frames[-1] * segment.pose(value))
        if isinstance(p_out, list):
            p_out[:] = frames[1:]
        else:
            p_out.M, p_out.p = frames[-1].M, frames[-1].p
        return self._result(self.E_NOERROR)


class ChainFkSolverPos_recursive(ChainFkSolverPos):
    """Solver for the frame of the tip."""


class ChainJntToJacSolver(SolverI):
    """Solver for the Jacobian of the tip, in the axes of the base."""

    def JntToJac(self, q_in: JntArray, jac: Jacobian, seg_nr: int = -1) -> int:
        """Calculate the Jacobian at the values of the joints into `jac`."""
        if not self._has_size(q_in) or jac.columns() != self._chain.getNrOfJoints():
            return self._result(self.E_SIZE_MISMATCH)
        jac.resize(jac.columns())
        count = self._chain.getNrOfSegments() if seg_nr < 0 else seg_nr
        frame = Frame()
        for segment, value, joint in list(self._chain._with_values(q_in))[:count]:
            after = frame * segment.pose(value)
            jac.changeRefPoint(after.p - frame.p)
            if joint is not None:
                jac.setColumn(joint, frame.M * segment.twist(value, 1.0))
            frame = after
        return self._result(self.E_NOERROR)


class ChainIkSolverVel(SolverI):
    """Solver for the velocities of the joints, of least squares with a little damping.

    Args:
        chain: chain.
        eps: damping: singular values of the Jacobian below it count as zero.
        maxiter: has no effect.
    """

    def __init__(self, chain: Chain, eps: float = 1e-5, maxiter: int = 150) -> None:
        super().__init__(chain)
        self._damping = eps

    def CartToJnt(self, q_in: JntArray, v_in: Twist, qdot_out: JntArray) -> int:
        """Calculate the velocities of the joints that give the tip a twist into `qdot_out`."""
        if not self._has_size(q_in, qdot_out):
            return self._result(self.E_SIZE_MISMATCH)
        jacobian = Jacobian(self._chain.getNrOfJoints())
        ChainJntToJacSolver(self._chain).JntToJac(q_in, jacobian)
        qdot_out._array[:] = _damped_step(jacobian._matrix, np.array(v_in._values()), self._damping)
        return self._result(self.E_NOERROR)


class ChainIkSolverVel_pinv(ChainIkSolverVel):
    """Solver for the velocities of the joints."""


class ChainIkSolverVel_wdls(ChainIkSolverVel):
    """Solver for the velocities of the joints with a damping that can be set; weights have no effect."""

    def setLambda(self, value: float) -> None:
        """Set the damping."""
        self._damping = max(float(value), 1e-9)


class ChainIkSolverPos(SolverI):
    """Solver for the values of the joints."""

    def CartToJnt(self, q_init: JntArray, p_in: Frame, q_out: JntArray) -> int:
        """Calculate the values of the joints that put the tip at a frame.

        Args:
            q_init: values at which the search begins.
            p_in: frame.
            q_out: array that receives the result.
        """
        raise NotImplementedError


class ChainIkSolverPos_NR_JL(ChainIkSolverPos):
    """Solver of Newton-Raphson that keeps the joints in their limits.

    Args:
        chain: chain.
        limits: lowest and highest values of the joints, which may be missing; then the solvers of frames and of
            velocities.
        maxiter: largest number of steps.
        eps: largest error [m, rad].
    """

    def __init__(self, chain: Chain, *limits: Any, maxiter: int = 100, eps: float = 1e-6) -> None:
        super().__init__(chain)
        values = list(limits)
        self._limits = (values.pop(0), values.pop(0)) if isinstance(values[0], JntArray) else None
        self._forward, self._velocities = values[:2]
        self._count, self._largest_error = (values[2] if len(values) > 2 else maxiter), eps
        if len(values) > 3:
            self._largest_error = values[3]

    def CartToJnt(self, q_init: JntArray, p_in: Frame, q_out: JntArray) -> int:
        if not self._has_size(q_init, q_out):
            return self._result(self.E_SIZE_MISMATCH)
        q_out._array[:] = q_init._array
        frame, step = Frame(), JntArray(q_out.rows())
        for _ in range(self._count):
            self._forward.JntToCart(q_out, frame)
            error = diff(frame, p_in)
            if max(map(abs, error._values())) < self._largest_error:
                return self._result(self.E_NOERROR)
            self._velocities.CartToJnt(q_out, error, step)
            q_out._array += step._array
            if self._limits is not None:
                low, high = self._limits
                q_out._array[:] = np.clip(q_out._array, low._array, high._array)
        return self._result(self.E_MAX_ITERATIONS_EXCEEDED)


class ChainIkSolverPos_NR(ChainIkSolverPos_NR_JL):
    """Solver of Newton-Raphson."""


class ChainIkSolverPos_LMA(ChainIkSolverPos):
    """Solver of Levenberg and Marquardt.

    Args:
        chain: chain.
        values: weights of the six errors, which may be missing; largest error [m, rad]; largest number of steps.
        eps: largest error [m, rad].
        maxiter: largest number of steps.
        eps_joints: has no effect.
    """

    def __init__(
        self, chain: Chain, *values: Any, eps: float = 1e-5, maxiter: int = 500, eps_joints: float = 1e-15
    ) -> None:
        super().__init__(chain)
        rest = list(values)
        weights = rest.pop(0) if rest and np.size(rest[0]) == 6 else (1.0, 1.0, 1.0, 0.01, 0.01, 0.01)
        self._weights = np.asarray(weights, np.float64).ravel()
        self._largest_error, self._count = (rest[0] if rest else eps), (rest[1] if len(rest) > 1 else maxiter)

    def _error_at(self, q: JntArray, goal: Frame) -> Floats:
        frame = Frame()
        ChainFkSolverPos_recursive(self._chain).JntToCart(q, frame)
        return np.array(diff(frame, goal)._values()) * self._weights

    def CartToJnt(self, q_init: JntArray, p_in: Frame, q_out: JntArray) -> int:
        if not self._has_size(q_init, q_out):
            return self._result(self.E_SIZE_MISMATCH)
        q_out._array[:] = q_init._array
        error, damping, jacobian = self._error_at(q_out, p_in), 1e-2, Jacobian(q_out.rows())
        for _ in range(self._count):
            if norm(error) < self._largest_error:
                return self._result(self.E_NOERROR)
            ChainJntToJacSolver(self._chain).JntToJac(q_out, jacobian)
            trial = copy.deepcopy(q_out)
            trial._array += _damped_step(jacobian._matrix * self._weights[:, None], error, damping)
            trial_error = self._error_at(trial, p_in)
            if norm(trial_error) < norm(error):
                q_out._array[:] = trial._array
                error, damping = trial_error, max(damping / 5.0, 1e-6)
            elif damping > 1e6:
                return self._result(self.E_NO_CONVERGE)
            else:
                damping *= 3.0
        return self._result(self.E_MAX_ITERATIONS_EXCEEDED)


def _damped_step(matrix: Floats, right: Floats, damping: float) -> Floats:
    """Return x with the smallest sum of squares of `matrix` x - `right` and of `damping` x."""
    columns = matrix.shape[1]
    if columns <= 6:  # of the two equal forms, the one with the smaller system
        square = matmul(matrix.T, matrix) + damping**2 * np.identity(columns)
        return solve(square, matmul(matrix.T, right))
    square = matmul(matrix, matrix.T) + damping**2 * np.identity(6)
    result: Floats = matmul(matrix.T, solve(square, right))
    return result

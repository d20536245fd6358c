"""Piecewise polynomials with their first three derivatives: paths q(s) and phases s(t) are both of this kind."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray, read_only

IntArray = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class PiecewisePolynomial:
    """A curve of n coordinates over one parameter.

    Attributes:
        breaks: Ends of the pieces, increasing, (m + 1,).
        coefficients: Of each piece in powers of the parameter since its begin, lowest first, (m, degree + 1, n).
    """

    breaks: FloatArray
    coefficients: FloatArray

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        object.__setattr__(self, "breaks", read_only(self.breaks))
        object.__setattr__(self, "coefficients", read_only(self.coefficients))

    @property
    def length(self) -> float:
        """The parameter's range."""
        return float(self.breaks[-1] - self.breaks[0])

    def derivatives(self, at: FloatArray, piece: IntArray | None = None) -> FloatArray:
        """Value and first, second and third derivative, (4, k, n).

        Args:
            at: Parameters, (k,); clipped to the range.
            piece: Which piece to take at each of them, (k,) of whole numbers, for a derivative that jumps at a break;
                by default the one that begins there.
        """
        at = np.clip(np.asarray(at, dtype=np.float64), self.breaks[0], self.breaks[-1])
        if piece is None:
            piece = np.clip(np.searchsorted(self.breaks, at, side="right") - 1, 0, self.breaks.size - 2)
        index = np.asarray(piece)
        x = (at - self.breaks[index])[:, None]
        coefficients = self.coefficients[index]
        result = np.zeros((4, at.size, self.coefficients.shape[2]))
        value, first, second, third = result
        for power in range(self.coefficients.shape[1] - 1, -1, -1):
            # Horner's rule for all four at once; the second and third are of the Taylor series, 1/2 and 1/6 of them.
            third *= x
            third += second
            second *= x
            second += first
            first *= x
            first += value
            value *= x
            value += coefficients[:, power]
        second *= 2.0
        third *= 6.0
        return result

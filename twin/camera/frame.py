"""What a camera gives."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NOTHING = -1
"""The id of a pixel in which no object is seen."""


@dataclass(frozen=True, slots=True)
class RgbdFrame:
    """Colour, depth and truth of one moment, all seen from the same optical frame.

    Attributes:
        colour: Red, green, blue, (height, width, 3) uint8.
        depth: Distance along the optical axis, (height, width) float32 [m]; 0 where nothing is measured.
        mask: Id of the drawable seen, (height, width) int32; -1 where there is none. For scoring: perception does not
            look at it.
    """

    colour: NDArray[np.uint8]
    depth: NDArray[np.float32]
    mask: NDArray[np.int32]

    def __post_init__(self) -> None:
        """Freeze the arrays, which belong to the frame from now on (not copied: frames are large)."""
        for array in (self.colour, self.depth, self.mask):
            array.setflags(write=False)

"""Components under numbers that keep their meaning as learning goes on: what all mixtures of concepts share."""

from abc import ABC, abstractmethod
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from learning.concepts.gaussian import Gaussian
from robots.pose import FloatArray


class NumberedComponents(ABC):
    """Numbers are never used twice: that of a component that was merged into another is an alias of that one's."""

    def __init__(self) -> None:
        """Start without components."""
        self._components: dict[int, Gaussian] = {}
        self._names: dict[int, str] = {}
        self._aliases: dict[int, int] = {}
        self._next_number = 0
        self._demos = 0

    @property
    def components(self) -> Mapping[int, Gaussian]:
        """Concept number to component, aliases left out, in ascending order of number."""
        return dict(sorted(self._components.items()))

    @property
    def names(self) -> Mapping[int, str]:
        """Names that a user gave to concepts, by number."""
        return dict(sorted(self._names.items()))

    @property
    def numbers_given(self) -> int:
        """How many concept numbers were ever given: numbers are 0 .. this - 1, aliases included."""
        return self._next_number

    @property
    def weights(self) -> dict[int, float]:
        """Concept number to mixture weight pi (A.3, A.4, A.5); they sum to 1."""
        total = sum(component.count for component in self._components.values())
        return {number: component.count / total for number, component in self.components.items()}

    def resolve(self, number: int) -> int:
        """The number under which a concept is kept now; itself when it was never merged into another one."""
        while number in self._aliases:
            number = self._aliases[number]
        return number

    def classify(self, values: FloatArray) -> NDArray[np.int64]:
        """Concept number of each embedded value, (..., d) to (...).

        Raises:
            PerceptionError: There is no concept yet.
        """
        return self.classify_with_distance(values)[0]

    @abstractmethod
    def classify_with_distance(self, values: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """Like `classify`, with the distance to that concept, both (...)."""

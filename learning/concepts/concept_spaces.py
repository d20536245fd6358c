"""All concepts learned so far: a mixture for every feature space, and the action graphlets (thesis 3.4)."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from learning.concepts.demo_concepts import DemoConcepts
from learning.concepts.feature_space import FeatureSpace, Kinds
from learning.concepts.incremental_mixture import IncrementalMixture
from learning.concepts.mixture import Mixture
from learning.concepts.mode_mixture import ModeMixture
from learning.concepts.space_set import BOARD, SpaceSet, find_space_set
from learning.concepts.track_mixture import TrackMixture
from learning.errors import KnowledgeError, PerceptionError
from learning.graphs.action_library import ActionLibrary
from robots.pose import FloatArray

_MIXTURES: Mapping[Kinds, type[IncrementalMixture | ModeMixture | TrackMixture]] = {
    "tested": IncrementalMixture,
    "wide": ModeMixture,
    "learned": TrackMixture,
}


class ConceptSpaces:
    """The incremental mixtures of all feature spaces, and the list of action graphlets.

    Attributes:
        space_set: Which feature spaces there are.
        mixtures: Feature space name to its mixture.
        actions: Known action graphlets.
    """

    def __init__(self, spaces: SpaceSet | str = BOARD) -> None:
        """Start without concepts.

        Args:
            spaces: The feature spaces to learn in, or the name of a known set of them.

        Raises:
            KnowledgeError: No set has that name.
        """
        self.space_set = find_space_set(spaces) if isinstance(spaces, str) else spaces
        self.mixtures: dict[str, Mixture] = {
            space.name: _MIXTURES[space.kinds](space) for space in self.space_set.spaces
        }
        self.actions = ActionLibrary()

    def space(self, name: str) -> type[FeatureSpace]:
        """A feature space by its name.

        Raises:
            KnowledgeError: There is none; lists the names.
        """
        return self.space_set.space(name)

    @property
    def touching(self) -> int:
        """Number of the *at it* concept: the distance concept with the smallest mean.

        Raises:
            PerceptionError: No distance was seen yet.
        """
        components = self.mixtures["distance"].components
        if not components:
            raise PerceptionError("nothing is known of feature space 'distance' yet: learn from a demo first")
        return min(components, key=lambda number: float(components[number].mean[0]))

    def update(self, demo: DemoConcepts) -> None:
        """Merge the concepts of one demo, each feature space independently of the others (3.4.1)."""
        for name, components in demo.components.items():
            self.mixtures[name].update(components, demo.noise.get(name), demo.names.get(name))

    def predicates(self, space: str, values: FloatArray) -> NDArray[np.int64]:
        """Number of the concept that holds for each measured value: smallest Mahalanobis distance (eq. 3.1).

        Args:
            space: Feature space name.
            values: Measured values (for relations: offsets [m]), (..., m).

        Returns:
            (...) concept numbers.
        """
        return self.mixtures[space].classify(self.space(space).embed(values))

    def resolve(self, space: str, number: int) -> int:
        """The number that a concept is known by now (see `IncrementalMixture.resolve`); actions keep theirs."""
        return number if space == "action" else self.mixtures[space].resolve(number)

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings; `from_json` gives the same concepts back exactly."""
        return {
            "set": self.space_set.name,
            "spaces": {name: mixture.to_json() for name, mixture in self.mixtures.items()},
            "actions": self.actions.to_json(),
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "ConceptSpaces":
        """Rebuild the concepts.

        Raises:
            KnowledgeError: `data` is not what `to_json` wrote.
        """
        try:
            spaces = cls(str(data.get("set", BOARD.name)))  # older files are all of the board
            for space in spaces.space_set.spaces:
                spaces.mixtures[space.name] = _MIXTURES[space.kinds].from_json(space, data["spaces"][space.name])
            spaces.actions = ActionLibrary.from_json(data["actions"])
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise KnowledgeError(f"concepts: {type(error).__name__} {error}; learn again or restore the file") from None
        return spaces

"""Concepts: Gaussian components in feature spaces, found in each demo and merged incrementally (thesis 3.3, 3.4).

`fit_demo` finds the mixture of one demo, `ConceptSpaces` holds what all demos so far have taught.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from learning.concepts.concept_spaces import ConceptSpaces
    from learning.concepts.demo_concepts import DemoConcepts, fit_demo
    from learning.concepts.feature_space import FEATURE_SPACES, FeatureSpace
    from learning.concepts.gaussian import Gaussian
    from learning.concepts.incremental_mixture import IncrementalMixture
    from learning.concepts.mixture import Mixture
    from learning.concepts.mode_mixture import ModeMixture
    from learning.concepts.space_set import BOARD, COUNTER, TABLE, SpaceSet, find_space_set, register_space_set
    from learning.concepts.track_mixture import TrackMixture

__all__ = [
    "BOARD",
    "COUNTER",
    "FEATURE_SPACES",
    "TABLE",
    "ConceptSpaces",
    "DemoConcepts",
    "FeatureSpace",
    "Gaussian",
    "IncrementalMixture",
    "Mixture",
    "ModeMixture",
    "SpaceSet",
    "TrackMixture",
    "find_space_set",
    "fit_demo",
    "register_space_set",
]

_HOMES = {
    "BOARD": "space_set",
    "COUNTER": "space_set",
    "TABLE": "space_set",
    "SpaceSet": "space_set",
    "register_space_set": "space_set",
    "find_space_set": "space_set",
    "Mixture": "mixture",
    "ModeMixture": "mode_mixture",
    "TrackMixture": "track_mixture",
    "FEATURE_SPACES": "feature_space",
    "ConceptSpaces": "concept_spaces",
    "DemoConcepts": "demo_concepts",
    "FeatureSpace": "feature_space",
    "Gaussian": "gaussian",
    "IncrementalMixture": "incremental_mixture",
    "fit_demo": "demo_concepts",
}


def __getattr__(name: str) -> Any:
    """Import on first use what needs heavier libraries."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)

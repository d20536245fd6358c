"""What words nearly say of things at a table: where nothing is just what they say, what comes close to it.

A camera sees a thing from one side and in one light, so now and then it is taken for another kind than it is. How far a
thing is from a concept is told by the spread of all concepts of that space.
"""

from collections.abc import Mapping

import numpy as np

from learning.concept_id import Concept
from learning.concepts.concept_spaces import ConceptSpaces
from learning.grammar.rcl import RclNode
from learning.grounding.sorts import Sorts
from learning.grounding.table_scene import NAMED, TableScene
from learning.saying.table_understanding import TableDenotation
from robots.pose import FloatArray

FARTHEST = 40.0
"""What is further from what words say is not meant [nats]: different colours are hundreds apart, and so are shapes."""
RIVAL = 10.0
"""What is not so much further than the nearest may be meant as well [nats]."""
NOT_THERE = 20.0
"""A thing that is not where words say, or not as large as its like, is so far off [nats]."""
SORT_WEIGHT = 5.0
"""Sorts of one concept are nearer to each other than concepts are, by this factor."""


class NearlyDenotation(TableDenotation):
    """What parts of trees denote in a scene, or nearly denote where nothing else does."""

    def __init__(
        self,
        scene: TableScene,
        looks: Mapping[str, FloatArray],
        spaces: ConceptSpaces,
        sorts: Mapping[str, Sorts],
        also: Mapping[Concept, frozenset[Concept]] | None = None,
    ) -> None:
        """Look at a scene.

        Args:
            scene: In symbols.
            looks: Space of looks to what each thing is like there, (N, d); NaN where that was not seen.
            spaces: Concepts.
            sorts: Space of looks to the sorts that words tell apart there.
            also: Concepts to others that are called by the same word.
        """
        super().__init__(scene)
        self._also = also or {}
        plain = dict(self._masks)
        for concept, others in self._also.items():
            for other in others:
                self._masks[concept] = self._masks.get(concept, 0) | plain.get(other, 0)
        self._looks = looks
        self._spaces = spaces
        self._sorts = sorts

    def things(self, entity: RclNode) -> int:
        """Objects that an entity denotes, or comes near to, as a mask."""
        strict = super().things(entity)
        if strict or not self.everything:
            return strict
        off = np.zeros(self.everything.bit_length())
        for child in entity.children:
            if child.label == "spatial-relation":
                standing = self._standing(child)
                off += [0.0 if standing >> index & 1 else NOT_THERE for index in range(len(off))]
            elif child.concept is not None:
                off += self._off(child.concept)
        nearest = float(off.min())
        if nearest > FARTHEST:
            return 0
        return sum(1 << int(index) for index in np.flatnonzero(off <= min(nearest + RIVAL, FARTHEST)))

    def _off(self, concept: Concept) -> FloatArray:
        """How far each thing is from a concept, further than from the nearest of that space, (N,) [nats]."""
        mask = self._masks.get(concept, 0)
        off = np.array([0.0 if mask >> index & 1 else np.inf for index in range(self.everything.bit_length())])
        space = concept.space.removeprefix(NAMED)
        values = self._looks.get(space)
        if values is None:
            return np.asarray(np.minimum(off, NOT_THERE))
        away = np.min([self._away(each, values) for each in (concept, *self._also.get(concept, ()))], axis=0)
        unseen = ~np.all(np.isfinite(values), axis=1)
        near: FloatArray = np.where(unseen, 0.0, np.minimum(off, away))
        return near

    def _away(self, concept: Concept, values: FloatArray) -> FloatArray:
        """The same for what is measured."""
        space = concept.space.removeprefix(NAMED)
        if concept.space != space:
            means, scatter, weight = self._sorts[space].means, self._sorts[space].scatter, SORT_WEIGHT
            if scatter is None or concept.number >= len(means):
                return np.full(len(values), np.inf)
            covariance = scatter / max(sum(self._sorts[space].counts) - len(means), 1.0)
            order, wanted = list(range(len(means))), concept.number
        elif space in self._spaces.mixtures:
            components = self._spaces.mixtures[space].components
            wanted = self._spaces.resolve(space, concept.number)
            if wanted not in components:
                return np.full(len(values), np.inf)
            order, weight = list(components), 1.0
            means = [components[number].mean for number in order]
            counts = np.array([components[number].count for number in order])
            covariance = np.einsum(
                "k,kij->ij", counts / counts.sum(), [components[number].covariance for number in order]
            )
        else:
            return np.full(len(values), NOT_THERE)
        usual = max(float(np.trace(covariance)) / len(covariance), 1e-9)
        precision = np.linalg.inv(covariance + 0.1 * usual * np.eye(len(covariance)))
        offsets = np.nan_to_num(values)[:, None] - np.array(means)[None]
        far = 0.5 * np.einsum("nki,ij,nkj->nk", offsets, precision, offsets)
        return np.asarray(weight * (far[:, order.index(wanted)] - far.min(axis=1)))

"""Whether the parts of a knowledge file fit together: language may speak only of concepts and elements that exist."""

from collections.abc import Iterable

from learning.concept_id import ACTION_SPACE, OBJECT_SPACES, REFERENCE_SPACE, RELATION_SPACES, Concept
from learning.concepts import ConceptSpaces
from learning.grammar.innate import INNATE
from learning.grounding.kind_sizes import LARGER, SMALLER
from learning.grounding.language_learner import LanguageLearner
from learning.grounding.reading_learner import ReadingLearner
from learning.grounding.table_language import TableLanguage
from learning.grounding.table_scene import BESIDE, MIDDLE, NAMED, OVER, SIDE_PLACES
from learning.grounding.word_uses import HEADING_SPACE
from learning.saying.phrasings import Phrasings

ELEMENTS = frozenset(
    (
        *("command", "sequence", "event", "entity", "destination", "spatial-relation"),
        *(ACTION_SPACE, REFERENCE_SPACE, *OBJECT_SPACES, *RELATION_SPACES),
    )
)
"""All RCL elements (thesis table 5.1) and feature spaces that a rule of the grammar may name."""
INNATE_AT_TABLES = frozenset((*SIDE_PLACES, MIDDLE, BESIDE, OVER, SMALLER, LARGER))
"""Concepts of tables that nobody has to learn."""


def check_language(language: LanguageLearner | ReadingLearner, spaces: ConceptSpaces) -> None:
    """Check that K, Φ and Π name nothing that was never learned.

    Raises:
        ValueError: They do; the message names the concept or the element.
    """
    if isinstance(language, ReadingLearner):
        _check_concepts(language.named(), spaces, "Φ")
        return
    for matrix in (language.correlation, language.focus):
        _check_concepts(matrix.concept_counts, spaces, "K")
        for row in matrix.joint_counts.values():
            _check_concepts(row, spaces, "K")
    _check_concepts((c for c in language.grounding.concept_totals if c is not None), spaces, "Φ")
    grammar = language.grammar
    named = {*grammar.rules, *grammar.terminals}
    named.update(child for row in grammar.rules.values() for right in row for child in right)
    for label in sorted(named - ELEMENTS):
        raise ValueError(f"the grammar names an unknown element '{label}'; known are {', '.join(sorted(ELEMENTS))}")


def check_table_language(language: TableLanguage, spaces: ConceptSpaces) -> None:
    """Check that words of tables mean nothing that was never learned.

    Raises:
        ValueError: They do; the message names the concept.
    """
    for concept in sorted(language.concepts() - INNATE_AT_TABLES):
        if concept.space.startswith(NAMED):
            sorts = language.sorts.get(concept.space.removeprefix(NAMED))
            if sorts is None or not 0 <= concept.number < len(sorts.kinds):
                raise ValueError(f"table language speaks of {concept}, which is no learned sort")
        else:
            _check_concepts((concept,), spaces, "table language")


def check_phrasings(phrasings: Phrasings, spaces: ConceptSpaces) -> None:
    """Check that names are of concepts that were learned; sorts of things are the table language's own.

    Raises:
        ValueError: They are not; the message names the concept.
    """
    named = (each for each in phrasings.concepts() if each not in INNATE_AT_TABLES and not each.space.startswith(NAMED))
    _check_concepts(named, spaces, "phrasing")


def _check_concepts(concepts: Iterable[Concept], spaces: ConceptSpaces, where: str) -> None:
    for concept in concepts:
        if concept.space == ACTION_SPACE:
            known = 1 <= concept.number <= spaces.actions.numbers_given
        elif concept.space in spaces.mixtures:
            known = 0 <= concept.number < spaces.mixtures[concept.space].numbers_given
        else:
            known = concept in INNATE or (concept.space == HEADING_SPACE and concept.number in range(4))
        if not known:
            raise ValueError(f"{where} speaks of {concept}, which is no learned concept")

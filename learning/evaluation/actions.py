"""Scoring of action concepts: do demos of one action, and only those, give one graphlet (thesis 6.3)?"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from learning.concepts.concept_spaces import ConceptSpaces
from learning.errors import PerceptionError
from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.action_states import shown_action
from learning.percept import NO_CONCEPT
from learning.perception.observation import Observation
from robots.pose import FloatArray

LEARNED_DEMOS = 5
"""Demos of each action that graphlets are learned from, unless told otherwise."""


@dataclass(frozen=True, slots=True)
class ActionScore:
    """How well action concepts agree with the true actions.

    Attributes:
        homogeneity: 1 where each concept has demos of one true action only.
        completeness: 1 where all demos of a true action have one concept.
        v_measure: Harmonic mean of the two.
        true_actions: Number of true actions.
        graphlets: Number of action concepts learned.
        counts: (True action, concept number) to the number of demos; `NO_CONCEPT` is a demo that no concept fits.
        names: Concept number to its graphlet, as text.
        failures: Why demos gave no action at all, with how often.
    """

    homogeneity: float
    completeness: float
    v_measure: float
    true_actions: int
    graphlets: int
    counts: Mapping[tuple[str, int], int]
    names: Mapping[int, str]
    failures: Mapping[str, int]

    def lines(self) -> list[str]:
        """The confusion, a line a pair of action and concept, the most frequent concept of each action first."""
        rows = sorted(self.counts.items(), key=lambda row: (row[0][0], -row[1]))
        return [
            f"{action}: {count} x {'no known action' if number == NO_CONCEPT else f'action_{number} '}"
            f"{self.names.get(number, '')}"
            for (action, number), count in rows
        ]


def score_actions(
    pairs: Sequence[tuple[Observation, str]],
    spaces: ConceptSpaces | None = None,
    learned_demos: int = LEARNED_DEMOS,
) -> ActionScore:
    """Learn action graphlets from a few demos of each action, one after the other, and name the action of every demo.

    Args:
        pairs: Observations of demos and their true actions, as the sidecar files have them.
        spaces: Concepts to go on from, whose actions are added to; None starts with none.
        learned_demos: Demos of each true action that are learned from, the first ones in `pairs`. That is all that the
            truth is used for before scoring.

    Raises:
        ValueError: There are no pairs.
    """
    from sklearn.metrics import homogeneity_completeness_v_measure

    if not pairs:
        raise ValueError("no demos to score: give at least one observation with its true action")
    spaces = ConceptSpaces() if spaces is None else spaces
    seen: Counter[str] = Counter()
    failures: Counter[str] = Counter()
    shown: list[tuple[ActionGraphlet, list[dict[str, FloatArray]] | None] | None] = []
    for observation, action in pairs:
        try:
            graphlet, measures, _ = shown_action(observation, spaces)
        except PerceptionError as error:
            failures[str(error)] += 1
            shown.append(None)
            continue
        if seen[action] < learned_demos:
            spaces.actions.match_or_add(graphlet, measures)
        seen[action] += 1
        shown.append((graphlet, measures))
    numbers = []
    for each in shown:  # after all of them were learned from, lest the order decide what a demo is called
        found = None if each is None else spaces.actions.find(*each)
        numbers.append(NO_CONCEPT if found is None else found)
    true = [action for _, action in pairs]
    homogeneity, completeness, v_measure = homogeneity_completeness_v_measure(true, numbers)
    return ActionScore(
        homogeneity=float(homogeneity),
        completeness=float(completeness),
        v_measure=float(v_measure),
        true_actions=len(set(true)),
        graphlets=len(spaces.actions),
        counts=dict(Counter(zip(true, numbers, strict=True))),
        names={number: str(graphlet) for number, graphlet in spaces.actions.numbered.items()},
        failures=dict(failures),
    )

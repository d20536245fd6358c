"""Experiment 1 of the thesis (6.3): how well do the concepts found agree with the classes there are?

Demos are seen one after another, as a learner sees them. What is scored is the agreement of the concepts known at the
end with the true classes of the instances of all demos.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from statistics import median
from time import process_time

import numpy as np
from numpy.typing import NDArray

from learning.concepts import ConceptSpaces, SpaceSet, fit_demo
from learning.concepts.demo_concepts import MOST_POINTS, Labels, feature_values
from learning.errors import LearningError, PerceptionError
from learning.evaluation.concepts_instances import Instances, action_values, gathered, instances_of
from learning.evaluation.concepts_memory import MemoryPoint, sizes
from learning.evaluation.concepts_metrics import cluster_scores
from learning.evaluation.concepts_pure import PureIgmm
from learning.evaluation.concepts_report import CollectionSummary, ConceptRow, ConceptsReport
from learning.evaluation.concepts_svm import SETTINGS, svm_predictions
from learning.evaluation.concepts_truth import TrueDemo, TruthRules
from learning.graphs.action_states import shown_action
from learning.grounding.ngrams import words_of
from learning.learner import Learner
from learning.percept import NO_CONCEPT
from learning.perception.observation import Observation
from robots.pose import FloatArray

MEMORY_POINTS = 250
"""Points of the memory curve at most."""
SPAN = 20
"""Demos at either end whose median times are compared."""
WARMED_UP = 9
"""Demos before the first of them."""


@dataclass(frozen=True, slots=True)
class ScoredDemo:
    """A demo with what is true of it.

    Attributes:
        observation: What perception got from it; all that the learner sees.
        truth: What is true of it.
        utterances: Sentences said with it.
        group: Demos of one group must not be split between the SVM's learning and asking.
        raw: Size of its pictures [bytes].
    """

    observation: Observation
    truth: TrueDemo
    utterances: tuple[str, ...] = ()
    group: int = 0
    raw: int = 0


@dataclass(slots=True)
class _Seen:
    """What was gathered on the way."""

    rows: dict[str, list[tuple[int, FloatArray, str]]] = field(default_factory=dict)
    unmeasured: Counter[str] = field(default_factory=Counter)
    groups: list[int] = field(default_factory=list)
    actions: list[int] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    memory: list[MemoryPoint] = field(default_factory=list)
    frames: int = 0
    objects: int = 0
    commands: int = 0
    raw: int = 0
    words: set[str] = field(default_factory=set)


def evaluate_concepts(
    demos: Iterable[ScoredDemo],
    total: int,
    spaces: SpaceSet,
    rules: TruthRules,
    *,
    robot: str,
    seed: int = 0,
    pure: bool = True,
    labels: int = 0,
    learner: Learner | None = None,
    on_demo: Callable[[], None] = lambda: None,
) -> ConceptsReport:
    """Learn concepts from demos and score them.

    Args:
        demos: The demos in the order in which they are seen; each is needed once.
        total: How many they are, for the memory curve.
        spaces: The feature spaces.
        rules: True classes of places, directions and distances.
        robot: Whose table of the thesis stands beside.
        seed: Seed of everything random.
        pure: Whether the pure IGMM is run too.
        labels: How many objects a user names in a second run: one a demo, colour and shape.
        learner: Learns from the sentences too, with its own concepts; None looks only.
        on_demo: Called after every demo.

    Raises:
        LearningError: There are no demos, or no instance of any class.
    """
    known = ConceptSpaces(spaces) if learner is None else learner.knowledge.spaces
    labelled = ConceptSpaces(spaces) if labels else None
    igmm = PureIgmm(spaces.spaces) if pure else None
    rng = np.random.default_rng(seed)
    seen = _Seen()
    every = max(1, total // MEMORY_POINTS)
    for number, demo in enumerate(demos):
        action = _learn(demo, known, learner, rng, seen)
        values = feature_values(demo.observation, rng, spaces)
        if igmm is not None:
            for space in spaces.spaces:
                points = values[space.name][0]
                chosen = rng.choice(len(points), min(MOST_POINTS, len(points)), replace=False)
                igmm.update(space, points[chosen])
        if labelled is not None:
            said = _said(demo, number, labels, spaces)
            labelled.update(fit_demo(demo.observation, rng, spaces, said))
        instances = instances_of(demo.observation, demo.truth, rules, spaces, rng)
        for name, classes in demo.truth.properties.items():
            if name in spaces.names:
                seen.unmeasured[name] += sum(each is not None for each in classes) - len(instances.get(name, ()))
        for row, found in instances.items():
            seen.rows.setdefault(row, []).extend((number, value, name) for value, name in found)
        if demo.truth.action is not None:
            value = action_values(demo.observation)
            seen.rows.setdefault("action", []).append((number, value, demo.truth.action))
            seen.actions.append(action)
        _count(demo, seen)
        if number % every == 0 or number == total - 1:
            language = None if learner is None else learner.knowledge.language.to_json()
            seen.memory.append(MemoryPoint(number + 1, sizes(known.to_json(), language), seen.raw))
        on_demo()
    if not seen.rows:
        raise LearningError("no demo shows anything whose true class is known: there is nothing to score")
    return ConceptsReport(
        robot=robot,
        rows=tuple(_rows(seen, known, igmm, labelled, spaces, seed)),
        summary=_summary(seen),
        memory=tuple(seen.memory),
        first_ms=1000.0 * median(seen.seconds[WARMED_UP:][:SPAN] or seen.seconds),
        last_ms=1000.0 * median(seen.seconds[-SPAN:]),
        seed=seed,
        settings={"space_set": spaces.name, "svm": SETTINGS, "pure_igmm": pure, "labels": labels},
    )


def _learn(
    demo: ScoredDemo, known: ConceptSpaces, learner: Learner | None, rng: np.random.Generator, seen: _Seen
) -> int:
    """Learn from a demo as a learner does, timed; returns the number of its action."""
    begun = process_time()
    concepts = fit_demo(demo.observation, rng, known.space_set)
    if learner is not None:
        learner.study(demo.observation, demo.utterances, concepts)
    else:
        known.update(concepts)
    try:
        graphlet, measures, _ = shown_action(demo.observation, known)
        if learner is None:
            action = known.actions.match_or_add(graphlet, measures)
        else:
            found = known.actions.find(graphlet, measures)
            action = NO_CONCEPT if found is None else found
    except PerceptionError:
        action = NO_CONCEPT
    seen.seconds.append(process_time() - begun)
    return action


def _said(demo: ScoredDemo, number: int, labels: int, spaces: SpaceSet) -> Labels | None:
    """What a user says of one object of this demo, while there are labels left."""
    things = len(demo.observation.object_ids)
    if number >= labels or not things:
        return None
    index = number % things
    said: Mapping[str, str | None] = {
        name: names[index] for name, names in demo.truth.properties.items() if name in spaces.names
    }
    return {int(demo.observation.object_ids[index]): {name: word for name, word in said.items() if word is not None}}


def _count(demo: ScoredDemo, seen: _Seen) -> None:
    seen.groups.append(demo.group)
    seen.frames += len(demo.observation.times)
    seen.objects += len(demo.observation.object_ids)
    seen.commands += len(demo.utterances)
    seen.raw += demo.raw
    for utterance in demo.utterances:
        seen.words.update(words_of(utterance))


def _summary(seen: _Seen) -> CollectionSummary:
    clips = len(seen.groups)
    return CollectionSummary(clips, seen.frames, seen.commands, len(seen.words), seen.objects / max(clips, 1))


def _rows(
    seen: _Seen,
    known: ConceptSpaces,
    igmm: PureIgmm | None,
    labelled: ConceptSpaces | None,
    spaces: SpaceSet,
    seed: int,
) -> Iterable[ConceptRow]:
    """Score every row: spaces in their order, actions, then rows by further rules."""
    order = [name for name in (*spaces.names, "action") if name in seen.rows]
    order += sorted(set(seen.rows) - set(order))
    groups = np.array(seen.groups, dtype=np.int64)
    for name in order:
        space = name.partition(",")[0]
        found = gathered(space, seen.rows[name])
        if space == "action":
            numbers = np.array([known.actions.resolve(each) for each in seen.actions], dtype=np.int64)
        else:
            numbers = known.mixtures[space].classify(found.values)
        ours = cluster_scores(list(found.classes), list(numbers))
        if ours is None:
            continue
        row = ConceptRow(
            name=name,
            space=space,
            instances=len(found.classes),
            classes=len(np.unique(found.classes)),
            concepts=len(np.unique(numbers[numbers != NO_CONCEPT])),
            known=len(known.actions) if space == "action" else len(known.mixtures[space].components),
            ours=ours,
            svm=_svm_score(found, groups, seed),
            unmeasured=seen.unmeasured[name],
        )
        if igmm is not None and space in igmm.mixtures and igmm.mixtures[space].components:
            mixture = igmm.mixtures[space]
            scores = cluster_scores(list(found.classes), list(mixture.classify(found.values)))
            row = replace(row, pure=scores, pure_known=len(mixture.components))
        if labelled is not None and space in labelled.mixtures:
            named = labelled.mixtures[space].classify(found.values)
            scores = cluster_scores(list(found.classes), list(named))
            gained = None if scores is None else scores.v_measure
            row = replace(row, labelled=gained, labelled_concepts=len(np.unique(named)))
        yield row


def _svm_score(found: Instances, groups: NDArray[np.int64], seed: int) -> float | None:
    """V-measure of the SVM with its best C; None where there are too few demos or classes."""
    predictions = svm_predictions(found.values, found.classes, groups[found.demos], seed)
    scores = [cluster_scores(list(found.classes), list(answer)) for answer in predictions or ()]
    return max((score.v_measure for score in scores if score is not None), default=None)

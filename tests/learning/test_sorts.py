"""Words tell apart what looks alike, and names that go together are of one kind."""

import numpy as np

from learning.grounding.namings import Namings
from learning.grounding.sorts import Sorts
from learning.percept import NO_CONCEPT


def test_things_of_one_concept_are_told_apart_by_what_they_are_called() -> None:
    rng = np.random.default_rng(0)
    sorts = Sorts()
    centres = {"fork": np.zeros(6), "knife": np.array([0.0, 0.3, 0.0, 0.0, 0.0, 0.0])}
    spread = np.array([1.0, 0.03, 1.0, 1.0, 1.0, 1.0])  # they differ only where they scatter little
    for _ in range(40):
        for kind, centre in centres.items():
            sorts.see(kind, centre + spread * rng.normal(size=6))
    values = np.array([centre + spread * rng.normal(size=6) for centre in centres.values() for _ in range(20)])
    found = sorts.told_apart(values, np.zeros(40, dtype=np.int64), np.zeros(2, dtype=np.int64))
    # The shrunk covariance blurs the one telling direction: a few of the closest pairs may go wrong.
    assert np.mean(found == np.repeat([0, 1], 20)) > 0.9


def test_a_concept_with_one_sort_stays_as_it_is() -> None:
    sorts = Sorts()
    for _ in range(4):
        sorts.see("mug", np.zeros(3))
        sorts.see("fork", np.ones(3))
    found = sorts.told_apart(np.zeros((2, 3)), np.array([0, 1]), np.array([0, 1]))
    assert found.tolist() == [NO_CONCEPT, NO_CONCEPT]


def test_sorts_survive_json() -> None:
    sorts = Sorts()
    for value in np.random.default_rng(1).normal(size=(6, 4)):
        sorts.see("fork", value)
    assert Sorts.from_json(sorts.to_json()).to_json() == sorts.to_json()


def test_names_said_of_one_thing_are_one_kind_and_others_are_not() -> None:
    namings = Namings()
    for _ in range(4):
        namings.hear(["cube", "block"])
        namings.hear(["fork"])
    assert namings.kind(["block"]) == namings.kind(["cube"])
    assert namings.kind(["fork"]) not in (None, namings.kind(["cube"]))
    assert namings.kind(["never heard"]) is None


def test_a_vague_name_is_no_kind() -> None:
    namings = Namings()
    for _ in range(6):
        namings.hear(["cube", "object"])
        namings.hear(["fork", "object"])
    assert namings.kind(["object"]) is None
    assert namings.kind(["fork", "object"]) == namings.kind(["fork"])

"""Scripted collections (thesis 6.2): `leeds` on Baxter, `ordering` on the Mico; `counter`, actions alone, on the Mico.

A person drives the robot with velocity commands; what can be reached is tried in the mind first (`Rehearsal`), what was
shown is judged by physics (`rules`). Seed 0 gives the collections that evaluations use.
"""

from .attempt import Attempt
from .counter import COUNTER_COUNT, CounterCollection
from .leeds import LEEDS_COUNT, LeedsCollection
from .making import Made, ScriptedCollection, make_collection, make_demo
from .ordering import ORDERING_COUNT, OrderingCollection

__all__ = [
    "COUNTER_COUNT",
    "LEEDS_COUNT",
    "ORDERING_COUNT",
    "Attempt",
    "CounterCollection",
    "LeedsCollection",
    "Made",
    "OrderingCollection",
    "ScriptedCollection",
    "make_collection",
    "make_demo",
]

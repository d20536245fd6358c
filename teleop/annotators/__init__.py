"""Annotators: scripted people who describe demos in English and Arabic, each in their own words, with some mistakes."""

from .facts import Column, Destination, OrderingFacts, Place, Relation, Row, TableAction, TableFacts, Thing, place_at
from .grammar import GRAMMARS
from .telling import tell_ordering, tell_table
from .told import Told

LANGUAGES = tuple(GRAMMARS)
"""Tags of the languages that are spoken."""

__all__ = [
    "LANGUAGES",
    "Column",
    "Destination",
    "OrderingFacts",
    "Place",
    "Relation",
    "Row",
    "TableAction",
    "TableFacts",
    "Thing",
    "Told",
    "place_at",
    "tell_ordering",
    "tell_table",
]

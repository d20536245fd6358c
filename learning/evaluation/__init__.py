"""Scoring of what was learned. Only the scorer sees the truth of a demo and the tree annotations of a release.

`cross_validate` and `examine` ask a learner the commands of a Train-Robots release; nothing else in `learning` imports
this package.
"""

from learning.evaluation.annotation import load_annotations
from learning.evaluation.answers import Learn, Student
from learning.evaluation.folds import Fold, Split, make_folds
from learning.evaluation.train_robots import TrainRobotsReport, cross_validate, examine

__all__ = [
    "Fold",
    "Learn",
    "Split",
    "Student",
    "TrainRobotsReport",
    "cross_validate",
    "examine",
    "load_annotations",
    "make_folds",
]

"""Interpretation: a sentence in a perceived scene becomes an RCL tree and a goal."""

from learning.interpretation.interpretation import Goal, Interpretation
from learning.interpretation.interpreter import Interpreter

__all__ = ["Goal", "Interpretation", "Interpreter"]

"""Interpretation: a sentence in a perceived scene becomes an RCL tree and a goal."""

from learning.interpretation.interpreter import Goal, Interpretation, Interpreter

__all__ = ["Goal", "Interpretation", "Interpreter"]

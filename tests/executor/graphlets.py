"""Actions as they are usually learned, made by hand."""

from learning.graphs import ActionGraphlet, GraphletState

State = GraphletState
APART, TOUCH, GRIP, CARRIED = State(False, False, 0), State(False, True, 0), State(True, True, 0), State(True, True, 1)
PUT, LEFT = State(False, True, 1), State(False, False, 1)
MOVE = ActionGraphlet((APART, TOUCH, GRIP, CARRIED, PUT, LEFT))
PICK_UP = ActionGraphlet((APART, TOUCH, GRIP, State(True, True, 0, raised=True)))

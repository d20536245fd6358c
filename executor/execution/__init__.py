"""Carrying out commands so that the answer can be trusted: what is common to all robots, and the board.

- `Answer` is the kind of an answer, `Understood` one step of a command as understood in the scene as seen.
- `Doer` is what a robot in its world has to offer: it understands one step, carries it out, and leaves its hand sound;
  `BoardDoer` is that of the board. `doer_for` chooses it.
- `steps_of` splits a command into steps; `History` goes back to before a command; `Session` is a dialogue.
- `unlearn` lets knowledge forget how it came to a wrong deed; `locked` keeps two programs off one file.
"""

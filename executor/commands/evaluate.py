"""`showtell evaluate`: how good is what was learned? One command an experiment."""

import typer

from executor.commands import (
    evaluate_actions,
    evaluate_concepts,
    evaluate_describe,
    evaluate_execution,
    evaluate_language,
    evaluate_tracking,
    evaluate_train_robots,
)
from executor.commands.output import ShowtellGroup

app = typer.Typer(
    cls=ShowtellGroup, no_args_is_help=True, help="Reproduce an experiment, with our figures and each baseline's."
)

evaluate_actions.add_to(app)
evaluate_concepts.add_to(app)
evaluate_describe.add_to(app)
evaluate_execution.add_to(app)
evaluate_language.add_to(app)
evaluate_tracking.add_to(app)
evaluate_train_robots.add_to(app)


@app.callback()
def _experiments() -> None:
    """Reproduce an experiment, with our figures and each baseline's."""

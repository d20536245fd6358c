"""`showtell evaluate actions`: are actions learned from a few demos, and can they be done again, by any robot?"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import Json, Output, Seed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from executor.actions.evaluation import ActionsReport
    from executor.actions.learned import LearnedAction
    from executor.actions.trials import Tried
    from learning.evaluation.actions import ActionScore


def actions(
    demos: Annotated[
        list[Path], typer.Argument(help="Folders of demos with their truth beside them, each of one robot.")
    ],
    robot: Annotated[str | None, typer.Option(help="Robot that replays; that of the demos if not given.")] = None,
    source: Annotated[
        str | None, typer.Option("--from", help="Robot whose demos are learned from; --robot if not given.")
    ] = None,
    transfer: Annotated[
        bool, typer.Option("--transfer", help="What each robot showed is done by each of the others.")
    ] = False,
    action: Annotated[list[str] | None, typer.Option(help="Replay this action only; may be given again.")] = None,
    scenes: Annotated[int, typer.Option(min=0, help="New scenes for each action.")] = 50,
    learned: Annotated[int, typer.Option(min=1, help="Demos of each action that are learned from.")] = 5,
    scored: Annotated[int, typer.Option(min=1, help="Demos of each action that are named, for the V-measure.")] = 10,
    knowledge: Annotated[Path | None, typer.Option(help="Go on from what was learned before.")] = None,
    cache: Annotated[Path | None, typer.Option(help="Folder in which what was perceived is kept.")] = None,
    failures: Annotated[int, typer.Option(min=0, help="How many failures to list.")] = 10,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Learn actions from at most five demos of each, and replay each in new scenes, judged by physics.

    Example: showtell evaluate actions ordering/ --scenes 50 --json

    Example: showtell evaluate actions board/ leeds/ counter/ --transfer
    """
    from executor.actions.evaluation import ActionsReport

    out = Output(as_json)
    scores, known = _learn(
        out, demos, source or (None if transfer else robot), knowledge, learned, scored, cache, jobs, seed
    )
    tried = _replay(out, known, robot, transfer, action, scenes, jobs, seed)
    settings = {"scenes": scenes, "learned_demos": learned, "scored_demos": scored, "demos": list(map(str, demos))}
    report = ActionsReport(scores, known, tried, settings, seed)
    tell(out, report, failures)
    out.result(report.to_json())


def _learn(
    out: Output,
    folders: "Sequence[Path]",
    source: str | None,
    knowledge: Path | None,
    learned: int,
    scored: int,
    cache: Path | None,
    jobs: int,
    seed: int,
) -> tuple[dict[str, "ActionScore"], list["LearnedAction"]]:
    """Scores by robot, and all actions learned."""
    import numpy as np

    from executor.actions.learned import learn_actions
    from executor.actions.shown_demos import observed, shown_demos
    from executor.errors import InputError
    from learning import Knowledge

    shown = shown_demos(folders, max(learned, scored), out.note)
    robots = sorted({each.robot for each in shown})
    if source is not None and source not in robots:
        raise InputError(f"no demo was recorded with {source}; the demos are of {', '.join(robots)}")
    scores: dict[str, ActionScore] = {}
    known: list[LearnedAction] = []
    for robot in robots if source is None else [source]:
        mine = [each for each in shown if each.robot == robot]
        with out.progress(f"looking at {robot}", len(mine)) as advance:
            pairs = observed(mine, cache, seed, jobs, advance, out.note)
        if not pairs:
            raise InputError(f"no demo of {robot} could be perceived; see the notes above")
        spaces = None if knowledge is None else Knowledge.load(knowledge).spaces
        scores[robot], found = learn_actions(pairs, robot, np.random.default_rng(seed), spaces, learned)
        known += found
    return scores, known


def _replay(
    out: Output,
    known: "Sequence[LearnedAction]",
    robot: str | None,
    transfer: bool,
    names: list[str] | None,
    scenes: int,
    jobs: int,
    seed: int,
) -> list["Tried"]:
    """Try what was learned."""
    from executor.actions.evaluation import TRANSFERRED
    from executor.actions.success import RULES
    from executor.actions.trials import try_actions
    from executor.errors import InputError

    for name in names or ():
        if name not in RULES:
            raise InputError(f"action {name!r} has no rule of success; choose from {', '.join(RULES)}")
    shown_by = list(dict.fromkeys(each.robot for each in known))
    tried: list[Tried] = []
    for source in shown_by:
        others = [each for each in shown_by if each != source] if robot is None else [robot]
        for target in others if transfer else [robot or source]:
            wanted = names or (TRANSFERRED if transfer else tuple(RULES))
            mine = [each for each in known if each.robot == source and each.name in wanted]
            with out.progress(f"{target} does what {source} showed", scenes * len(mine)) as advance:
                tried += try_actions(mine, target, scenes, seed, jobs, advance)
    return tried


def tell(out: Output, report: "ActionsReport", failures: int) -> None:
    """Print what was learned, how it went, and why some of it failed."""
    for robot, score in report.scores.items():
        out.say(
            f"{robot}: {score.graphlets} action concepts for {score.true_actions} actions; V-measure "
            f"{score.v_measure:.3f} (homogeneity {score.homogeneity:.3f}, completeness {score.completeness:.3f})"
        )
        rows = [(each.name, str(each.graphlet)) for each in report.learned if each.robot == robot]
        out.table(f"Actions shown by {robot}", ("action", "graphlet learned"), rows)
        for line in score.lines():
            out.say(f"  {line}")
    pairs = list(dict.fromkeys((each.source, each.robot, each.action) for each in report.tried))
    shares = []
    for source, robot, action in pairs:
        mine = [each for each in report.tried if (each.source, each.robot, each.action) == (source, robot, action)]
        good = sum(not each.fault for each in mine)
        shares.append((source, robot, action, f"{good} of {len(mine)}", f"{good / len(mine):.3f}"))
    if shares:
        out.table("Replayed in new scenes", ("shown by", "done by", "action", "succeeded", "share"), shares)
    if report.causes():
        out.table(
            "Failures by cause",
            ("shown by", "done by", "action", "cause", "trials"),
            [(*each[:4], str(each[4])) for each in report.causes()],
        )
    wrong = [each for each in report.tried if each.fault][:failures]
    if wrong:
        out.table(
            f"First {len(wrong)} failures",
            ("done by", "action", "trial", "object", "reason"),
            [(each.robot, each.action, str(each.number), each.thing, each.fault) for each in wrong],
        )
    figures = {name: value for name, value in report.figures().items() if value is not None}
    out.table("Figures", ("figure", "value"), [(name, f"{value:.3f}") for name, value in figures.items()])
    out.say(f"settings: {dict(report.settings)}; seed {report.seed}")


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(actions)

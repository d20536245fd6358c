"""`showtell describe`: a sentence for what a demo shows, or for where the things of a scene are."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import FAILED, Json, Output, Seed

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.perception import Observation
    from learning.saying.speaker import Speaker

SCRIPTS = {"en": "LATIN", "ar": "ARABIC"}
"""Script that a language is written in: what was heard in it is what is spoken."""


def describe(
    knowledge: Annotated[Path, typer.Argument(help="Knowledge file that `showtell learn` wrote.")],
    demo: Annotated[Path | None, typer.Argument(help="Demo to say what it shows.")] = None,
    scene: Annotated[
        str | None,
        typer.Option(
            help="Say where things are instead: `board`, `board-all`, `tabletop`, `ordering` or a scene's TOML file."
        ),
    ] = None,
    robot: Annotated[str | None, typer.Option(help="Robot to use instead of the scene's own.")] = None,
    obj: Annotated[
        list[int] | None, typer.Option("--object", min=0, help="Thing to tell of, from 0; all without it.")
    ] = None,
    language: Annotated[
        str | None, typer.Option(help="Language to speak: `en`, `ar` or a script; all that were heard without it.")
    ] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Say what a demo shows, or where each thing of a scene is, in words that were learned.

    Every sentence is read back before it is said: it is understood as that event, or as that thing alone.

    Example: showtell describe knowledge.json demos/board_0001.mcap

    Example: showtell describe knowledge.json --scene board --seed 7 --object 2
    """
    from executor.errors import InputError
    from executor.files import existing
    from executor.knowledge_fit import usual_scene
    from learning import Knowledge

    out = Output(as_json)
    learned = Knowledge.load(existing(knowledge, "knowledge file"))
    if (demo is None) == (scene is None):
        raise InputError(f"give either a demo or --scene with a scene, such as --scene {usual_scene(learned)}")
    if demo is not None:
        seen = seen_in_demo(learned, knowledge, existing(demo, "demo"), seed)
        rows = _event(speakers_of(learned, language), seen)
    else:
        seen = seen_in_scene(learned, knowledge, scene or "", robot, seed)
        rows = _things(speakers_of(learned, language), seen, obj)
    for row in rows:
        what = "" if row["object"] is None else f"object {row['object']}: "
        out.say(f"{what}{row['text'] or row['reason']}")
    out.result({"sentences": rows, "seed": seed})
    if not all(row["text"] for row in rows):
        raise typer.Exit(FAILED)


def speakers_of(knowledge: "Knowledge", language: str | None) -> "list[Speaker]":
    """One speaker for each language that is asked for.

    Raises:
        KnowledgeError: It was not learned.
    """
    from learning.saying.speaker import Speaker

    if language is not None:
        return [Speaker(knowledge, SCRIPTS.get(language, language.upper()))]
    scripts = sorted(knowledge.phrasings.by_script)
    return [Speaker(knowledge, script) for script in scripts] or [Speaker(knowledge)]


def seen_in_demo(knowledge: "Knowledge", source: Path, path: Path, seed: int) -> "Observation":
    """What is seen in a demo; what a camera saw is kept for the next time.

    Raises:
        InputError: The knowledge is of boards and the demo shows a table, or the other way round.
    """
    import numpy as np

    from executor.commands.perceive import CACHE
    from executor.demo_files import open_demo
    from executor.knowledge_fit import check_fit
    from learning.perception import perceive_any
    from learning.perception.stage import perceive_one

    demo = open_demo(path)
    check_fit(knowledge, demo.scene.kind, source)
    if demo.scene.kind == "board":
        return perceive_any(demo, np.random.default_rng(seed)).observation
    return perceive_one(path, path.parent / CACHE, seed).observation().observation


def seen_in_scene(knowledge: "Knowledge", source: Path, scene: str, robot: str | None, seed: int) -> "Observation":
    """What is seen in a scene that stands still.

    Raises:
        InputError: The knowledge is of boards and the scene is a table, or the other way round.
    """
    import numpy as np

    from executor.knowledge_fit import check_fit
    from learning.perception import observe_camera_world, observe_world
    from twin import World

    rng = np.random.default_rng(seed)
    with World.from_scene(scene, robot=robot, seed=seed) as world:
        check_fit(knowledge, world.spec.kind, source)
        look = observe_world if world.spec.kind == "board" else observe_camera_world
        return look(world.state(), world.spec, rng)


def _event(speakers: "list[Speaker]", seen: "Observation") -> list[dict[str, object]]:
    rows = []
    for speaker in speakers:
        said = speaker.event(seen)
        why = "no sentence was found that is understood as what was shown"
        rows.append(_row(speaker.script, None, said, why))
    return rows


def _things(speakers: "list[Speaker]", seen: "Observation", asked: list[int] | None) -> list[dict[str, object]]:
    rows = []
    for index in range(len(seen.object_ids)) if asked is None else asked:
        for speaker in speakers:
            why = "no phrase was found that tells it from all others"
            rows.append(_row(speaker.script, index, speaker.thing(seen, index), why))
    return rows


def _row(script: str, index: int | None, said: object, why: str) -> dict[str, object]:
    from learning.saying.saying import Saying

    if not isinstance(said, Saying):
        return {"object": index, "script": script, "text": "", "reason": why}
    numbers = {"log_probability": round(said.score, 3), "share": round(said.share, 4), "tried": said.tried}
    return {
        "object": index,
        "script": script,
        "text": said.text,
        "tree": said.tree.draw(tuple(said.text.split(" "))),
        **numbers,
    }


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(describe)

"""`showtell inspect`: what was learned, or how a sentence is understood."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import FAILED, Json, Output, Seed

if TYPE_CHECKING:
    from executor.explanation import Explanation
    from learning import Knowledge


def inspect(
    knowledge: Annotated[Path, typer.Argument(help="Knowledge file that `showtell learn` wrote.")],
    sentence: Annotated[str | None, typer.Argument(help="A sentence to understand.")] = None,
    scene: Annotated[
        str | None,
        typer.Option(
            help="Scene for the sentence: `board`, `board-all`, `tabletop`, `ordering` or a scene's TOML file; what "
            "the knowledge was learned on if left out."
        ),
    ] = None,
    robot: Annotated[str | None, typer.Option(help="Robot to use instead of the scene's own.")] = None,
    rules: Annotated[int, typer.Option(min=0, help="How many grammar rules to list.")] = 25,
    everything: Annotated[bool, typer.Option("--all", help="List concepts that no word means, too.")] = False,
    html: Annotated[Path | None, typer.Option(help="Write what was learned as one HTML page, with drawings.")] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Show what was learned as tables or as a page, or how a sentence is understood in a scene and why so.

    Example: showtell inspect knowledge.json "put the red cube on the blue cube" --seed 7

    Example: showtell inspect knowledge.json --html knowledge.html
    """
    from executor.knowledge_fit import usual_scene
    from learning import Knowledge

    out = Output(as_json)
    learned = Knowledge.load(knowledge)
    if html is not None:
        _write_page(out, learned, html, knowledge.name)
    if sentence is None:
        tell_knowledge(out, learned, rules, everything)
    else:
        _understand(out, learned, knowledge, sentence, scene or usual_scene(learned), robot, seed)


def tell_knowledge(out: Output, knowledge: "Knowledge", rules: int, everything: bool = False) -> None:
    """Print concepts with their words, actions, grammar and sizes."""
    from executor.learned_tables import action_rows, concept_rows, function_words, part_sizes, rule_rows
    from executor.table_words import table_words, tell_table_words

    concepts = concept_rows(knowledge)
    actions = action_rows(knowledge)
    grammar = rule_rows(knowledge, rules)
    sizes = part_sizes(knowledge)
    passed = function_words(knowledge)
    tell_words(out, knowledge, everything)
    tell_table_words(out, knowledge)
    if grammar:
        shown = [(left, right, f"{probability:.3f}", f"{count:.1f}") for left, right, probability, count in grammar]
        out.table("Grammar Π (most frequent rules)", ("element", "becomes", "probability", "count"), shown)
    total = sum(sizes.values())
    out.table(
        f"Size of each part: {total / 1000:.1f} kB in all",
        ("part", "kB"),
        [(part, f"{size / 1000:.1f}") for part, size in sizes.items()],
    )
    out.say(f"{knowledge.demos} demos seen, {knowledge.sentences} sentences heard")
    out.result(
        {
            "demos": knowledge.demos,
            "sentences": knowledge.sentences,
            "concepts": {
                str(concept): {"mean": mean, "demos": demos, "words": {ngram: round(p, 4) for ngram, p, _ in words}}
                for concept, mean, demos, words in concepts
            },
            "actions": {
                str(concept): {"states": states, "words": {ngram: round(p, 4) for ngram, p, _ in words}}
                for concept, states, words in actions
            },
            "passed_over": passed,
            "languages": table_words(knowledge),
            "rules": [
                {"left": left, "right": right, "probability": round(p, 4), "count": round(n, 2)}
                for left, right, p, n in grammar
            ],
            "bytes": sizes,
        }
    )


def tell_words(out: Output, knowledge: "Knowledge", everything: bool = False) -> None:
    """Print the concepts of each space with a patch of their colour and their words, then actions."""
    from rich.text import Text

    from executor.learned_tables import action_rows, colour_of, concept_rows, function_words, spoken

    rows = []
    silent = 0
    for concept, mean, demos, words in concept_rows(knowledge):
        if not words and not everything:
            silent += 1
            continue
        patch = Text("      ")
        if concept.space == "colour":
            mixture = knowledge.spaces.mixtures["colour"]
            colour = "rgb({},{},{})".format(*colour_of(mixture.components[concept.number].mean, mixture.space))
            patch = Text("      ", style=f"on {colour}")
        rows.append((str(concept), patch, mean, demos or "", spoken(words)))
    columns = ("concept", "", "its mean", "demos", "words that mean it (Φ)")
    note = f"; {silent} more have no word" if silent else ""
    out.table(f"Concepts{note}", columns, rows)
    out.table(
        "Actions (O open, C closed; touching or apart; place of the object)",
        ("concept", "states", "words that mean it (Φ)"),
        [(str(concept), states, spoken(words)) for concept, states, words in action_rows(knowledge)],
    )
    passed = function_words(knowledge)
    if passed:
        out.say("words that carry no concept: " + ", ".join(passed[:20]))


def _write_page(out: Output, learned: "Knowledge", html: Path, source: str) -> None:
    """Write the page."""
    from executor.files import written_whole
    from executor.knowledge_page import knowledge_page

    with written_whole(html) as temporary:
        temporary.write_text(knowledge_page(learned, source), encoding="utf-8")
    out.say(f"wrote {html}")


def _understand(
    out: Output, knowledge: "Knowledge", source: Path, sentence: str, scene: str, robot: str | None, seed: int
) -> None:
    """Print how a sentence is understood in a scene, and why so."""
    from dataclasses import asdict

    from executor.commands.describe import seen_in_scene
    from executor.errors import InputError
    from executor.explain_board import explain_board, explain_plainly
    from executor.explain_table import explain_table
    from learning import Interpreter
    from learning.concepts.space_set import BOARD
    from learning.grounding.reading_learner import ReadingLearner
    from learning.perception import percept_of

    if not sentence.split():
        raise InputError("the sentence is empty; leave it out to see what was learned")
    seen = seen_in_scene(knowledge, source, scene, robot, seed)
    if knowledge.spaces.space_set.name != BOARD.name:
        told = explain_table(knowledge, sentence, seen)
    else:
        percept = percept_of(seen, knowledge.spaces)
        if isinstance(knowledge.language, ReadingLearner):
            told = explain_board(knowledge, knowledge.language, sentence, percept)
        else:
            told = explain_plainly(Interpreter(knowledge).interpret(sentence, percept))
    _tell_explanation(out, told)
    out.result({"sentence": sentence, **asdict(told), "explanation": told.summary, "seed": seed, "scene": scene})
    if not told.understood:
        raise typer.Exit(FAILED)


def _tell_explanation(out: Output, told: "Explanation") -> None:
    rows = [(row.word, row.meant or "passed over", row.usual) for row in told.words]
    out.table("Words", ("word", "means here", "usually (share of its readings)"), rows)
    if told.tree is not None:
        out.say(told.tree)
    referents = [(each.words, each.what, each.found) for each in told.referents]
    if referents:
        out.table("What its parts are about", ("words", "as", "in this scene"), referents)
    if told.alternatives:
        others = [(each.tree, each.does, f"{each.share:.3f}", each.why) for each in told.alternatives]
        out.table("What else it could mean", ("reading", "would be about", "share", "why it lost"), others)
    for note in told.notes:
        out.say(note)
    if told.plain is not None:
        out.say(f"by words and grammar alone, without the scene: {told.plain}")
    share = "" if told.confidence is None else f" (share of all readings {told.confidence:.2f})"
    out.say(f"{told.summary}{share}")


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(inspect)

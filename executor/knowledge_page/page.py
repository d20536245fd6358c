"""The page `showtell inspect --html` writes: one file, nothing loaded from elsewhere, no script."""

from html import escape
from typing import TYPE_CHECKING

import numpy as np

from executor.knowledge_page.concept_charts import compass_rose, density_curves, histogram, plan, swatch
from executor.knowledge_page.graphlet_drawing import draw_graphlet
from executor.learned_tables import WORDS, colour_of, part_sizes, words_of_concepts
from learning.concept_id import ACTION_SPACE, Concept

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.concepts.feature_space import FeatureSpace
    from learning.concepts.gaussian import Gaussian

Words = dict[Concept, list[tuple[str, float, float]]]

STYLE = """
:root{--ink:#1c2126;--faint:#69727b;--paper:#fff;--card:#f4f5f7;--edge:#c5cad0;--blob:#3b6fb655;--mark:#3b6fb6;--new:#ffd98a}
@media (prefers-color-scheme:dark){:root{--ink:#e8eaed;--faint:#9aa3ac;--paper:#15181b;--card:#1f2428;--edge:#454c53;
--blob:#7aa7e855;--mark:#7aa7e8;--new:#7a5a12}}
body{font:15px/1.45 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:72rem;margin:2rem auto;
padding:0 1rem}
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2.2rem}p,figcaption{color:var(--faint)}
.cards{display:flex;flex-wrap:wrap;gap:.7rem}.card{background:var(--card);padding:.6rem .8rem;border-radius:.5rem}
.card b{display:block}.words{max-width:15rem}.wide{overflow-x:auto}
svg{display:block;max-width:none;font:12px system-ui,sans-serif}svg text{fill:var(--ink)}svg .faint{fill:var(--faint)}
.frame{stroke:var(--edge)}.thin{stroke:var(--edge);fill:none}.edge{stroke:var(--edge);fill:none}.bar{fill:var(--mark)}
.blob{fill:var(--blob);stroke:var(--mark)}.hollow{fill:none;stroke:var(--mark);stroke-dasharray:3 2}
.curve{fill:none;stroke:var(--mark);stroke-width:1.5}.arrow{stroke:var(--ink);stroke-width:1.5}
.node,.leaf{fill:var(--paper);stroke:var(--ink)}.leaf{stroke:var(--edge)}.changed{fill:var(--new)}
.connection{fill:var(--edge);stroke:var(--ink)}
table{border-collapse:collapse}td{padding:.15rem .8rem .15rem 0}td:last-child{text-align:right}
"""


def knowledge_page(knowledge: "Knowledge", source: str) -> str:
    """Write what was learned as one HTML document.

    Args:
        knowledge: What was learned.
        source: Name of its file, for the title.
    """
    words = words_of_concepts(knowledge)
    parts = [
        f"<h1>What was learned: {escape(source)}</h1>",
        f"<p>{knowledge.demos} demos seen, {knowledge.sentences} sentences heard. Ids carry no meaning: the words "
        "beside a concept are those that were learned to mean it, with their probability.</p>",
    ]
    for mixture in knowledge.spaces.mixtures.values():
        parts += _space(mixture.space, dict(mixture.components), words)
    parts += _actions(knowledge, words)
    parts += _sizes(knowledge)
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(source)}</title><style>{STYLE}</style></head><body>\n"
        + "\n".join(parts)
        + "\n</body></html>\n"
    )


def knowledge_sections(knowledge: "Knowledge") -> list[tuple[str, str, str]]:
    """The concepts of each feature space and the actions, drawn: name, title and HTML of each; for a page of others."""
    words = words_of_concepts(knowledge)
    actions = _actions(knowledge, words)
    found = [("actions", "Actions", "\n".join(actions[1:]) or "<p>No action was seen yet.</p>")]
    for space, mixture in knowledge.spaces.mixtures.items():
        found.append((space, space.capitalize(), "\n".join(_space(mixture.space, dict(mixture.components), words)[1:])))
    return found


def _space(kind: "type[FeatureSpace]", components: "dict[int, Gaussian]", words: Words) -> list[str]:
    """A feature space: a drawing of all its concepts where that shows them best, and a card for each.

    Those that words mean come first, the most often seen first; the others are folded away.
    """
    space = kind.name
    parts = [f"<h2>{escape(space)}: {len(components)} concepts</h2>"]
    if not components:
        return [*parts, "<p>Nothing was learned of it.</p>"]
    dimension = len(next(iter(components.values())).mean)
    if space == "direction":
        parts.append(_figure(compass_rose(components), "As the robot sees it from above. Dashed: downwards."))
    elif space == "location":
        parts.append(_figure(plan(components), "Two standard deviations of each place."))
    elif dimension == 1:
        unit, factor = {"distance": ("mm", 1000.0), "weight": ("g", 1000.0)}.get(space, ("", 1.0))
        parts.append(_figure(density_curves(components, unit, factor), f"Each concept of {space}, to its own height."))
    said: list[str] = []
    unsaid: list[str] = []
    for number, component in sorted(components.items(), key=lambda each: -each[1].demos):
        sketch = ""
        if space == "colour":
            sketch = swatch(colour_of(component.mean, kind))
        elif dimension > 3:
            sketch = histogram(np.abs(component.mean[:33]))
        concept = Concept(space, number)
        (said if concept in words else unsaid).append(_card(concept, component.demos, sketch, words))
    if said:
        parts += ['<div class="cards">', *said, "</div>"]
    if unsaid:
        summary = f"{len(unsaid)} {'more ' if said else ''}that no word means"
        parts += [f'<details><summary>{summary}</summary><div class="cards">', *unsaid, "</div></details>"]
    return parts


def _actions(knowledge: "Knowledge", words: Words) -> list[str]:
    """Every action graphlet, drawn."""
    numbered = knowledge.spaces.actions.numbered
    parts = [f"<h2>actions: {len(numbered)} graphlets</h2>"]
    if numbered:
        parts.append("<p>What changes from state to state is marked; L stands for a place, whichever it is.</p>")
    for number, graphlet in numbered.items():
        concept = Concept(ACTION_SPACE, number)
        parts.append(f'<div class="card wide" tabindex="0"><b>{escape(str(concept))}</b>{draw_graphlet(graphlet)}')
        parts.append(f"<div>{_spoken(words.get(concept, []))}</div></div><br>")
    return parts


def _sizes(knowledge: "Knowledge") -> list[str]:
    """Size of the knowledge, part by part."""
    sizes = part_sizes(knowledge)
    rows = "".join(f"<tr><td>{escape(part)}</td><td>{size / 1000:.1f} kB</td></tr>" for part, size in sizes.items())
    return [f"<h2>Size: {sum(sizes.values()) / 1000:.1f} kB</h2>", f"<table>{rows}</table>"]


def _card(concept: Concept, demos: int, sketch: str, words: Words) -> str:
    return (
        f'<div class="card"><b>{escape(str(concept))}</b>{sketch}'
        f'<div class="words">{_spoken(words.get(concept, []))}</div>seen in {demos} demos</div>'
    )


def _spoken(entries: list[tuple[str, float, float]]) -> str:
    shown = ", ".join(f"{escape(ngram)} ({probability:.2f})" for ngram, probability, _ in entries[:WORDS])
    more = len(entries) - WORDS
    return shown + (f" and {more} more" if more > 0 else "")


def _figure(sketch: str, caption: str) -> str:
    return f"<figure>{sketch}<figcaption>{escape(caption)}</figcaption></figure>"

"""Problems of accessibility that axe finds on a page."""

from importlib.resources import files

from executor.browser import Tab

SERIOUS = ("serious", "critical")


async def problems(tab: Tab) -> list[str]:
    """Serious ones, each with the rule and the elements that break it."""
    if not await tab.value("'axe' in window"):
        script = files("axe_core_python").joinpath("axe.min.js").read_text(encoding="utf-8")
        await tab.send("Runtime.evaluate", expression=script)  # not by the page, whose policy allows no other script
    found = await tab.value(
        "axe.run(document, {resultTypes: ['violations']}).then(({violations}) => violations.map("
        "({id, impact, nodes}) => [id, impact, nodes.map(each => each.target.join(' ') + ': ' + each.failureSummary)]))"
    )
    return [f"{rule} ({impact}): {'; '.join(where)}" for rule, impact, where in found if impact in SERIOUS]

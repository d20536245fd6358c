"""`showtell describe`, `evaluate describe`, `bench parse` and the explanations of `inspect`, on a small release."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from executor.cli import app
from learning import Interpreter, Knowledge
from learning.perception import observe_world, percept_of
from learning.saying.speaker import Speaker
from learning.train_robots import write_synthetic_release
from twin import World


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(each) for each in arguments])


def complains(result: Result, *needles: str) -> None:
    assert result.exit_code == 2
    assert all(needle in result.stderr for needle in needles), result.stderr


@pytest.fixture(scope="module")
def release(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("release")
    write_synthetic_release(folder, np.random.default_rng(1), scenes=48)
    return folder


@pytest.fixture(scope="module")
def learned(release: Path) -> Path:
    path = release / "knowledge.json"
    assert run("learn", "--train-robots", release, "-o", path).exit_code == 0
    return path


def test_each_thing_of_a_scene_is_told_from_all_others(learned: Path) -> None:
    result = run("describe", learned, "--scene", "board", "--seed", "7", "--json")
    rows = json.loads(result.stdout)["sentences"]
    assert {row["script"] for row in rows} == {"LATIN"}
    said = [row for row in rows if row["text"]]
    assert len(said) > 0.8 * len(rows)  # some colours of the board were hardly ever heard of
    assert len({row["text"] for row in said}) == len(said)
    assert all(0.0 < row["share"] <= 1.0 for row in said)
    assert result.exit_code == (0 if len(said) == len(rows) else 1)


def test_one_thing_is_told_when_one_is_asked_for(learned: Path) -> None:
    rows = json.loads(run("describe", learned, "--scene", "board", "--object", "1", "--json").stdout)["sentences"]
    assert [row["object"] for row in rows] == [1]
    complains(run("describe", learned, "--scene", "board", "--object", "99"), "no object 99", "counted from 0")


def test_a_told_thing_is_taken_when_it_is_named_in_a_command(learned: Path) -> None:
    """What `describe` says, `do` understands: the noun phrase in a command about that block."""
    knowledge = Knowledge.load(learned)
    rng = np.random.default_rng(0)
    with World.from_scene("board", seed=3) as world:
        seen = observe_world(world.state(), world.spec, rng)
    speaker, percept = Speaker(knowledge), percept_of(seen, knowledge.spaces)
    told = {int(index): speaker.thing(seen, int(index)) for index in np.flatnonzero(percept.clear)}
    assert any(told.values())
    for index, said in told.items():
        if said is not None:
            found = Interpreter(knowledge).interpret(f"take {said.text}", percept)
            assert found.understood and found.goals[0].object_id == percept.object_ids[index]


def test_bad_requests_are_told(learned: Path, tmp_path: Path) -> None:
    complains(run("describe", learned), "give either a demo or --scene")
    complains(run("describe", learned, tmp_path / "none.mcap"), "no such demo")
    complains(run("describe", learned, "--scene", "board", "--language", "ar"), "ARABIC", "LATIN")
    complains(run("describe", learned, "--scene", "tabletop"), "is a table", "on the board")
    complains(run("evaluate", "describe"), "give either a folder of demos or --train-robots")
    data = json.loads(learned.read_text())
    del data["phrasings"]
    old = tmp_path / "old.json"
    old.write_text(json.dumps(data))
    complains(run("describe", old, "--scene", "board"), "learn again")


def test_sentences_are_scored_by_reading_them_back_and_by_the_truth(learned: Path, release: Path) -> None:
    words = ("--knowledge", learned, "--demos", "8", "--objects", "8", "--json")
    said = json.loads(run("evaluate", "describe", "--train-robots", release, *words).stdout)
    figures = said["figures"]
    assert figures["event.count"] == figures["object.count"] == 8
    assert figures["event.same"] > 0.8 and figures["object.alone"] > 0.7
    assert 0.0 <= figures["event.true"] <= figures["event.possible"] <= 1.0
    assert len(said["sentences"]) == 16 and "people.event.same" in said["baselines"]


def test_both_parsers_find_the_same_probabilities(learned: Path, release: Path) -> None:
    words = ("--knowledge", learned, "--train-robots", release, "--sentences", "10", "--json")
    result = run("bench", "parse", *words)
    assert result.exit_code == 0
    figures = json.loads(result.stdout)["figures"]
    assert figures["sentences"] == 10 and figures["same_probability"] == 1.0
    assert figures["ratio_vs_nltk"] > 1.0
    complains(run("bench", "parse", "--knowledge", learned), "--train-robots")


def test_inspect_tells_what_each_word_means_and_what_else_was_possible(learned: Path) -> None:
    result = run("inspect", learned, "take the red cube", "--scene", "board", "--seed", "7", "--json")
    said = json.loads(result.stdout)
    assert [row["word"] for row in said["words"]] == ["take", "the", "red", "cube"]
    meant = {row["word"]: row["meant"] for row in said["words"]}
    assert meant["take"].startswith("action_") and meant["red"].startswith("colour_")
    assert any(row["what"] == "what moves" and "object" in row["found"] for row in said["referents"])
    assert "entity" in said["plain"] and said["confidence"] > 0.5
    for other in said["alternatives"]:
        assert other["why"] and 0.0 <= other["share"] <= 1.0
    unknown = json.loads(run("inspect", learned, "take the zorgle", "--scene", "board", "--json").stdout)
    assert unknown["unknown"] == ["zorgle"]
    assert unknown["words"][2]["usual"] == "never heard"

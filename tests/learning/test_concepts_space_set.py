import json

import numpy as np
import pytest

from learning.concepts import (
    BOARD,
    COUNTER,
    TABLE,
    ConceptSpaces,
    FeatureSpace,
    ModeMixture,
    TrackMixture,
    find_space_set,
    fit_demo,
    register_space_set,
)
from learning.concepts.table_spaces import Size, TableColour, TableShape
from learning.errors import KnowledgeError
from learning.perception import Observation
from tests.learning.board_demos import random_demo
from tests.learning.camera_tracks import FRAMES, still_objects

RED, GREEN, BLUE = (0.0, 0.8, 0.4), (0.33, 0.7, 0.35), (0.66, 0.8, 0.4)


class Texture(FeatureSpace):
    name = "texture"
    dimension = 2
    of_object = True
    grain, floor, resolution, correlation = 0.01, 0.02, 0.05, 0.3
    kinds = "learned"


TEXTURED = register_space_set(TABLE.extended("textured", Texture))


def textured(rng: np.random.Generator, kinds: list[int]) -> Observation:
    """Objects of plain (0) and striped (1) texture; the texture of the last one is not known in half of the frames."""
    means = np.array([[0.2, 0.1], [0.6, 0.8]])[kinds]
    values = means + rng.normal(0.0, 0.01, (FRAMES, len(kinds), 2))
    values[::2, -1] = np.nan
    places = [(0.5, 0.3 - 0.2 * i) for i in range(len(kinds))]
    return still_objects(rng, [RED] * len(kinds), places, {"texture": values})


def test_a_space_from_outside_is_learned_and_saved() -> None:
    rng = np.random.default_rng(0)
    spaces = ConceptSpaces(TEXTURED)
    for _ in range(10):
        spaces.update(fit_demo(textured(rng, [0, 1, 1]), rng, TEXTURED))
    mixture = spaces.mixtures["texture"]
    assert len(mixture.components) == 2
    plain, striped = mixture.classify(np.array([[0.2, 0.1], [0.6, 0.8]]))
    assert plain != striped
    again = ConceptSpaces.from_json(json.loads(json.dumps(spaces.to_json())))
    assert again.space_set is TEXTURED
    assert again.to_json() == spaces.to_json()


def test_a_feature_that_nobody_measured_teaches_nothing() -> None:
    rng = np.random.default_rng(0)
    found = fit_demo(still_objects(rng, [RED], [(0.5, 0.0)]), rng, TEXTURED)
    assert found.components["texture"] == ()
    assert len(found.components["colour"]) == 1


def test_weight_is_learned_from_the_frames_in_which_it_was_felt() -> None:
    rng = np.random.default_rng(0)
    spaces = ConceptSpaces(COUNTER)
    for weight in (0.05, 0.4, 0.06, 0.41):
        felt = np.full((FRAMES, 1, 1), np.nan)
        felt[3:6] = weight + rng.normal(0.0, 0.003, (3, 1, 1))
        spaces.update(fit_demo(still_objects(rng, [RED], [(0.5, 0.0)], {"weight": felt}), rng, COUNTER))
    means = [float(component.mean[0]) for component in spaces.mixtures["weight"].components.values()]
    assert np.allclose(sorted(means), [0.055, 0.405], atol=0.005)  # the noise above


def test_size_is_the_mean_side_in_any_order() -> None:
    sides = np.array([0.1, 0.05, 0.2])
    assert np.allclose(Size.embed(sides), np.log(0.1))
    assert np.allclose(Size.embed(sides[::-1]), Size.embed(sides))


def test_proportions_do_not_tell_small_from_large() -> None:
    bins = np.full(33, 1.0 / 33)
    small, large, tall = (
        np.concatenate([bins, side]) for side in ([0.05, 0.05, 0.1], [0.08, 0.08, 0.16], [0.05, 0.05, 0.2])
    )
    near, far = (np.linalg.norm(TableShape.embed(other) - TableShape.embed(small)) for other in (large, tall))
    assert near < 0.1 * far


def test_a_shaded_red_stays_nearer_to_red_than_orange_is() -> None:
    red, shaded, orange = (TableColour.embed(np.array(hsl)) for hsl in (RED, (0.0, 0.8, 0.25), (0.08, 0.85, 0.4)))
    assert np.linalg.norm(shaded - red) < np.linalg.norm(orange - red)


def test_the_set_is_kept_and_files_without_one_are_of_the_board() -> None:
    rng = np.random.default_rng(1)
    spaces = ConceptSpaces()
    spaces.update(fit_demo(random_demo(rng).observation, rng))
    data = spaces.to_json()
    assert data["set"] == "board"
    del data["set"]
    assert ConceptSpaces.from_json(data).space_set is BOARD


def test_names_are_looked_up() -> None:
    assert find_space_set("table") is TABLE
    assert ConceptSpaces("counter").space_set is COUNTER
    assert isinstance(ConceptSpaces(TABLE).mixtures["shape"], TrackMixture)
    assert isinstance(ConceptSpaces(TABLE).mixtures["location"], ModeMixture)
    with pytest.raises(KnowledgeError, match="space set 'kitchen' is not known; known are board, table, counter"):
        ConceptSpaces("kitchen")
    with pytest.raises(KnowledgeError, match="has no space 'smell'; it has colour, shape"):
        TABLE.space("smell")
    with pytest.raises(KnowledgeError, match="^concepts: space set 'kitchen' is not known|space set 'kitchen'"):
        ConceptSpaces.from_json({"set": "kitchen", "spaces": {}, "actions": []})


def test_a_name_is_given_once() -> None:
    with pytest.raises(KnowledgeError, match="'table' with other spaces is known already"):
        register_space_set(TEXTURED.extended("table"))

    class Action(Texture):
        name = "action"

    with pytest.raises(KnowledgeError, match="cannot have a space 'action'"):
        TABLE.extended("bad", Action)

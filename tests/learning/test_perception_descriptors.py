from itertools import combinations

import numpy as np
import pytest

from learning.perception.descriptors import block_mesh, board_descriptors, compute_descriptor
from twin.board import ALL_SHAPES, BLOCK

SHAPES = ALL_SHAPES


@pytest.mark.parametrize("shape", SHAPES)
def test_the_data_file_is_what_open3d_computes(shape: str) -> None:
    computed = compute_descriptor(*block_mesh(shape))
    assert computed == pytest.approx(board_descriptors()[shape], abs=2e-6)  # kept with six decimals


@pytest.mark.parametrize("shape", SHAPES)
def test_descriptors_are_histograms(shape: str) -> None:
    bins = board_descriptors()[shape]
    assert bins.shape == (33,)
    assert bins.min() >= 0.0
    assert bins.reshape(3, 11).sum(axis=1) == pytest.approx(np.full(3, 1 / 3), abs=1e-5)  # three angles, equal shares
    assert not bins.flags.writeable


@pytest.mark.parametrize(("one", "other"), list(combinations(SHAPES, 2)))
def test_shapes_differ_by_more_than_their_noise(one: str, other: str) -> None:
    first, second = board_descriptors()[one], board_descriptors()[other]
    noise = 0.05 * np.maximum(first, second)
    seen = noise > 0
    # In units of the noise of one frame; eight frames are averaged.
    assert np.sqrt(np.sum(((first - second)[seen] / noise[seen]) ** 2)) > 10


@pytest.mark.parametrize(("shape", "volume"), [("cube", BLOCK**3), ("prism", BLOCK**3 / 2)])
def test_meshes_are_closed_and_face_outwards(shape: str, volume: float) -> None:
    vertices, triangles = block_mesh(shape)
    corners = vertices[triangles]
    # The divergence theorem: signed volumes of the tetrahedra to the origin add up only when all faces point outwards.
    assert np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6 == pytest.approx(volume)
    edges = [tuple(edge) for triangle in triangles for edge in zip(triangle, np.roll(triangle, -1), strict=True)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    assert np.allclose(np.abs(vertices).max(axis=0), BLOCK / 2)

"""Components of a mixture as plain numbers, and back, checked."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian
from learning.concepts.track_noise import TrackNoise
from learning.saved_numbers import saved_count


def kept_entries(space: type[FeatureSpace]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of a covariance that are stored: its diagonal, or its upper triangle."""
    if space.diagonal:
        diagonal = np.arange(space.dimension)
        return diagonal, diagonal
    return np.triu_indices(space.dimension)


def components_to_json(components: Mapping[int, Gaussian], space: type[FeatureSpace]) -> dict[str, Any]:
    """Components by number as plain numbers."""
    rows, columns = kept_entries(space)
    return {
        str(number): {
            "mean": component.mean.tolist(),
            "covariance": component.covariance[rows, columns].tolist(),
            "count": component.count,
            "demos": component.demos,
        }
        for number, component in components.items()
    }


def components_from_json(data: Mapping[str, Any], space: type[FeatureSpace]) -> dict[int, Gaussian]:
    """Rebuild components.

    Raises:
        ValueError, KeyError, TypeError: `data` is not what `components_to_json` wrote.
    """
    rows, columns = kept_entries(space)
    components = {}
    for number, entry in data.items():
        mean = np.array(entry["mean"], dtype=np.float64)
        entries = np.array(entry["covariance"], dtype=np.float64)
        if entries.shape != rows.shape:
            raise ValueError(f"concept {space.name}_{number}: covariance must be {len(rows)} numbers")
        covariance = np.zeros((space.dimension, space.dimension))
        covariance[rows, columns] = entries
        covariance[columns, rows] = entries
        if mean.shape != (space.dimension,) or not np.all(np.isfinite(mean)):
            raise ValueError(f"concept {space.name}_{number}: mean must be {space.dimension} finite numbers")
        if not np.all(np.isfinite(covariance)) or np.any(np.linalg.eigvalsh(covariance) <= 0.0):
            raise ValueError(
                f"concept {space.name}_{number}: variances must be finite and positive, in every direction"
            )
        count = saved_count(entry["count"], f"concept {space.name}_{number}: count")
        demos = saved_count(entry["demos"], f"concept {space.name}_{number}: demos", least=1)
        if count == 0.0:
            raise ValueError(f"concept {space.name}_{number}: count is 0, expected more")
        components[int(number)] = Gaussian(mean, covariance, count, int(demos))
    return components


def noise_to_json(noise: TrackNoise) -> dict[str, Any]:
    """A scatter as plain numbers: its upper triangle."""
    rows, columns = np.triu_indices(len(noise.scatter))
    return {"freedom": noise.freedom, "scatter": noise.scatter[rows, columns].tolist()}


def noise_from_json(data: Mapping[str, Any], space: type[FeatureSpace], what: str) -> TrackNoise:
    """Rebuild a scatter.

    Raises:
        ValueError, KeyError, TypeError: `data` is not what `noise_to_json` wrote; the message says `what` it is.
    """
    freedom = saved_count(data["freedom"], f"degrees of freedom of the {what} of {space.name}")
    rows, columns = np.triu_indices(space.dimension)
    values = np.array(data["scatter"], dtype=np.float64)
    if values.shape != rows.shape or not np.all(np.isfinite(values)):
        raise ValueError(f"{what} of {space.name}: scatter must be {len(rows)} finite numbers")
    scatter = np.zeros((space.dimension, space.dimension))
    scatter[rows, columns] = values
    scatter[columns, rows] = values
    if np.any(np.diagonal(scatter) < 0.0):
        raise ValueError(f"{what} of {space.name}: variances must be 0 or more")
    return TrackNoise(scatter, freedom)

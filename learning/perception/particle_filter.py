"""A particle filter over place and colour: x, y, z, r, g, b of one object (Klank, Zia & Beetz 2009)."""

import numpy as np
from numpy.typing import NDArray

from robots.kinematics import rotation_matrix
from robots.pose import FloatArray

PARTICLES = 200
"""Number of particles of each object."""
REST_SIGMA = 0.0008
"""How far a thing at rest may creep from frame to frame [m]."""
HELD_SIGMA = 0.002
"""How far a held thing may slip in the hand [m]."""
COLOUR_SIGMA = 1.5
"""How much a thing's colour may change from frame to frame, of 255."""
PROPOSED = 0.2
"""Part of the particles that are drawn where the thing was measured: sudden motions are not lost (sensor resetting,
Lenser & Veloso 2000)."""
RESET_AFTER = 1e-12
"""Part of its weight that a filter may keep before it starts anew from the measurement."""


class ParticleFilter:
    """Belief about one object's centre and colour, and about whether the hand carries it.

    Each particle has six dimensions and a hypothesis: it rests, or it moves with the tool.

    Attributes:
        particles: (n, 6): centre in the world [m] and red, green, blue of 255.
        weights: (n,), which sum to 1.
        held: Whether each particle moves with the tool, (n,).
    """

    def __init__(self, state: FloatArray, spread: FloatArray, rng: np.random.Generator, count: int = PARTICLES) -> None:
        """Start from a first measurement.

        Args:
            state: Where and what colour, (6,).
            spread: Standard deviations, (6,).
            rng: Source of all its randomness.
            count: Number of particles.
        """
        self._rng = rng
        self.particles: FloatArray = state + spread * rng.standard_normal((count, 6))
        self.weights: FloatArray = np.full(count, 1.0 / count)
        self.held: NDArray[np.bool_] = np.zeros(count, dtype=bool)
        self._estimate: FloatArray | None = None

    def predict(self, before: FloatArray, now: FloatArray, loosening: float = 0.0) -> None:
        """Move every particle as its hypothesis says.

        Args:
            before: Tool frame at the last frame, position and quaternion xyzw, (7,).
            now: Tool frame at this frame, (7,).
            loosening: More diffusion [m] for a thing that was not found where it was expected.
        """
        self._estimate = None
        held = self.held
        if held.any():
            turn = rotation_matrix(now[3:]) @ rotation_matrix(before[3:]).T
            self.particles[held, :3] = (self.particles[held, :3] - before[:3]) @ turn.T + now[:3]
        noise = self._rng.standard_normal(self.particles.shape)
        noise[:, :3] *= np.where(held, HELD_SIGMA, REST_SIGMA)[:, None] + loosening
        noise[:, 3:] *= COLOUR_SIGMA
        self.particles += noise

    def suppose_held(self, share: float) -> None:
        """Make a part of the particles move with the tool from now on; the others rest.

        Args:
            share: Which part, 0 .. 1.
        """
        self._estimate = None
        self.held = self._rng.random(len(self.held)) < share

    def let_go(self) -> None:
        """Nothing moves with the tool any more."""
        if self.held.any():
            self._estimate = None
            self.held[:] = False

    def carry_to(self, centre: FloatArray) -> None:
        """Move all particles so that the centre is elsewhere (3,) [m], in the hand."""
        self.shift(centre - self.estimate()[:3])
        self.held[:] = True

    def shift(self, by: FloatArray) -> None:
        """Move all particles by (3,) [m]."""
        self.particles[:, :3] += by
        self._estimate = None

    def update(self, measured: FloatArray, sigma: FloatArray) -> None:
        """Weigh particles by a measurement, and resample where few are left that matter.

        Args:
            measured: Centre [m] and colour, (6,).
            sigma: Standard deviations of the measurement, (6,).
        """
        surprise = self._surprise(measured, sigma)
        self._estimate = None
        count = len(self.weights)
        believed = np.bincount(self.held, weights=self.weights, minlength=2)
        off = (self.particles - measured) / sigma
        likelihood = np.exp(-0.5 * np.minimum((off * off).sum(axis=1), 1400.0))
        weights = self.weights * likelihood
        total = float(weights.sum())
        if total > RESET_AFTER * likelihood.size**-1:
            self.weights = weights / total
            if 1.0 / float((self.weights**2).sum()) < count / 2:
                self._take(_resampled(self.weights, self._rng))
        else:  # it went where no particle was: the measurement is all there is
            self._take(self._rng.integers(count, size=count))
            self.held = self._rng.random(count) < believed[1]
            self.particles = measured + sigma * self._rng.standard_normal(self.particles.shape)
            return
        fresh = self._rng.random(count) < PROPOSED * surprise
        self.particles[fresh] = measured + sigma * self._rng.standard_normal((int(fresh.sum()), 6))

    def _surprise(self, measured: FloatArray, sigma: FloatArray) -> float:
        """How far the belief is from a measurement: 0 where they agree, 1 from three standard deviations on."""
        off = float((np.abs(self.estimate() - measured) / sigma)[:3].max())
        return min(max(off - 1.0, 0.0) / 2.0, 1.0)

    def _take(self, chosen: NDArray[np.int64]) -> None:
        self.particles, self.held = self.particles[chosen], self.held[chosen]
        self.weights = np.full(len(chosen), 1.0 / len(chosen))

    @property
    def held_share(self) -> float:
        """Belief that the hand carries it, 0 .. 1."""
        return float(self.weights[self.held].sum())

    def estimate(self) -> FloatArray:
        """Mean centre and colour, (6,), of the hypothesis that is believed more."""
        if self._estimate is None:
            mine = self.held == (self.held_share > 0.5)
            weights = self.weights[mine]
            self._estimate = np.asarray(weights @ self.particles[mine] / weights.sum())
        return self._estimate


def _resampled(weights: FloatArray, rng: np.random.Generator) -> NDArray[np.int64]:
    """Indices of particles, drawn by filterpy's systematic resampling from a generator of our own.

    filterpy draws one number from NumPy's global generator, which is seeded from ours for the call and put back.
    """
    from filterpy.monte_carlo import systematic_resample

    weights = weights.copy()
    weights[-1] += 1e-9  # rounding must not leave the last position beyond the last particle
    before = np.random.get_state()  # noqa: NPY002
    try:
        np.random.seed(int(rng.integers(2**32)))  # noqa: NPY002
        return np.asarray(systematic_resample(weights), dtype=np.int64)
    finally:
        np.random.set_state(before)  # noqa: NPY002

"""Random fields of a stated variogram: the errors of a raster's heights."""
from dataclasses import dataclass

import numpy as np

from dspace._core.fields import number, reject
from dspace.errors import Resource

NEGLIGIBLE = 1e-4  # correlation that counts as none
MOST_POSTS = 1 << 26  # of the torus on which a field is made: 1 GiB
WAVES = 512  # whose sum is a field on a body
AT_ONCE = 1 << 14  # places


def _exponential(lag):
    return np.exp(-lag)


def _gaussian(lag):
    return np.exp(-lag * lag)


# By name: the correlation over lags in lengths; the lag at which it is negligible; wave vectors [1 / length] of the 3-D field
# with that correlation, whose characteristic function it is: Cauchy's and the normal distribution (Rahimi and Recht 2007).
MODELS = {"exponential": (_exponential, -np.log(NEGLIGIBLE),
                          lambda random, count: random.standard_normal((count, 3)) / np.abs(random.standard_normal((count, 1)))),
          "gaussian": (_gaussian, np.sqrt(-np.log(NEGLIGIBLE)),
                       lambda random, count: np.sqrt(2.0) * random.standard_normal((count, 3)))}


@dataclass(frozen=True)
class Variogram:
    """How errors of heights are correlated: half the mean squared difference of the errors at two places a distance h apart is
    nugget² + sigma² (1 - r(h)), with r = exp(-h / length) ("exponential") or exp(-(h / length)²) ("gaussian").

    sigma: standard deviation of the correlated part [m], 0 or more. length: [m], above 0. nugget: standard deviation of the part
    that is independent from pixel to pixel [m], 0 or more. Errors are normally distributed about 0.

    Raises dspace.InvalidArgument."""
    sigma: float
    length: float
    model: str = "exponential"
    nugget: float = 0.0

    def __post_init__(self):
        about = "variogram"
        for name in ("sigma", "length", "nugget"):
            value = number(getattr(self, name), f"the {name}", about)
            if not (0.0 <= value < np.inf) or name == "length" and value == 0.0:
                reject(about, f"the {name}", value, "a finite number of metres, " + ("above 0" if name == "length" else "0 or more"))
            object.__setattr__(self, name, value)  # so that 5 and 5.0 are the same
        if self.model not in MODELS:
            reject(about, "the model", self.model, ", ".join(MODELS))

    def __call__(self, distance):
        """The variogram at distances [m], in m²."""
        lag = np.asarray(distance, float) / self.length
        return np.where(lag > 0.0, self.nugget ** 2 + self.sigma ** 2 * (1.0 - MODELS[self.model][0](lag)), 0.0)

    def field(self, shape, spacing, random):
        """Returns errors [m] of a grid of `shape` (rows, columns) whose rows and columns are `spacing` (two numbers [m]) apart.
        random: numpy's Generator.

        The method is circulant embedding (Dietrich and Newsam 1997): the grid is a part of a torus, which is so much larger that
        correlations around it are below 1e-4; its covariance has the Fourier transform as eigenvectors. The covariance of the
        result is the stated one within 2e-4 sigma². Raises dspace.Resource if the torus would have more than 2^26 posts."""
        correlation, reach, _ = MODELS[self.model]
        torus = [_smooth(int(np.ceil(count + reach * self.length / step))) for count, step in zip(shape, spacing)]
        if torus[0] * torus[1] > MOST_POSTS:
            raise Resource(f"variogram: a length of {self.length:g} m over {shape[1]} x {shape[0]} posts needs {torus[1]} x {torus[0]} "
                           f"posts; accepted: at most {MOST_POSTS}, by a shorter length or a coarser raster", "variogram")
        rows, columns = (np.fft.fftfreq(count, 1.0 / count) for count in torus)
        covariance = np.zeros(torus)
        for i in (-1, 0, 1):  # the images of a post on the torus: so the eigenvalues are a spectrum's, none is negative
            for j in (-1, 0, 1):
                covariance += correlation(np.hypot((rows + i * torus[0])[:, None] * spacing[0],
                                                   (columns + j * torus[1])[None, :] * spacing[1]) / self.length)
        power = np.maximum(np.fft.fft2(covariance).real, 0.0)
        noise = random.standard_normal(torus) + 1j * random.standard_normal(torus)
        made = np.fft.fft2(np.sqrt(power / power.size) * noise).real[:shape[0], :shape[1]]
        return self.sigma * made + self._independent(shape, random)

    def field_at(self, points, random):
        """Returns errors [m] at points (..., 3) [m] of any places, such as on a body; correlations are over straight distances.

        The errors are a sum of 512 waves whose vectors are drawn from the spectrum: over many fields the covariance is the stated
        one exactly, within a field it varies about it."""
        points = np.asarray(points, float)
        flat = points.reshape(-1, 3)
        vectors = MODELS[self.model][2](random, WAVES) / self.length
        phases = random.uniform(0.0, 2.0 * np.pi, WAVES)
        made = np.empty(len(flat))
        for k in range(0, len(flat), AT_ONCE):
            made[k:k + AT_ONCE] = np.cos(flat[k:k + AT_ONCE] @ vectors.T + phases).sum(axis=1)
        shape = points.shape[:-1]
        return self.sigma * np.sqrt(2.0 / WAVES) * made.reshape(shape) + self._independent(shape, random)

    def _independent(self, shape, random):
        return self.nugget * random.standard_normal(shape) if self.nugget else 0.0


def _smooth(least):
    """The least number from `least` on without prime factors above 5, of which Fourier transforms are fast."""
    while True:
        rest = least
        for factor in (2, 3, 5):
            while rest % factor == 0:
                rest //= factor
        if rest == 1:
            return least
        least += 1

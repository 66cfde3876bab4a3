"""What the pictures of a movie are, for dspace.batches."""
import os

from dspace._core.png import is_whole
from dspace.batches import folder as batch_folder
from dspace.batches.kinds import Batch, Kind

FRAME = "frame_%06d.png"
KIND = Kind("movie", "movie.toml", "dspace.movies.make", "frame_%06d", r"\.png",
            lambda folder, number: is_whole(os.path.join(folder, FRAME % number)), ".png")


def batch_of(movie):
    """The Batch of a Movie."""
    return Batch(KIND, movie.text, {"size": movie.size, "samples": movie.samples, "rate": movie.rate, "frames": movie.frames})


def identity(movie, run):
    """Returns a hash that identifies a movie of a run."""
    return batch_folder.identity(batch_of(movie), run)

"""The scene of a recording at a time, in which commands measure and draw."""
import contextlib

from dspace.command_line import Failed, tidy_end


def add_recording(parser, source=None):
    """Adds the options of a recording. source: what --recording is added to; None: it is required."""
    (source or parser).add_argument("--recording", required=source is None, metavar="FILE", help="a recording (.dspace)")
    parser.add_argument("--at", type=float, metavar="T", help="simulation time of the recording [s] (default: the end)")
    parser.add_argument("--scene", metavar="NAME", help="the scene (default: the recording's only one)")


@contextlib.contextmanager
def recorded_scene(options):
    """The Scene of the command's recording, at its time."""
    with recorded_playback(options) as (_, scene):
        yield scene


@contextlib.contextmanager
def recorded_playback(options):
    """The Playback of the command's recording at its time, and its Scene."""
    from dspace.playback.playback import Playback
    with tidy_end(), Playback(options.recording) as playback:
        first, last = playback.times[0], playback.times[-1]
        if options.at is not None and not first <= options.at <= last:
            raise Failed(f"--at {options.at:g}: {options.recording} runs from {first:g} to {last:g} s; accepted: a time within it")
        playback.seek(last if options.at is None else options.at)
        scenes = playback.session.scenes
        if options.scene is None and len(scenes) != 1 or options.scene is not None and options.scene not in scenes:
            raise Failed(f"{options.recording}: the scene is {options.scene!r}; accepted: --scene with one of "
                         f"{', '.join(map(repr, scenes)) or 'none'}")
        yield playback, next(iter(scenes.values())) if options.scene is None else scenes[options.scene]

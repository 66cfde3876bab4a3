"""The time left while a movie is made, in words."""


def left_words(done, total, seconds, drawn):
    """Returns the time left, estimated from the rate so far, as text."""
    if done >= total:
        return "all drawn"
    if not drawn:
        return "time left unknown"
    rest = round((total - done) * seconds / drawn)
    hours, rest = divmod(rest, 3600)
    return (f"{hours}:{rest // 60:02d}" if hours else f"{rest // 60}") + f":{rest % 60:02d} left"

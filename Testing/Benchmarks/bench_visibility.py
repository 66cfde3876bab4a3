"""Power over a year of hours at a lunar site, against the directions of the Sun alone; contacts, against the directions of their
samples alone. In turn."""
import statistics
import time

import dspace
import numpy as np

ROUNDS = 5
YEAR = 365.25 * 86400.0


def spent(work):
    start = time.perf_counter()
    found = work()
    return time.perf_counter() - start, found


def main():
    place = dspace.BodySite("moon", 222.7, -89.45, 1957.0)
    horizon = 1.5 * np.sin(np.radians(np.arange(0.0, 360.0, 0.5)))
    hours = np.arange(0.0, YEAR, 3600.0)
    minutes = np.arange(0.0, 30 * 86400.0, 60.0)
    with dspace.Session() as session:
        scene = session.scene()
        cases = {
            f"power of a year, {len(hours):,} hours (goal: under 1 s)": (
                lambda: scene.power_profile(place, dspace.Panel(tracking="full"), 0.0, YEAR, mask=horizon,
                                            battery=dspace.Battery(1000.0, load=10.0)),
                lambda: scene.sky_track(place, "sun", hours)),
            f"contacts of 30 days, {len(minutes):,} minutes": (
                lambda: scene.contacts(place, "sun", 0.0, minutes[-1], mask=horizon, upper=True),
                lambda: scene.sky_track(place, "sun", minutes))}
        for name, pair in cases.items():
            times = ([], [])
            for _ in range(ROUNDS):
                for kept, work in zip(times, pair):
                    kept.append(spent(work)[0])
            whole, bare = map(statistics.median, times)
            print(f"visibility: {name}: {whole:.2f} s; directions alone {bare:.2f} s, {whole / bare:.2f} x")


if __name__ == "__main__":
    main()

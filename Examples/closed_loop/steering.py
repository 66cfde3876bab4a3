"""The way over a map of hazards, and the next move along it."""
import heapq

import numpy as np

NEIGHBOURS = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dx or dy]
BLOCKED = 1e4  # the cost of a metre where the rover might touch a hazard: leaving such a place is still allowed


def costs(hazards, radius, margin=0.25):
    """The cost of a metre in each cell: higher near hazards and where nothing was seen."""
    free = hazards.clearance() - radius - margin
    cost = np.where(free > 0, 1.0 + 2.0 * np.clip(1.0 - free, 0, 1), BLOCKED)
    return cost + np.where(hazards.seen, 0.0, 0.3)


def way(hazards, cost, start, goal):
    """Points (n, 2) of the cheapest way from start to goal over the cells' middles (A*)."""
    begin, end = (tuple(np.clip(hazards.cells(each), 0, np.array(hazards.shape) - 1)) for each in (start, goal))
    best, before, done = {begin: 0.0}, {}, set()
    queue = [(0.0, begin)]
    while queue:
        _, here = heapq.heappop(queue)
        if here == end:
            break
        if here in done:
            continue
        done.add(here)
        for dx, dy in NEIGHBOURS:
            there = here[0] + dx, here[1] + dy
            if not (0 <= there[0] < hazards.shape[0] and 0 <= there[1] < hazards.shape[1]):
                continue
            length = np.hypot(dx, dy)
            total = best[here] + length * 0.5 * (cost[here] + cost[there])
            if total < best.get(there, np.inf):
                best[there], before[there] = total, here
                rest = np.hypot(there[0] - end[0], there[1] - end[1])
                heapq.heappush(queue, (total + rest, there))
    cells = [end]
    while cells[-1] in before:
        cells.append(before[cells[-1]])
    points = hazards.low + hazards.cell * (np.array(cells[::-1]) + 0.5)
    points[-1] = goal
    return points


def next_move(points, place, heading, ahead=1.2, turn=np.radians(25), most=np.radians(30)):
    """("turn", angle [rad]) on the spot, or ("drive", curvature [1/m]) towards the point of a way that is `ahead` metres on."""
    distances = np.concatenate(([0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))))
    aim = points[min(np.searchsorted(distances, ahead), len(points) - 1)] - place
    off = (np.arctan2(aim[1], aim[0]) - heading + np.pi) % (2 * np.pi) - np.pi
    if abs(off) > turn:
        return "turn", float(np.clip(off, -most, most))
    return "drive", float(2 * np.sin(off) / max(np.linalg.norm(aim), 0.5))

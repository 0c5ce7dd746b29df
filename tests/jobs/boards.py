"""Copper of printed circuit boards: pads, and traces between them on a grid, as capsules (contours.py)."""

import random

from contours import field_around, from_lowest, lines_at, merged, nearest_first, simplified

STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1))


def _footprints(columns, rows, draw):
    """Returns the pads of parts at free places of the grid, each as the node of its middle: two-pin parts, rows of pins,
    and packages with pins at two sides."""
    taken, pads = set(), []
    for _ in range(columns * rows // 3):
        pins = int(draw.random() * 5) + 2
        across = int(draw.random() * 3)
        if across == 0:
            nodes = [(0, 0), (2, 0)] if draw.random() < 0.5 else [(0, 0), (0, 2)]
        elif across == 1:
            nodes = [(0, 2 * pin) for pin in range(pins)]
        else:
            nodes = [(side, pin) for side in (0, 4) for pin in range(pins)]
        x, y = int(draw.random() * columns), int(draw.random() * rows)
        nodes = [(x + dx, y + dy) for dx, dy in nodes]
        around = {(i + di, j + dj) for i, j in nodes for di in (-1, 0, 1) for dj in (-1, 0, 1)}
        if all(0 < i < columns - 1 and 0 < j < rows - 1 for i, j in nodes) and not around & taken:
            taken.update(nodes)
            pads.append(nodes)
    return pads


def _route(start, ends, blocked, columns, rows):
    """Returns the shortest way on the grid from a node to one of others, or None."""
    before, border = {start: None}, [start]
    while border:
        next_border = []
        for node in border:
            if node in ends:
                way = [node]
                while before[way[-1]] is not None:
                    way.append(before[way[-1]])
                return way
            for dx, dy in STEPS:
                there = (node[0] + dx, node[1] + dy)
                beside = {(node[0] + dx, node[1]), (node[0], node[1] + dy)} if dx and dy else set()
                if (0 <= there[0] < columns and 0 <= there[1] < rows and there not in before
                        and (there not in blocked or there in ends) and not (beside & blocked)):
                    before[there] = node
                    next_border.append(there)
        border = next_border
    return None


def _corners(way):
    """Returns the nodes of a way at which it turns, with both ends."""
    return [node for k, node in enumerate(way)
            if k in (0, len(way) - 1)
            or (way[k + 1][0] - node[0], way[k + 1][1] - node[1]) != (node[0] - way[k - 1][0], node[1] - way[k - 1][1])]


def rounded(points, times):
    """Returns a line with its corners cut `times` times, each time more finely: a curve."""
    for _ in range(times):
        cut = [points[0]]
        for (x1, y1), (x2, y2) in zip(points, points[1:]):
            cut += [(0.75 * x1 + 0.25 * x2, 0.75 * y1 + 0.25 * y2), (0.25 * x1 + 0.75 * x2, 0.25 * y1 + 0.75 * y2)]
        points = cut + [points[-1]]
    return points


def routed(columns, rows, pitch, nets, seed, width=0.4, curved=False):
    """Returns the copper of a board: parts at places drawn by `seed`, and up to `nets` traces between their pads."""
    draw = random.Random(seed)
    parts = _footprints(columns, rows, draw)
    pads = [node for part in parts for node in part]
    order = sorted(pads, key=lambda _: draw.random())
    blocked, copper = set(pads), []
    for x, y in pads:
        copper.append((x * pitch - 0.25, y * pitch, x * pitch + 0.25, y * pitch, 0.45))
    for start, end in list(zip(order, order[1:]))[:nets]:
        way = _route(start, {end}, blocked - {start}, columns, rows)
        if way is None:
            continue
        blocked.update(way)
        points = [(x * pitch, y * pitch) for x, y in (way if curved else _corners(way))]
        points = rounded(points, 2) if curved else points
        copper += [(*a, *b, width / 2) for a, b in zip(points, points[1:])]
    return copper


def bus(length, lines, pitch, width=0.6):
    """Returns long straight traces side by side, each with one bend at 45 degrees and a pad at both ends."""
    copper = []
    for line in range(lines):
        y, bend = line * pitch, 0.3 * length + line * pitch
        points = [(0.0, y), (bend, y), (bend + pitch, y + pitch), (length, y + pitch)]
        copper += [(*a, *b, width / 2) for a, b in zip(points, points[1:])]
        copper += [(*points[0], *points[0], 0.9), (*points[-1], *points[-1], 0.9)]
    return copper


def isolation(copper, depth, tool=0.4, offsets=1, overlap=0.5, tolerance=0.028, merge=0.0, cell=0.2):
    """Returns the paths of a tool around copper, one line for each offset. `overlap` is the distance between offsets and
    `merge` the distance over which the tool stays down between paths, both in diameters of the tool."""
    levels = [tool * (0.5 + overlap * k) for k in range(offsets)]
    field = field_around(copper, levels[-1], cell)
    loops = [from_lowest(simplified(line, tolerance)) for level in levels for line in lines_at(field, level)]
    paths = merged(nearest_first(loops), merge * tool)
    return [[(x, y, -depth) for x, y in path] for path in paths]


def centre_lines(copper, depth):
    """Returns the straight parts of traces as paths of their own: what is drawn, and not what lies around it."""
    paths = [[(x1, y1, -depth), (x2, y2, -depth)] for x1, y1, x2, y2, _ in copper if (x1, y1) != (x2, y2)]
    return merged(paths, 1e-6)

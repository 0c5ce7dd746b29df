"""Lines of equal distance around shapes: what isolation milling and clearing follow.

All lengths are mm. A capsule is (x1, y1, x2, y2, radius): a straight trace with round ends, or a pad. A path is a list of
points (x, y).
"""

import math

FAR = 1e9


def distance_to_segment(x, y, x1, y1, x2, y2):
    """Returns the distance of a point from a straight line between two points."""
    dx, dy = x2 - x1, y2 - y1
    square = dx * dx + dy * dy
    if square:
        along = min(1.0, max(0.0, ((x - x1) * dx + (y - y1) * dy) / square))
        x1, y1 = x1 + along * dx, y1 + along * dy
    return math.hypot(x - x1, y - y1)


class Field:
    """Distances from the nearest capsule at the nodes of a grid, row by row; FAR beyond `reach`."""

    def __init__(self, box, cell):
        self.left, self.bottom, right, top = box
        self.cell = cell
        self.columns = max(2, int(math.ceil((right - self.left) / cell)) + 1)
        self.lines = max(2, int(math.ceil((top - self.bottom) / cell)) + 1)
        self.rows = [[FAR] * self.columns for _ in range(self.lines)]

    def span(self, low, high, start, count):
        """Returns the range of grid lines between two coordinates."""
        first = max(0, int(math.ceil((low - start) / self.cell)))
        last = min(count - 1, int(math.floor((high - start) / self.cell)))
        return range(first, last + 1)

    def add(self, capsule, reach):
        """Lowers the distances near a capsule."""
        x1, y1, x2, y2, radius = capsule
        around = radius + reach
        across = self.span(min(x1, x2) - around, max(x1, x2) + around, self.left, self.columns)
        for j in self.span(min(y1, y2) - around, max(y1, y2) + around, self.bottom, self.lines):
            row, y = self.rows[j], self.bottom + j * self.cell
            for i in across:
                distance = distance_to_segment(self.left + i * self.cell, y, x1, y1, x2, y2) - radius
                if distance < row[i]:
                    row[i] = distance


def field_around(capsules, reach, cell, box=None):
    """Returns the distances from capsules. `box` is (left, bottom, right, top); None: large enough for `reach`."""
    if box is None:
        edge = reach + 2 * cell
        box = (min(min(c[0], c[2]) - c[4] for c in capsules) - edge,
               min(min(c[1], c[3]) - c[4] for c in capsules) - edge,
               max(max(c[0], c[2]) + c[4] for c in capsules) + edge,
               max(max(c[1], c[3]) + c[4] for c in capsules) + edge)
    field = Field(box, cell)
    for capsule in capsules:
        field.add(capsule, reach + 1.5 * cell)
    return field


# Sides of a cell are 0 below, 1 right, 2 above, 3 left. For each set of corners that lie within (1 lower left, 2 lower
# right, 4 upper right, 8 upper left) the sides at which the line enters and leaves, with the inside on its left.
CROSSINGS = {1: ((0, 3),), 2: ((1, 0),), 3: ((1, 3),), 4: ((2, 1),), 5: ((0, 3), (2, 1)), 6: ((2, 0),), 7: ((2, 3),),
             8: ((3, 2),), 9: ((0, 2),), 10: ((1, 0), (3, 2)), 11: ((1, 2),), 12: ((3, 1),), 13: ((0, 1),), 14: ((3, 0),)}


def _links(field, level):
    """Returns which crossing of a grid line follows which. A crossing is 2 * node for the line to the right of a node,
    2 * node + 1 for the line above it."""
    columns, following = field.columns, {}
    within = [[value < level for value in row] for row in field.rows]
    sides = (0, 3, 2 * columns, 1)
    for j in range(field.lines - 1):
        low, high = within[j], within[j + 1]
        if not any(low) and not any(high):
            continue
        for i in range(columns - 1):
            corners = low[i] + 2 * low[i + 1] + 4 * high[i + 1] + 8 * high[i]
            if corners in (0, 15):
                continue
            node = 2 * (j * columns + i)
            for enters, leaves in CROSSINGS[corners]:
                following[node + sides[enters]] = node + sides[leaves]
    return following


def _point(field, level, crossing):
    """Returns where a line of the level crosses a grid line."""
    j, i = divmod(crossing // 2, field.columns)
    here = field.rows[j][i]
    there = field.rows[j + 1][i] if crossing % 2 else field.rows[j][i + 1]
    # A neighbour without a distance is taken as one cell further away.
    there, here = min(there, here + field.cell), min(here, there + field.cell)
    along = field.cell * (level - here) / (there - here) if there != here else 0.0
    x, y = field.left + i * field.cell, field.bottom + j * field.cell
    return (x, y + along) if crossing % 2 else (x + along, y)


def lines_at(field, level):
    """Returns the lines at which the field has this value: closed ones end at their first point."""
    following = _links(field, level)
    lines, open_starts = [], sorted(set(following) - set(following.values()))
    while following:
        start = open_starts.pop(0) if open_starts else next(iter(following))
        crossing, line = start, [_point(field, level, start)]
        while crossing in following:
            crossing = following.pop(crossing)
            line.append(_point(field, level, crossing))
        if len(line) > 2:
            lines.append(line)
    return lines


def _kept(points, tolerance):
    """Marks the points that a line within the tolerance needs (Douglas and Peucker)."""
    keep = [False] * len(points)
    keep[0] = keep[-1] = True
    spans = [(0, len(points) - 1)]
    while spans:
        first, last = spans.pop()
        (x1, y1), (x2, y2) = points[first], points[last]
        dx, dy = x2 - x1, y2 - y1
        worst, at = tolerance * math.hypot(dx, dy), None
        for index in range(first + 1, last):
            x, y = points[index]
            away = abs(dx * (y - y1) - dy * (x - x1))
            if away > worst:
                worst, at = away, index
        if at is not None:
            keep[at] = True
            spans += [(first, at), (at, last)]
    return keep


def simplified(points, tolerance):
    """Returns the line without the points that it does not need within the tolerance."""
    x, y = points[0]
    middle = max(range(len(points)), key=lambda index: math.hypot(points[index][0] - x, points[index][1] - y))
    parts = [points[:middle + 1], points[middle:]] if points[0] == points[-1] else [points]
    kept = [[point for point, keep in zip(part, _kept(part, tolerance)) if keep] for part in parts if len(part) > 1]
    return sum((part[1:] for part in kept[1:]), kept[0]) if kept else points


def from_lowest(loop):
    """Returns the loop begun at its lowest point, where a search by rows of an image finds it first."""
    if loop[0] != loop[-1]:
        return loop
    start = min(range(len(loop) - 1), key=lambda index: (loop[index][1], loop[index][0]))
    return loop[start:-1] + loop[:start + 1]


def nearest_first(paths):
    """Returns the paths in the order in which each begins near the end of the one before."""
    left, ordered, x, y = list(paths), [], 0.0, 0.0
    while left:
        index = min(range(len(left)), key=lambda k: (left[k][0][0] - x) ** 2 + (left[k][0][1] - y) ** 2)
        ordered.append(left.pop(index))
        x, y = ordered[-1][-1][:2]
    return ordered


def merged(paths, reach):
    """Joins paths of which one begins within `reach` of the end of another before it."""
    result = []
    for path in paths:
        if result and math.dist(result[-1][-1][:2], path[0][:2]) < reach:
            result[-1] = result[-1] + path
        else:
            result.append(list(path))
    return result

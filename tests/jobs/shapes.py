"""Outlines, holes, texts and reliefs as paths of a tool: lists of points (x, y, z) in mm, z below 0 in the workpiece."""

import math

from boards import rounded
from contours import distance_to_segment, field_around, from_lowest, lines_at, merged, simplified


def plate(width, height, radius=2.0, turn=15, notch=None):
    """Returns a closed rectangle with round corners, of one point per `turn` degrees; `notch` is the width and depth of a
    cut in the middle of its upper side."""
    points = []
    for x, y, begin in ((width - radius, radius, -90), (width - radius, height - radius, 0),
                        (radius, height - radius, 90), (radius, radius, 180)):
        if begin == 90 and notch:
            middle, half = width / 2, notch[0] / 2
            points += [(middle + half, height), (middle + half, height - notch[1]), (middle - half, height - notch[1]),
                       (middle - half, height)]
        angles = range(begin, begin + 91, turn) if radius else (begin,)
        points += [(x + radius * math.cos(math.radians(a)), y + radius * math.sin(math.radians(a))) for a in angles]
    return points + [points[0]]


def wheel(radius, teeth, turn=4):
    """Returns the closed outline of a wheel with round teeth, 0 at the lower left of its box."""
    points = []
    for angle in range(0, 361, turn):
        at = math.radians(angle)
        r = radius * (1 + 0.06 * math.cos(teeth * at))
        points.append((radius * 1.06 + r * math.cos(at), radius * 1.06 + r * math.sin(at)))
    return points[:-1] + [points[0]]


def depths(deepest, passes):
    """Returns the depth of each pass."""
    return [deepest * (k + 1) / passes for k in range(passes)]


def cut_out(loop, deepest, passes, stay_down=True):
    """Returns a loop at each depth: one path if the tool stays down between passes, else one path per pass."""
    paths = [[(x, y, -depth) for x, y in loop] for depth in depths(deepest, passes)]
    return [sum(paths, [])] if stay_down else paths


def rows_of_holes(groups):
    """Returns the middles of holes: each group is (x, y, columns, rows, pitch)."""
    return [(x + i * pitch, y + j * pitch)
            for x, y, columns, rows, pitch in groups for j in range(rows) for i in range(columns)]


def drilled(holes, depth):
    """Returns a path of one point for each hole."""
    return [[(x, y, -depth)] for x, y in holes]


def bored(holes, radius, deepest, passes, turn=30):
    """Returns a path of circles for each hole: what a tool does whose hole is wider than the tool."""
    ring = [(radius * math.cos(math.radians(a)), radius * math.sin(math.radians(a))) for a in range(0, 361, turn)]
    return [[(x + dx, y + dy, -depth) for depth in depths(deepest, passes) for dx, dy in ring] for x, y in holes]


# Strokes of letters in a box of 4 by 6; those that begin with ~ are curves.
LETTERS = {
    "A": ["00 26 40", "0.7,2 3.3,2"], "B": ["~03 33 4,1.5 30 00", "00 06", "~06 36 3.6,4.5 33 03"],
    "C": ["~45 36 16 05 01 10 30 41"], "E": ["40 00 06 46", "03 33"], "F": ["00 06 46", "03 33"],
    "H": ["00 06", "46 40", "03 43"], "I": ["20 26"], "K": ["00 06", "46 03 40"], "L": ["06 00 40"],
    "M": ["00 06 23 46 40"], "N": ["00 06 40 46"], "O": ["~26 06 00 40 46 26"], "P": ["00 06", "~06 46 43 03"],
    "R": ["00 06", "~06 46 43 03", "23 40"], "S": ["~45 36 16 05 04 33 42 41 30 10 01"], "T": ["06 46", "26 20"],
    "U": ["~06 01 10 30 41 46"], "W": ["06 10 24 30 46"], "0": ["~26 06 00 40 46 26", "01 45"], "1": ["05 26 20"],
    "2": ["~05 16 36 45 44 00", "00 40"], "4": ["30 36 02 42"], " ": [],
}


def _stroke(text):
    """Returns the points of a stroke: pairs of digits, or two numbers with a comma."""
    pairs = [word.split(",") if "," in word else list(word) for word in text.lstrip("~").split()]
    points = [(float(x), float(y)) for x, y in pairs]
    return rounded(points, 3) if text.startswith("~") else points


def text(words, size, depth, x=0.0, y=0.0, line=1.6):
    """Returns the strokes of lines of text, `size` mm high, the last line at the bottom."""
    paths, unit, lines = [], size / 6, words.split("\n")
    for number, written in enumerate(lines):
        low = y + (len(lines) - 1 - number) * line * size
        for place, letter in enumerate(written):
            for stroke in LETTERS[letter]:
                paths.append([(x + (5.5 * place + px) * unit, low + py * unit, -depth) for px, py in _stroke(stroke)])
    return paths


def ridge(capsules, run):
    """Returns a relief of ridges: 1 on their tops, 0 further than `run` from them, smooth between."""
    def height(x, y):
        away = min(distance_to_segment(x, y, x1, y1, x2, y2) - radius for x1, y1, x2, y2, radius in capsules)
        part = min(1.0, max(0.0, away / run))
        return 1 - part * part * (3 - 2 * part)
    return height


def waves(length):
    """Returns a relief of crossed waves between 0 and 1."""
    return lambda x, y: 0.5 + 0.25 * (math.sin(2 * math.pi * x / length) + math.cos(2 * math.pi * y / (0.8 * length)))


def dome(x0, y0, radius):
    """Returns a relief of one half ball: 1 on its top, 0 beside it."""
    return lambda x, y: math.sqrt(max(0.0, 1 - ((x - x0) ** 2 + (y - y0) ** 2) / radius ** 2))


def _profile(points, tolerance):
    """Returns a scan line without the points that it does not need within the tolerance."""
    along = [(math.hypot(x - points[0][0], y - points[0][1]), z) for x, y, z in points]
    kept = set(simplified(along, tolerance))
    return [point for point, place in zip(points, along) if place in kept]


def _scan_line(row, size, spacing, turned):
    """Returns the points of a scan line in the plane."""
    count = max(1, round(size / spacing))
    line = [(row, k * size / count) if turned else (k * size / count, row) for k in range(count + 1)]
    return line


def finished(width, height, depth, relief, over, spacing, tolerance=0.0, turned=False):
    """Returns one path over a relief, to and fro: rows `over` mm apart, points `spacing` mm apart or fewer."""
    path, rows = [], round((width if turned else height) / over)
    for k in range(rows + 1):
        line = _scan_line(k * over, height if turned else width, spacing, turned)
        points = [(x, y, -depth * (1 - relief(x, y))) for x, y in line]
        points = _profile(points, tolerance) if tolerance else points
        path += points if k % 2 == 0 else points[::-1]
    return path


def _runs(line, depth, relief, above, level, leave):
    """Returns the parts of a scan line where a layer has something to take away."""
    runs, run = [], []
    for x, y in line:
        z = max(-level, leave - depth * (1 - relief(x, y)))
        if z < -above - 1e-9:
            run.append((x, y, z))
        else:
            runs, run = runs + [run], []
    return [run for run in runs + [run] if len(run) > 1]


def roughed(width, height, depth, relief, over, spacing, levels, leave=0.3, tolerance=0.0):
    """Returns paths over a relief in layers, each down to its level or to `leave` above the relief. The tool stays down
    from row to row, and lifts over what the layer before has left."""
    paths, above = [], 0.0
    for level in depths(depth, levels):
        layer = []
        for k in range(round(height / over) + 1):
            line = _scan_line(k * over, width, spacing, False)
            runs = _runs(line if k % 2 == 0 else line[::-1], depth, relief, above, level, leave)
            layer += [_profile(run, tolerance) if tolerance else run for run in runs]
        paths += merged(layer, 1.01 * over)
        above = level
    return paths


def cleared(width, height, capsules, depth, levels, tool, over=0.5, taper=0.2, tolerance=0.03, cell=0.5):
    """Returns paths around tapered bodies in layers, at each level in lines of equal distance until the rectangle is
    empty. The lines end at its sides."""
    field, paths = field_around(capsules, width + height, cell, (0.0, 0.0, width, height)), []
    for level in depths(depth, levels):
        away, lines = tool / 2 + taper * level, True
        while lines:
            lines = lines_at(field, away)
            paths += [[(x, y, -level) for x, y in from_lowest(simplified(line, tolerance))] for line in lines]
            away += tool * over
    return paths

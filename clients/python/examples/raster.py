"""Scans a picture point by point, to and fro, and saves it as raster.csv and as a grey picture.

Replace measure() with the reading of your detector.
"""

import csv
import importlib.util
import math

from axisgate import Stage, mm

COLUMNS, ROWS, STEP = 8, 6, 0.05  # STEP in mm


def measure(x, y):
    """Returns the brightness of a spot in the middle."""
    return math.exp(-((x - 0.175) ** 2 + (y - 0.125) ** 2) / 0.01)


def raster():
    """Yields column and row of all points, every second row backwards."""
    for row in range(ROWS):
        for column in range(COLUMNS) if row % 2 == 0 else reversed(range(COLUMNS)):
            yield column, row


picture = [[0.0] * COLUMNS for _ in range(ROWS)]
grid = list(raster())
points = [(column * STEP * mm, row * STEP * mm) for column, row in grid]

with Stage() as stage, stage.lease("x", "y", purpose="raster"), \
        open("raster.csv", "w", newline="", encoding="utf-8") as file:
    rows = csv.writer(file)
    rows.writerow(["x/mm", "y/mm", "value"])
    for done, ((column, row), at) in enumerate(zip(grid, stage.visit(points, "xy")), 1):
        x, y = at.positions["x"].value, at.positions["y"].value
        picture[row][column] = measure(float(x), float(y))
        rows.writerow([x, y, f"{picture[row][column]:.4f}"])
        print(f"\r{done}/{len(grid)}  {at}", end="", flush=True)
print()

if importlib.util.find_spec("matplotlib"):
    from matplotlib import pyplot
    pyplot.imsave("raster.png", picture, origin="lower", cmap="gray")
else:
    with open("raster.pgm", "w", encoding="ascii") as file:
        file.write(f"P2 {COLUMNS} {ROWS} 255\n")
        for values in reversed(picture):  # y points up
            file.write(" ".join(str(round(255 * value)) for value in values) + "\n")

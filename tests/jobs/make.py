#!/usr/bin/env python3
"""Writes 60 jobs for Roland mills, in the manners of the programs that people use, and a table of them.

usage: make.py FOLDER

jobs.tsv has a row per job: the mill it is for, what it makes, whose manner it is written in, the size of what it cuts (mm)
and the speed at which it cuts (mm/s; of drilled holes, the speed of the plunge).
"""

import dataclasses
import pathlib
import sys

import boards
import cam_writers
import fab_writers
import shapes

COLUMNS = ("file", "mill", "kind", "manner", "width_mm", "height_mm", "depth_mm", "speed_mm_s")

MANNERS = {
    "mods": fab_writers.mods, "mods-incremental": fab_writers.mods_incremental, "fabmodules": fab_writers.fabmodules,
    "fabmodules-2013": fab_writers.fabmodules_2013, "fabmodules-c": fab_writers.fabmodules_c,
    "kokopelli": fab_writers.kokopelli, "cam-py": fab_writers.cam_py, "circle-py": fab_writers.circle_py,
    "nodela": fab_writers.nodela, "eagle-cam": fab_writers.eagle_cam, "driver": fab_writers.driver,
    "modela-player": cam_writers.modela_player, "heekscnc": cam_writers.heekscnc, "artcam": cam_writers.artcam,
    "cam-post": cam_writers.cam_post, "vectric": cam_writers.vectric, "flatcam": cam_writers.flatcam,
    "easytrace": cam_writers.easytrace, "freecad": cam_writers.freecad, "gcode2rml": cam_writers.gcode2rml,
    "gcode-converter": cam_writers.gcode_converter, "print-gerber": cam_writers.print_gerber,
    "inkscape": cam_writers.inkscape, "by-hand": cam_writers.by_hand,
}
ENDINGS = {"driver": "prn", "cam-post": "prn", "print-gerber": "prn", "modela-player": "prn", "artcam": "prn",
           "vectric": "rol", "nodela": "mill", "eagle-cam": "drill", "by-hand": "txt"}
# Programs for which an inch is 1,000 steps: what they cut is smaller than what was drawn.
SHRUNK = {"cam-py": fab_writers.CAM_PY_UNITS * 0.025, "circle-py": fab_writers.CAM_PY_UNITS * 0.025}


@dataclasses.dataclass
class Job:
    """A job: paths in mm, from 0 in X and Y; Z is below 0 in the workpiece. `options` are those of its writer, and `edit`:
    what a person has done to the file since."""

    mill: str
    kind: str
    manner: str
    speed: float
    paths: list
    options: dict
    file: str = ""

    def size(self):
        """Returns width, height and depth of what is cut."""
        points = [point for path in self.paths for point in path]
        scale = SHRUNK.get(self.manner, 1.0)
        across = [scale * (max(values) - min(values)) for values in list(zip(*points))[:2]]
        return across + [scale * -min(z for _, _, z in points)]

    def text(self):
        return EDITS[self.options.get("edit")](MANNERS[self.manner](self))


def _separated(text):
    """Returns the text with an empty line before each move to another path, and one at the start."""
    return "\n" + text.replace("\nPU", "\n\nPU")


EDITS = {
    None: lambda text: text,
    "crlf": lambda text: text.replace("\n", "\r\n"),
    "blank lines": _separated,
}


def at_zero(paths):
    """Returns the paths moved to begin at 0 in X and Y."""
    left, low = (min(point[k] for path in paths for point in path) for k in (0, 1))
    return [[(x - left, y - low, z) for x, y, z in path] for path in paths]


def job(mill, kind, manner, speed, paths, **options):
    return Job(mill, kind, manner, speed, at_zero(paths), options)


def routed(columns, rows, nets, seed, pitch=1.27, width=0.4, curved=False, depth=0.1016, **way):
    """Returns the isolation of a board of parts and traces; `way` says how the tool goes (boards.isolation)."""
    return boards.isolation(boards.routed(columns, rows, pitch, nets, seed, width, curved), depth, **way)


def board_jobs():
    fab, curve = {"offsets": 4, "merge": 1.0}, {"curved": True, "tolerance": 0.012, "merge": 1.0}
    polygon = {"tolerance": 0.006, "merge": 0.0}
    return [
        job("srm-20", "board", "mods", 4, routed(20, 15, 14, 1, **fab), first_pixel=True),
        job("srm-20", "board", "mods", 4, routed(32, 22, 26, 2, offsets=2, merge=1.0), origin=(0.0, 0.0)),
        job("srm-20", "board", "mods", 3, routed(11, 8, 6, 12, **fab), origin=(20.0, 15.0), jog=5.0),
        job("srm-20", "board", "mods", 4, routed(19, 14, 12, 4, offsets=3, **curve), origin=(0.0, 0.0), edit="crlf"),
        job("srm-20", "board", "mods", 5, boards.isolation(boards.bus(58.0, 9, 2.54), 0.1016, offsets=2, merge=1.0)),
        job("srm-20", "board", "mods-incremental", 4, routed(22, 16, 16, 5, **fab)),
        job("srm-20", "board", "mods-incremental", 3.5, routed(18, 13, 10, 6, offsets=2, **curve), jog=2.5),
        job("srm-20", "board", "fabmodules", 4, routed(24, 16, 18, 7, **fab), origin=(0.0, 0.0), jog=2.0),
        job("srm-20", "board", "fabmodules", 2.5, routed(16, 12, 9, 8, depth=0.15, offsets=2, tool=0.254, merge=1.5),
            origin=(5.0, 5.0), home=(0.0, 0.0, 0.0), edit="blank lines"),
        job("srm-20", "board", "easytrace", 5, routed(24, 16, 16, 9, depth=0.12, tool=0.3, offsets=2, **polygon)),
        job("srm-20", "board", "driver", 4, routed(20, 14, 12, 10, depth=0.2, tool=0.5, tolerance=0.05), edit="crlf"),
        job("mdx-20", "board", "mods", 4, routed(21, 16, 15, 11, **fab), first_pixel=True),
        job("mdx-20", "board", "mods", 4, routed(21, 16, 12, 3, offsets=3, **curve), origin=(15.0, 10.0), jog=1.0),
        job("mdx-20", "board", "fabmodules-2013", 4, routed(19, 13, 12, 13, **fab), origin=(20.0, 20.0), jog=1.0),
        job("mdx-20", "board", "fabmodules-c", 4, routed(22, 15, 14, 14, offsets=4, tolerance=0.02)),
        job("mdx-20", "board", "kokopelli", 4, routed(16, 13, 10, 15, offsets=4, overlap=0.25, tolerance=0.02)),
        job("mdx-20", "board", "cam-py", 2,
            boards.isolation(boards.bus(70.0, 7, 5.08, 1.0), 0.2032, tool=0.381, offsets=3, overlap=0.8, tolerance=0.02),
            origin=(25.4, 12.7)),
        job("mdx-20", "board", "flatcam", 2, routed(18, 14, 9, 16, depth=0.14, tool=0.2, offsets=2, **polygon),
            origin=(1.0, 1.0)),
        job("mdx-15", "board", "mods", 4, routed(18, 14, 12, 17, **fab)),
        job("mdx-15", "board", "easytrace", 2.5, routed(20, 15, 13, 18, depth=0.1, tool=0.3, offsets=2, **polygon)),
        job("mdx-15", "board", "print-gerber", 3, routed(17, 12, 9, 19, depth=0.15, tool=0.25, **polygon)),
        job("mdx-40", "board", "mods", 4, routed(34, 24, 24, 20, offsets=2, merge=1.0), origin=(30.0, 30.0)),
        job("mdx-40", "board", "easytrace", 10, routed(26, 19, 18, 21, depth=0.1, tool=0.2, offsets=2, **polygon),
            rpm=15000),
        job("mdx-50", "board", "easytrace", 12,
            boards.isolation(boards.bus(180.0, 24, 3.81, 0.8), 0.15, offsets=2, tolerance=0.006, cell=0.3), rpm=12000),
    ]


def outline_jobs():
    def plate(width, height, passes, stay=True, deep=1.7, **form):
        return shapes.cut_out(shapes.plate(width, height, **form), deep, passes, stay)

    return [
        job("srm-20", "outline", "mods", 2, plate(38.0, 19.0, 3, deep=1.8288, radius=0.8), dpi=1000),
        job("srm-20", "outline", "mods", 1, shapes.cut_out(shapes.wheel(21.0, 12), 1.7272, 4), origin=(0.0, 0.0)),
        job("srm-20", "outline", "mods", 3, plate(64.0, 41.0, 3, deep=1.6764, notch=(12.0, 4.0)), dpi=500),
        job("srm-20", "outline", "fabmodules", 2, plate(27.0, 22.0, 3, deep=1.7), origin=(0.0, 0.0), edit="crlf"),
        job("srm-20", "outline", "easytrace", 4, plate(50.0, 33.0, 4, False, deep=1.8, turn=9), plunge=0.8),
        job("mdx-20", "outline", "mods", 4, plate(44.0, 28.0, 3, deep=1.7272)),
        job("mdx-20", "outline", "fabmodules-c", 4, plate(31.0, 25.0, 3, False, deep=1.7, radius=0.4)),
        job("mdx-20", "outline", "freecad", 3, plate(175.0, 130.0, 4, False, deep=1.6, radius=6.0, turn=6)),
        job("mdx-15", "outline", "mods", 2, plate(22.0, 15.0, 4, deep=1.8288, notch=(6.0, 3.0), radius=1.0)),
        job("mdx-15", "outline", "nodela", 2.4, plate(60.0, 40.0, 4, False, deep=1.6, radius=0.0)),
        job("mdx-40", "outline", "cam-post", 15, plate(210.0, 148.0, 2, deep=2.0, radius=10.0, turn=3), rpm=12000),
        job("mdx-50", "outline", "cam-post", 20, shapes.cut_out(shapes.wheel(60.0, 24, 2), 3.0, 3), rpm=10000,
            rpm_as_rpm=True, edit="crlf", origin=(100.0, 80.0)),
    ]


def hole_jobs():
    package = [(0.0, 0.0, 8, 1, 2.54), (0.0, 7.62, 8, 1, 2.54)]
    headers = [(0.0, 0.0, 10, 2, 2.54), (0.0, 30.48, 10, 2, 2.54), (33.0, 2.54, 1, 12, 2.54)]
    corners = [(25.0, 0.0, 2, 2, 7.62)]

    def bored(groups, *form):
        return shapes.bored(shapes.rows_of_holes(groups), *form)

    def drilled(groups, depth):
        return shapes.drilled(shapes.rows_of_holes(groups), depth)

    return [
        job("srm-20", "holes", "mods", 2, bored(headers, 0.1, 1.8288, 3, 45), origin=(12.0, 12.0)),
        job("srm-20", "holes", "easytrace", 3, bored(package + corners, 1.1, 1.8, 3, 15), plunge=0.5),
        job("mdx-20", "holes", "circle-py", 1, drilled(headers, 2.286), origin=(12.7, 12.7)),
        job("mdx-20", "holes", "eagle-cam", 2, drilled(package, 1.5), origin=(48.26, 25.4)),
        job("mdx-15", "holes", "flatcam", 1, drilled(headers, 1.8), origin=(2.0, 2.0)),
        job("mdx-540", "holes", "gcode2rml", 10, bored([(0.0, 0.0, 12, 9, 20.0)], 2.0, 4.0, 2, 20)),
    ]


def text_jobs():
    return [
        job("srm-20", "text", "driver", 5, shapes.text("FAB LAB\nROOM 204", 12.0, 0.3), plunge=2),
        job("mdx-20", "text", "by-hand", 3, shapes.text("KEEP CLEAR", 8.0, 0.25), plunge=1, origin=(5.0, 5.0)),
        job("mdx-15", "text", "driver", 12, shapes.text("A MILLER", 8.5, 0.2), origin=(3.4, 8.0)),
        job("mdx-40", "text", "inkscape", 30, shapes.text("WORKSHOP\nUNIT 12", 20.0, 0.3)),
    ]


def rough_jobs():
    rough, waves, dome = shapes.roughed, shapes.waves, shapes.dome
    body = [(15.0, 18.0, 38.0, 20.0, 5.0), (25.0, 10.0, 30.0, 28.0, 3.0)]
    hill = shapes.ridge([(20.0, 20.0, 50.0, 34.0, 5.0), (55.0, 15.0, 60.0, 40.0, 3.0)], 16.0)
    return [
        job("srm-20", "relief-rough", "mods", 20,
            shapes.cleared(54.0, 36.0, body, 8.0, 8, 3.175, tolerance=0.015, cell=0.6), dpi=300, origin=(20.0, 20.0), jog=5.0),
        job("srm-20", "relief-rough", "modela-player", 15, rough(76.0, 50.0, 10.0, hill, 1.2, 0.6, 8, tolerance=0.02),
            plunge=5.0, edit="crlf"),
        job("srm-20", "relief-rough", "modela-player", 25, rough(120.0, 90.0, 12.0, waves(34.0), 2.4, 1.6, 5), plunge=10.0),
        job("mdx-20", "relief-rough", "modela-player", 15,
            rough(80.0, 60.0, 9.0, dome(40.0, 30.0, 24.0), 2.0, 1.6, 7), plunge=3.0, edit="crlf"),
        job("mdx-20", "relief-rough", "cam-post", 12, rough(60.0, 45.0, 8.0, waves(22.0), 1.2, 1.0, 6), plunge=4.0),
        job("mdx-40", "relief-rough", "artcam", 19.9, rough(150.0, 100.0, 15.0, waves(48.0), 3.0, 2.0, 6)),
        job("mdx-40", "relief-rough", "heekscnc", 10, rough(90.0, 70.0, 12.0, hill, 2.0, 1.8, 6)),
        job("mdx-540", "relief-rough", "gcode-converter", 30,
            rough(200.0, 140.0, 20.0, dome(100.0, 70.0, 55.0), 5.0, 2.0, 4)),
    ]


def fine_jobs():
    fine, waves, dome = shapes.finished, shapes.waves, shapes.dome
    medal = shapes.ridge([(14.0, 12.0, 24.0, 26.0, 1.5), (24.0, 26.0, 34.0, 12.0, 1.5), (18.0, 18.0, 30.0, 18.0, 1.0)], 6.0)
    fish = shapes.ridge([(14.0, 18.0, 38.0, 20.0, 4.0), (38.0, 20.0, 47.0, 26.0, 1.0), (38.0, 20.0, 47.0, 13.0, 1.0)], 8.0)
    both_ways = [fine(48.0, 36.0, 5.0, medal, 0.5, 0.4, 0.006, turned) for turned in (False, True)]
    return [
        job("srm-20", "relief-fine", "mods", 20, [fine(54.0, 36.0, 6.0, fish, 0.4, 0.3, 0.01)], dpi=500, origin=(20.0, 20.0)),
        job("srm-20", "relief-fine", "modela-player", 30, [fine(76.0, 50.0, 9.0, waves(34.0), 0.5, 0.8)], plunge=10.0),
        job("mdx-20", "relief-fine", "fabmodules", 15, both_ways, dpi=300),
        job("mdx-15", "relief-fine", "modela-player", 12,
            [fine(40.0, 30.0, 4.0, dome(20.0, 15.0, 13.0), 0.3, 0.5, 0.003)], plunge=2.0, edit="crlf"),
        job("mdx-40", "relief-fine", "vectric", 25, [fine(120.0, 80.0, 10.0, waves(40.0), 1.0, 1.2)], plunge=8),
        job("mdx-40", "relief-fine", "cam-post", 20,
            [fine(90.0, 60.0, 8.0, dome(45.0, 30.0, 26.0), 0.5, 0.6, 0.004)], rpm=15000),
    ]


def all_jobs():
    """Returns the 60 jobs, numbered within their kind."""
    jobs, count = [], {}
    for made in board_jobs() + outline_jobs() + hole_jobs() + text_jobs() + rough_jobs() + fine_jobs():
        count[made.kind] = count.get(made.kind, 0) + 1
        made.file = f"{made.kind}-{count[made.kind]:02d}.{ENDINGS.get(made.manner, 'rml')}"
        jobs.append(made)
    return jobs


def write(folder):
    """Writes all jobs and jobs.tsv."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    rows = ["\t".join(COLUMNS)]
    for made in all_jobs():
        (folder / made.file).write_bytes(made.text().encode("ascii"))
        size = (f"{mm:.2f}" for mm in made.size())
        rows.append("\t".join([made.file, made.mill, made.kind, made.manner, *size, f"{made.speed:g}"]))
    (folder / "jobs.tsv").write_text("\n".join(rows) + "\n", encoding="ascii")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    write(sys.argv[1])

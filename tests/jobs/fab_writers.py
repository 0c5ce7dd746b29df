"""Jobs as the programs of the fab labs write them, and those that came from them. No code is theirs; the comments name
where each form was read (public repositories, by owner/name and file; versions of 2011 to 2024).

A writer takes a job (make.py) and returns its text. `units` are steps per mm as that program has them.
"""

import math

# fabfoundation/mods "Roland MDX" and "Roland SRM-20 milling machine": 40 for MDX-15 and MDX-20, 100 for the others.
UNITS = {"mdx-15": 40.0, "mdx-20": 40.0, "mdx-40": 100.0, "srm-20": 100.0, "mdx-50": 100.0, "mdx-540": 100.0}
# Home in mm, from the same files. That of the MDX-40 is the MDX-20's there, too.
HOME = {"mdx-15": (0.0, 92.4, 60.5), "mdx-20": (0.0, 152.4, 60.5), "mdx-40": (0.0, 152.4, 60.5),
        "srm-20": (0.0, 152.4, 60.5)}


def js(value):
    """Returns a number as JavaScript joins it to a text: without a point if it is whole."""
    return str(int(value)) if value == int(value) else repr(float(value))


def fixed(value):
    """Returns a number as JavaScript's toFixed(0): halves away from 0, and "-0" for what is a little less than 0."""
    return ("-" if value < 0 else "") + str(int(math.floor(abs(value) + 0.5)))


def c_int(value):
    """Returns a number as C converts it to int: without its fraction."""
    return str(int(value))


def _pixels(job):
    """Returns the paths in pixels of an image, and steps per pixel: these programs follow images, and divide their width
    by one pixel less than they have. Points in the same pixel become one."""
    dpi = job.options.get("dpi", 1000)
    units, per_mm = UNITS[job.mill], dpi / 25.4
    wide = round((1.0 + max(x for path in job.paths for x, _, _ in path)) * per_mm)
    paths = []
    for path in job.paths:
        points = [(round(x * per_mm), round(y * per_mm), round(z * per_mm)) for x, y, z in path]
        paths.append([point for k, point in enumerate(points) if k == 0 or point != points[k - 1]])
    if job.options.get("first_pixel"):
        paths = [path[:1] + [(path[0][0], path[0][1] + 1, path[0][2])] + path[1:] for path in paths]
    return paths, units * (25.4 * wide / dpi) / (wide - 1)


def _segments(job):
    """Returns the lines that mods and fab modules have between header and end: up, to the start, down, along, up."""
    paths, scale = _pixels(job)
    units = UNITS[job.mill]
    x0, y0 = (units * mm for mm in job.options.get("origin", (10.0, 10.0)))
    lines = []
    for path in paths:
        points = [(fixed(x0 + scale * x), fixed(y0 + scale * y), fixed(scale * z)) for x, y, z in path]
        lines.append(f"PU{points[0][0]},{points[0][1]};")
        lines += [f"Z{x},{y},{z};" for x, y, z in points]
        lines.append(f"PU{points[-1][0]},{points[-1][1]};")
    return lines


def mods(job):
    """fabfoundation/mods "Roland MDX", "Roland MDX-20", "Roland SRM-20 milling machine": make_path(). No line end after
    the last command, as in goodmanj/hello.t1616.echo outline.rml."""
    units, (x, y, z) = UNITS[job.mill], HOME[job.mill]
    jog = math.floor(units * job.options.get("jog", 2.0))
    header = f"PA;PA;VS{js(job.speed)};!VZ{js(job.speed)};!PZ0,{jog};!MC1;"
    end = f"PA;PA;!PZ0,{js(units * z)};PU{js(units * x)},{js(units * y)};!MC0;"
    return "\n".join([header, *_segments(job), end])


def fabmodules(job):
    """FabModules/fabmodules-html5 outputs/mod_Roland_mill.js of 2015: as mods, but the height of home is its Y."""
    units, (x, y, _) = UNITS[job.mill], job.options.get("home", HOME[job.mill])
    jog = math.floor(units * job.options.get("jog", 2.0))
    header = f"PA;PA;VS{js(job.speed)};!VZ{js(job.speed)};!PZ0,{jog};!MC1;"
    end = f"PA;PA;!PZ0,{js(units * y)};PU{js(units * x)},{js(units * y)};!MC0;"
    return "\n".join([header, *_segments(job), end])


def fabmodules_2013(job):
    """A fork of fabmodules-html5 with mod_Roland_MDX_20_path(): "!PZ-0," and H at the end."""
    jog = math.floor(40 * job.options.get("jog", 2.0))
    header = f"PA;PA;VS{js(job.speed)};!VZ{js(job.speed)};!PZ-0,{jog};!MC1;"
    return "\n".join([header, *_segments(job), "H;"]) + "\n"


def mods_incremental(job):
    """fabfoundation/mods "Roland SRM-20 RML" of 2022, make_path(): relative `!ZZ`, each difference rounded, from where the
    tool stands on the surface at the work origin, which is a corner of the image."""
    paths, scale = _pixels(job)
    x0, y0 = (UNITS[job.mill] * mm for mm in job.options.get("origin", (1.5, 1.5)))
    jog = math.floor(UNITS[job.mill] * job.options.get("jog", 2.0))
    lines = ["^PR;", f"^VS{js(job.speed)};!VZ{js(job.speed)};", "!RC15;!MC1;"]
    last = (0.0, 0.0)
    for path in paths:
        points = [(x0 + scale * x, y0 + scale * y, scale * z) for x, y, z in path]
        x, y, z = points[0]
        lines += [f"!ZZ0,0,{jog};", f"!ZZ{fixed(x - last[0])},{fixed(y - last[1])},0;", f"!ZZ0,0,{fixed(z - jog)};"]
        for (x1, y1, z1), (x, y, z) in zip(points, points[1:]):
            lines.append(f"!ZZ{fixed(x - x1)},{fixed(y - y1)},{fixed(z - z1)};")
        lines.append(f"!ZZ0,0,{fixed(-z)};")
        last = (x, y)
    return "\n".join([*lines, f"!ZZ0,0,{jog};", "!MC0;^VS10;!VZ10;", "^PA;!ZZ10160,15240,6050;"]) + "\n"


def _flat(job):
    """Returns the height of a job that is cut at one height, or None."""
    heights = {z for path in job.paths for _, _, z in path}
    return heights.pop() if len(heights) == 1 else None


def _in_steps(job, scale):
    """Returns the paths in whole steps as C truncates them, with the origin of the job."""
    x0, y0 = job.options.get("origin", (20.0, 20.0))
    return [[(c_int(scale * (x0 + x)), c_int(scale * (y0 + y)), c_int(scale * z)) for x, y, z in path] for path in job.paths]


def fabmodules_c(job):
    """fab modules in C of 2010, path_rml.c: last path first, PD if all is flat, a thousand `!MC0;` against a fault of
    the Modela's buffer, H."""
    flat = _flat(job)
    down = c_int(40.0 * (flat if flat is not None else min(z for path in job.paths for _, _, z in path)))
    jog = c_int(40.0 * job.options.get("jog", 1.0))
    lines = [f"PA;PA;VS{job.speed:.1f};!VZ{job.speed:.1f};!PZ{down},{jog};!MC1;"]
    for path in reversed(_in_steps(job, 40.0)):
        lines.append(f"PU{path[0][0]},{path[0][1]};")
        lines += [f"PD{x},{y};" if flat is not None else f"Z{x},{y},{z};" for x, y, z in path]
        lines.append(f"PU{path[-1][0]},{path[-1][1]};")
    return "\n".join([*lines, "!MC0;" * 1000, "H;"]) + "\n"


def kokopelli(job):
    """mkeeter/kokopelli koko/cam/machines/modela.py: as fabmodules_c, without `;` after !VZ and without line ends."""
    flat = _flat(job)
    down, jog = c_int(40.0 * min(z for path in job.paths for _, _, z in path)), c_int(40.0 * job.options.get("jog", 1.0))
    text = f"PA;PA;VS{job.speed:.1f};!VZ{job.speed:.1f}!PZ{down},{jog};!MC1;\n"
    for path in _in_steps(job, 40.0):
        text += f"PU{path[0][0]},{path[0][1]};"
        text += "".join(f"PD{x},{y};" if flat is not None else f"Z{x},{y},{z};" for x, y, z in path)
        text += f"PU{path[-1][0]},{path[-1][1]};"
    return text + "!MC0;" * 1000 + "\nH;\n"


# cam.py takes an inch to be 1,000 steps, which it is not quite: its jobs are 1.6 % too small.
CAM_PY_UNITS = 1000 / 25.4


def cam_py(job):
    """MIT's cam.py (cad.py) before fab modules, write_RML(): thousandths of an inch, and no line end anywhere."""
    units = CAM_PY_UNITS
    up, down = c_int(units * job.options.get("jog", 1.016)), c_int(units * min(z for path in job.paths for _, _, z in path))
    text = f"PA;PA;!PZ{down},{up};VS{js(job.speed)};!VZ{js(job.options.get('plunge', 5))};!MC1;"
    for path in _in_steps(job, units):
        text += f"PU{path[0][0]},{path[0][1]};" + "".join(f"PD{x},{y};" for x, y, _ in path[1:])
    return text + "PU{},{};!MC0;".format(*path[-1])


def circle_py(job):
    """The drill file of a script beside cam.py (wealoneonearth.blogspot.com, 2010): a hole is PU and PD to the same
    place, and there is no end."""
    down = c_int(CAM_PY_UNITS * min(z for path in job.paths for _, _, z in path))
    lines = [f"PA;PA;VS2;!VZ{js(job.speed)};!MC1;!PZ{down},50;"]
    for path in _in_steps(job, CAM_PY_UNITS):
        lines += [f"PU{path[0][0]},{path[0][1]};"] + [f"PD{x},{y};" for x, y, _ in path]
    return "\n".join(lines) + "\n\n"


def nodela(job):
    """andySigler/nodela nodela.js: each pass of a line on its own, !PZ before each, every command twice, CR LF; it ends
    on the surface at the origin."""
    text = f"PA;PA;VS{js(job.speed)};!VZ{js(job.options.get('plunge', 0.6))};!RC12000;"
    for path in _in_steps(job, 40.0):
        text += f"!PZ{path[0][2]},50;!MC1;\r\n" + f"PU;PU{path[0][0]},{path[0][1]};\r\n"
        text += "".join(f"PD;PD{x},{y};\r\n" for x, y, _ in path)
    x, y = (c_int(40.0 * mm) for mm in job.options.get("origin", (20.0, 20.0)))
    return text + f"PU;!MC0;PU{x},{y};!PZ0,200;PD;"


def eagle_cam(job):
    """The device FABLAB_DRILLING of ohwada/fablab-mill-n-drill eagle.def: EAGLE takes the MDX-20 for a pen plotter."""
    lines = ["PA;PA;VS4;!VZ2;!MC1;!PZ-60,20;"]
    for path in _in_steps(job, 40.0):
        lines += [f"PU{path[0][0]},{path[0][1]};"] + [f"PD{x},{y};" for x, y, _ in path[1:] or path]
    return "\n".join([*lines, "PU0,0;!MC0;"]) + "\n"


def driver(job):
    """Roland's driver for Windows, as Dr. Engrave prints through it: julia-m-stephenson/Modela_MDX_Controller test/*.prn,
    for an MDX-15. That other mills get the same words in their own steps is assumed."""
    units, up = UNITS[job.mill], c_int(UNITS[job.mill] * job.options.get("jog", 0.5))
    x0, y0 = job.options.get("origin", (2.0, 2.0))
    paths = [[(fixed(units * (x0 + x)), fixed(units * (y0 + y))) for x, y, _ in path] for path in job.paths]
    start = "PU{},{};".format(*paths[0][0])
    text = f";IN;!MC1;PA;\n\nVS{js(job.speed)};!VZ{js(job.options.get('plunge', 3))};!PZ0,6050;{start}\n"
    text += f"!PZ{fixed(units * _flat(job))},{up};"
    for path in paths:
        text += "PU{},{};".format(*path[0]) + "".join(f"PD{x},{y};" for x, y in path[1:] or path)
    return text + "\n\nPU;!MC0;\n"

"""Jobs as programs for computer-aided manufacturing write them (posts), and Roland's MODELA Player. No code is theirs;
the comments name where each form was read. A writer takes a job (make.py) and returns its text.
"""

from fab_writers import UNITS, fixed, js

# Steps of a lift to the top, and the highest speed: samples of MODELA Player for the MDX-20, HeeksCNC's for the MDX-40.
# Those of the SRM-20 are assumed: its 60.5 mm and 30 mm/s.
TOP = {"mdx-15": 2420, "mdx-20": 2420, "srm-20": 6050, "mdx-40": 10500}
FASTEST = {"mdx-15": 15.0, "mdx-20": 15.0, "srm-20": 30.0, "mdx-40": 50.0, "mdx-50": 60.0, "mdx-540": 125.0}


def steps(job, units=None):
    """Returns the paths in whole steps, with the origin of the job."""
    units = units or UNITS[job.mill]
    x0, y0 = job.options.get("origin", (0.0, 0.0))
    return [[tuple(int(fixed(units * mm)) for mm in (x0 + x, y0 + y, z)) for x, y, z in path] for path in job.paths]


def _clearance(job):
    return round(UNITS[job.mill] * job.options.get("clearance", 1.0))


def modela_player(job):
    """MODELA Player and SRP Player for the MDX-15 and MDX-20: the sample in the notes of Chris Drake's
    Roland_MDX-20-Manual-commander.pl. V goes before a point with it, only where it changes."""
    fast, top, clear = f"V{FASTEST[job.mill]:.1f};", TOP[job.mill], _clearance(job)
    plunge, paths = job.options.get("plunge", 1.0), steps(job)
    cutting = f"V{job.speed:.1f};" if job.speed != plunge else ""
    lines = [";;^IN;!MC0;", f"{fast}^PR;Z0,0,{top};^PA;", "!MC1;", "Z{},{},{};".format(*paths[0][0][:2], top)]
    for path in paths:
        x, y, z = path[0]
        lines += [f"Z{x},{y},{clear};", f"V{plunge:.1f};Z{x},{y},{z};"]
        lines += [(cutting if k == 0 else "") + "Z{},{},{};".format(*point) for k, point in enumerate(path[1:])]
        lines.append(fast + "Z{},{},{};".format(*path[-1][:2], clear if path is not paths[-1] else top))
    return "\n".join([*lines, "!MC0;^IN;"]) + "\n"


def heekscnc(job):
    """HeeksCNC nc/hpgl3d.py for the MDX-40: V50.0 and V10.0 before a move where rapid and feed change, as the mill runs
    rapid moves at first; !ZM0 at the end. Its feed is always 10 mm/s."""
    clear, lines = _clearance(job), [";;^IN;!MC0;", "V50.0;^PR;Z0,0,10500;^PA;", "!RC15;", "!MC1;"]
    rapid = True

    def move(fast, x, y, z):
        nonlocal rapid
        speed, rapid = "" if fast == rapid else "V50.0;" if fast else "V10.0;", fast
        lines.append(f"{speed}Z{x},{y},{z};")

    for path in steps(job):
        move(True, *path[0][:2], clear)
        for point in path:
            move(False, *point)
        move(True, *path[-1][:2], clear)
    return "\n".join([*lines, "!VZ50.0;!ZM0;", "!MC0;^IN;"]) + "\n"


# ArtCAM and VCarve multiply mm/min by 0.0166 for mm/s.
PER_SECOND = 0.0166


def artcam(job):
    """ArtCAM for mills of 0.01 mm: the sample of stackoverflow.com/questions/12612192; its end was not shown, and is
    assumed."""
    feeds = {name: job.options.get(name, value) * PER_SECOND for name, value in (("rapid", 3000), ("plunge", 600))}
    cutting, clear = f"V{job.speed:.1f};", _clearance(job)
    lines = [";;^IN;", "!MC1;", "!RC5000;", "V50.0;", "^PR;Z0,0,10500;", "^PA;", f"V{feeds['rapid']:.1f};", "Z0,0,1000;"]
    for path in steps(job):
        x, y, z = path[0]
        lines += [f"V{feeds['rapid']:.1f};", f"Z{x},{y},{clear};", f"V{feeds['plunge']:.1f};", f"Z{x},{y},{z};", cutting]
        lines += ["Z{},{},{};".format(*point) for point in path[1:]]
        lines += [f"V{feeds['rapid']:.1f};", f"Z{path[-1][0]},{path[-1][1]},{clear};"]
    return "\n".join([*lines, "Z0,0,1000;", "!MC0;", "^IN;"]) + "\n"


# Steps of the lift at start and end, and the range of the spindle, of Autodesk's "Roland RML" post.
LIFT = {"mdx-15": "162.6", "mdx-20": "162.6", "mdx-40": "10500", "mdx-50": "13500", "mdx-540": "15500"}
SPINDLE = {"mdx-15": (6500, 6500), "mdx-20": (6500, 6500), "mdx-40": (4500, 15000), "mdx-50": (4500, 15000),
           "mdx-540": (3000, 12000)}


def _stage(mill, rpm):
    """Returns the stage of !RC nearest to a speed, as the post chooses it."""
    low, high = SPINDLE[mill]
    return 0 if high == low else max(0, min(15, round((rpm - low) * 15 / (high - low))))


def cam_post(job):
    """Autodesk's "Roland RML" post for Fusion and HSMWorks, revisions of 2015 to 2023 (MDX-15/20, 40, 50, 540): one
    command per line, V anew after each rapid, and 162.6 steps as the lift of an MDX-15/20."""
    small, fast, clear = job.mill in ("mdx-15", "mdx-20"), f"V{FASTEST[job.mill]:.1f};", _clearance(job)
    home = ["^PR;", fast, f"Z0,0,{LIFT[job.mill]};", "^PA;"]
    rpm = job.options.get("rpm", SPINDLE[job.mill][1])
    speed = str(rpm) if job.options.get("rpm_as_rpm") else str(_stage(job.mill, rpm))
    lines = [";;^IN;" if small else ";;^DF;", "!MC1;" if small else f"!MC0;{fast}", *home, f"!RC{speed};!MC1;"]
    for number, path in enumerate(steps(job)):
        x, y, z = path[0]
        lines += [f"Z{x},{y},{3 * clear};"] if number == 0 else [fast, f"Z{x},{y},{clear};"]
        lines += [fast, f"Z{x},{y},{clear};"] if number == 0 else []
        lines += [f"V{job.options.get('plunge', 2.0):.1f};", f"Z{x},{y},{z};"]
        lines += [f"V{job.speed:.1f};"] if job.speed != job.options.get("plunge", 2.0) else []
        lines += ["Z{},{},{};".format(*point) for point in path[1:]]
        lines += [fast, f"Z{path[-1][0]},{path[-1][1]},{clear};"]
    return "\n".join([*lines, "!MC0;", *home, "^IN;" if small else "^DF;"]) + "\n"


def vectric(job):
    """Vectric's post "Roland MDX-40" (VCarve, 2006): CR LF ends each command, no `;`; rapid moves keep the last feed."""
    clear, plunge = _clearance(job), job.options.get("plunge", 5)
    lines = ["^DF", f"!RC{job.options.get('stage', 12)}", f"!MC1;Z 0,0,{5 * clear}", "V 64;F 64"]
    feed = None
    for path in steps(job):
        x, y, z = path[0]
        lines.append(f"Z {x},{y},{clear}")
        for wanted, points in ((plunge, path[:1]), (round(job.speed), path[1:])):
            lines += [f"V {wanted};F {wanted}"] if wanted != feed and points else []
            feed = wanted if points else feed
            lines += ["Z {},{},{}".format(*point) for point in points]
        lines.append(f"Z {path[-1][0]},{path[-1][1]},{clear}")
    return "\r\n".join([*lines, f"Z 0,0,{5 * clear}", "!MC0;", "H"]) + "\r\n"


def _python(value):
    return str(float(value))


def flatcam(job):
    """FlatCAM's preprocessor Roland_MDX_20: V before every move, "!MC1" without `;`, heights with all their digits. The
    order of the calls is that of FlatCAM's generator, from memory."""
    x0, y0 = job.options.get("origin", (0.0, 0.0))
    rapid, feed, lift = "V15.0;", f"V{job.speed:.1f};", job.options.get("clearance", 2.0)

    def place(x, y, z):
        return f"Z{(x0 + x) * 40.0:.1f},{(y0 + y) * 40.0:.1f},{_python(z * 40.0)};"

    lines = [";;^IN;", "^PA;", feed, rapid, place(-x0, -y0, lift), "!MC1"]
    for path in job.paths:
        x, y, z = path[0]
        lines += [rapid, place(x, y, lift), f"V{job.options.get('plunge', 1.0):.1f};", feed, place(x, y, z), feed]
        for point in path[1:]:
            lines += [feed, place(*point)]
        lines += [rapid, place(*path[-1][:2], lift)]
    return "\n".join([*lines, "!MC0", rapid, place(*path[-1][:2], lift), rapid, place(-x0, -y0, 15.0)]) + "\n"


def easytrace(job):
    """RicardoJCMarques/EasyTrace5000 export/processors/roland-processor.js and its machine profiles: V or !VZ where it
    changes, !RC in rpm even for an SRM-20, no line end after the last command."""
    small, units, travel = job.mill in ("mdx-15", "mdx-20"), UNITS[job.mill], job.options.get("clearance", 3.0)
    init, velocity = ("^IN", "V") if small else ("^DF", "!VZ")
    lines = [f";;{init}", "PA;", f"{velocity}{js(job.speed)};", f"!PZ0,{fixed(units * travel)};"]
    lines += [] if small else [f"!RC{job.options.get('rpm', 7000)};"]
    lines.append("!MC1;")
    feed = job.speed

    def move(wanted, x, y, z):
        nonlocal feed
        changed, feed = wanted != feed, wanted
        return ([f"{velocity}{js(wanted)};"] if changed else []) + [f"Z{x},{y},{z};"]

    high, fast, at = round(units * travel), FASTEST[job.mill], (0, 0)
    for path in steps(job):
        (x, y, z), wanted = path[0], job.options.get("plunge", 1.0)
        lines += move(fast, *at, high) + move(fast, x, y, high) + move(wanted, x, y, z)
        for point in path[1:]:
            lines += move(job.speed, *point)
        at = path[-1][:2]
    return "\n".join([*lines, *move(fast, *at, high), "!MC0;", "PU0,0;", f";;{init}"])


def freecad(job):
    """FreeCAD Path rml_post.py (2015): 40 steps a mm whatever the mill, PU with the heights of the panel, no line end
    after H."""
    lines = ["PA;PA;", "!MC1;", "VS2.0;", "!VZ1.0;", f"VS{job.speed:.1f};", f"!VZ{job.speed:.1f};"]
    for path in job.paths:
        points = [tuple(int(40.0 * mm) for mm in point) for point in path]
        lines += ["PU;", "PU{},{};".format(*points[0][:2]), *("Z{},{},{};".format(*point) for point in points), "PU;"]
    return "\n".join([*lines, "!MC0;", "H;"])


def gcode2rml(job):
    """10maurycy10/gcode2rml for the MDX-540: relative !ZE with a blank after each axis, one feed for all moves, CR LF. It
    starts where the tool stands: here on the surface at the work origin."""
    lines = ["V10;", "!DW;", "^PR;", "!MC0;", "!RC15;", "!RC15;", "!MC1;", f"V{job.speed:.1f};"]
    clear, last = _clearance(job), (0, 0, 0)

    def move(x, y, z):
        nonlocal last
        words = "".join(f"{axis}{there - here} " for axis, here, there in zip("XYZ", last, (x, y, z)) if there != here)
        last = (x, y, z)
        lines.extend([f"!ZE {words};"] if words else [])

    for path in steps(job):
        move(*last[:2], clear)
        move(*path[0][:2], clear)
        for point in path:
            move(*point)
    move(*last[:2], clear)
    return "\r\n".join([*lines, "!MC0;"]) + "\r\n"


def gcode_converter(job):
    """A converter of the same name for the MDX-540 ("V85.0;^PR;Z0,0,15500;^PA;"): all in one line, each coordinate cut
    off after adding a half. That its moves have no line ends either is assumed."""
    clear, fast, text, feed = job.options.get("clearance", 5.0), 85.0, ";;^IN;V85.0;^PR;Z0,0,15500;^PA;!RC15;!MC1;", 85.0

    def move(wanted, *point):
        nonlocal feed
        speed, feed = "" if wanted == feed else f"V{wanted:.1f};", wanted
        return speed + "Z{},{},{};".format(*(int(100.0 * mm + 0.5) for mm in point))

    for path in job.paths:
        x, y, z = path[0]
        text += move(fast, x, y, clear) + move(job.options.get("plunge", 5.0), x, y, z)
        text += "".join(move(job.speed, *point) for point in path[1:]) + move(fast, *path[-1][:2], clear)
    return text + "!MC0;^IN;"


def print_gerber(job):
    """Charles Donohue's G-code printer for the MDX-15 (2018): V and F in one line without `;`, three decimals, 16 mm/s for
    rapid moves, which is more than the mill has."""
    lines, mode, clear = ["^DF"], None, job.options.get("clearance", 2.0)
    x0, y0 = job.options.get("origin", (0.0, 0.0))

    def move(rapid, x, y, z):
        nonlocal mode
        if rapid != mode:
            mode, speed = rapid, 16.0 if rapid else job.speed
            lines.append(f"V {speed:.2f};F {speed:.2f}")
        lines.append("Z {:.3f},{:.3f},{:.3f}".format(*(mm / 0.025 for mm in (x0 + x, y0 + y, z))))

    for path in job.paths:
        move(True, *path[0][:2], clear)
        for point in path:
            move(False, *point)
        move(True, *path[-1][:2], clear)
    return "\n".join([*lines, "^DF;!MC0;", "H"]) + "\n"


def inkscape(job):
    """An extension of Inkscape that writes "! 1" and V 64 as older jobs do: blanks between numbers, empty lines, its first
    command (^DF) lost, V 0 at the end."""
    feed, end = f"V {round(job.speed)};F {round(job.speed)}", "Z 0 0 100"
    lines, last = ["! 1", "V 64;F 64", end, "V 64;F 64", feed, ""], end
    for path in steps(job):
        above = "Z {} {} 100".format(*path[0][:2])
        lines += [last] if last != end else []
        lines += [above] + ["Z {} {} {}".format(*point) for point in path]
        last = "Z {} {} 100".format(*path[-1][:2])
        lines += [last, ""]
    return "\n".join([*lines, end, "V 0;F 0", "", ""])


def by_hand(job):
    """Mode 1 as a person types it from the guideline (sections 3-1 @, D, F, H, M): no header; several points to a D."""
    paths = steps(job)
    lines = [f"F {js(job.speed)}", f"V {js(job.options.get('plunge', 1))}", f"@ {paths[0][0][2]},{_clearance(job)}", ""]
    for path in paths:
        lines.append("M {},{}".format(*path[0][:2]))
        points = path[1:] or path
        for k in range(0, len(points), 6):
            lines.append("D " + ", ".join("{},{}".format(*point[:2]) for point in points[k:k + 6]))
    return "\r\n".join([*lines, "", "H"]) + "\r\n"

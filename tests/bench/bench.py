#!/usr/bin/env python3
"""Measures the daemon from end to end, beside direct access and beside the smallest gateway in the same run, and prints
the goals with what was measured. Build with the preset `release` first.

    AXISGATE_BIN=build-release/bin tests/bench/bench.py
    AXISGATE_BIN=build-release/bin tests/bench/bench.py --short --only G1 G5
    AXISGATE_BIN=build-release/bin tests/bench/bench.py --compare before=/tmp/before/bin --json figures.json
"""

import argparse
import dataclasses
import json
import pathlib
import sys
import traceback

sys.dont_write_bytecode = True

import goals_idle  # noqa: E402
import goals_mill  # noqa: E402
import goals_motion  # noqa: E402
import goals_questions  # noqa: E402
import goals_sharing  # noqa: E402
import goals_streams  # noqa: E402
import machine  # noqa: E402
from beds import BIN, Build  # noqa: E402
from figures import Row, shown, summary, table, table_of_goals  # noqa: E402

GOALS = {"G1": goals_questions.instant, "G2": goals_questions.paced, "G3": goals_questions.many_callers,
         "G5": goals_motion.stops, "G6": goals_streams.events, "G7": goals_streams.shared, "G10": goals_motion.paths,
         "G11": goals_motion.wrong_replies, "G12": goals_motion.moves, "G13": goals_idle.idle,
         "turns": goals_sharing.turns, "mill": goals_mill.beside_a_mill, "costs": goals_questions.costs}
REPEAT, REPEAT_SHORT = 5, 2
SHORT_SHARE = 0.3
THIS = "now"


@dataclasses.dataclass(frozen=True)
class Plan:
    builds: list
    repeat: int
    share: float  # of the full times and counts

    def seconds(self, full):
        return full * self.share

    def count(self, full):
        return max(1, round(full * self.share))


def run(goal, plan, meanwhile_rows):
    """The rows of one goal. What cannot be measured is a row that says why."""
    print(f"{goal} ...", file=sys.stderr, flush=True)
    meanwhile, rows = machine.Meanwhile(), []
    try:
        for row in GOALS[goal](plan):
            rows.append(dataclasses.replace(row, load=meanwhile.load))
    except Exception as error:  # the other goals can be measured nevertheless
        traceback.print_exc()
        rows.append(Row(goal, "the rest", "", [], absolute=f"not measured: {type(error).__name__}: {error}"))
    meanwhile_rows.append({"goal": goal, **meanwhile.end()})
    return rows


def shown_meanwhile(rows):
    return table(("goal", "seconds", "load before", "load after", "CPUs busy", "stolen"),
                 [(row["goal"], shown(round(row["seconds"])), f"{row['load_before']:.2f}", f"{row['load_after']:.2f}",
                   f"{row['busy']:.0%}", f"{row['stolen']:.0%}") for row in rows])


def as_json(plan, rows, meanwhile_rows):
    return {"machine": machine.description(), "repeat": plan.repeat, "share": plan.share, "meanwhile": meanwhile_rows,
            "rows": [{**dataclasses.asdict(row), "figure": row.figure, "met": row.met} for row in rows]}


def parsed(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--short", action="store_true", help="3 minutes instead of 15; its figures are coarse")
    parser.add_argument("--only", nargs="+", choices=GOALS, metavar="GOAL", help=f"some of {', '.join(GOALS)}")
    parser.add_argument("--repeat", type=int, help=f"repetitions: {REPEAT}, with --short {REPEAT_SHORT}")
    parser.add_argument("--compare", nargs="+", default=[], metavar="NAME=FOLDER",
                        help="further builds with an axisgated, measured alternately with this one")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="write the figures there, too")
    arguments = parser.parse_args(words)
    arguments.compare = [one.partition("=") for one in arguments.compare]
    if not all(name.isidentifier() and folder for name, _, folder in arguments.compare):
        parser.error("--compare needs NAME=FOLDER; a name has letters, digits and _")
    return arguments


def main(words):
    arguments = parsed(words)
    others = [Build(name, pathlib.Path(folder).resolve()) for name, _, folder in arguments.compare]
    plan = Plan([*others, Build(THIS, BIN.resolve())],
                arguments.repeat or (REPEAT_SHORT if arguments.short else REPEAT),
                SHORT_SHARE if arguments.short else 1)
    for program in [BIN / "axisgate-bench", *(build.folder / "axisgated" for build in plan.builds)]:
        if not program.exists():
            print(f"bench: {program} is missing; build with the preset `release`, and set AXISGATE_BIN",
                  file=sys.stderr)
            return 2
    rows, meanwhile_rows = [], []
    for goal in arguments.only or GOALS:
        rows += run(goal, plan, meanwhile_rows)
    print(f"{machine.description()}; {plan.repeat} repetitions{', short' if arguments.short else ''}\n")
    print(f"{table_of_goals(rows)}\n\n{summary(rows)}\n\n{shown_meanwhile(meanwhile_rows)}")
    if arguments.json:
        arguments.json.write_text(json.dumps(as_json(plan, rows, meanwhile_rows), indent=1), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

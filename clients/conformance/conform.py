#!/usr/bin/python3
"""Runs the scenario with the runner of one package, and prints a line for each step.

usage: conform.py [--transport unix|loopback|tls] [--step N]... RUNNER [ARGUMENT]...
       conform.py --mutants RUNNER [ARGUMENT]...
       conform.py --mutant NAME RUNNER [ARGUMENT]...

RUNNER is a program that translates one act of the scenario at a time into calls of its package (README.md).
With --mutants, proves that the scenario notices a wrong daemon: each mutation (mutations.py) must make its step fail.
Exits with 0 if every step is as the scenario says, or every mutation is noticed; with 1 if not; and with 2 if the
command line is wrong.
"""

import argparse
import functools
import sys
import time

sys.dont_write_bytecode = True

from mutations import MUTATIONS  # noqa: E402
from play import play_steps, read_scenario  # noqa: E402
from proxy import Proxy  # noqa: E402


def run_scenario(steps, transport, command):
    """Prints each step. Returns the number of steps that differ from the scenario."""
    faults = 0
    for step, difference, took_s in play_steps(steps, transport, command):
        faults += difference is not None
        print(f"{transport} step {step['step']:2} {'FAILED' if difference else 'ok'} {took_s:5.1f} s  {step['title']}"
              f"{': ' + ': '.join(difference) if difference else ''}", flush=True)
    return faults


def verdict_of(mutation, difference):
    """Returns "noticed" if the step of the mutation has the difference that the table names."""
    if difference is None:
        return "NOT NOTICED"
    return "noticed" if difference[1].startswith(mutation.difference) else "OTHERWISE"


def run_mutant(mutation, command):
    """Runs the step of the mutation with the mutated daemon, and prints the result. Reports whether it was noticed."""
    begun = time.monotonic()
    steps = [step for step in read_scenario() if step["step"] == mutation.step]
    mutant = functools.partial(Proxy, mutation=mutation)
    [(_, difference, _)] = play_steps(steps, "unix", command, mutant)
    verdict = verdict_of(mutation, difference)
    print(f"{mutation.name:18} {verdict} {time.monotonic() - begun:5.1f} s  step {mutation.step}"
          f"{': ' + ': '.join(difference) if difference else ''}", flush=True)
    return verdict == "noticed"


def chosen_steps(arguments):
    steps = read_scenario()
    if arguments.step:
        return [step for step in steps if step["step"] in arguments.step]
    return [step for step in steps if arguments.transport == "unix" or step.get("everywhere")]


def chosen_mutations(arguments):
    return [mutation for mutation in MUTATIONS if arguments.mutants or mutation.name == arguments.mutant]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--transport", choices=("unix", "loopback", "tls"), default="unix")
    parser.add_argument("--step", type=int, action="append")
    mutants = parser.add_mutually_exclusive_group()
    mutants.add_argument("--mutant", choices=[mutation.name for mutation in MUTATIONS])
    mutants.add_argument("--mutants", action="store_true")
    parser.add_argument("runner", nargs="+")
    arguments = parser.parse_args()
    mutations = chosen_mutations(arguments)
    if mutations:
        noticed = [run_mutant(mutation, arguments.runner) for mutation in mutations]
        return 0 if all(noticed) else 1
    return 1 if run_scenario(chosen_steps(arguments), arguments.transport, arguments.runner) else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""Runs each row with each client, and each row once before a gateway that is broken on purpose; then the tools. Prints a
table for each; the last line is "N passed, M failed".
usage: interop.py FOLDER [--only CLIENT] [--every]     FOLDER has what interop.sh built; --every: each client before each
                                                       broken gateway"""

import argparse
import concurrent.futures
import pathlib
import subprocess
import sys

import tools
from rows import FAULTS, IPV6, run_row

# Name, folder below clients/, program, environment.
CLIENTS = [
    ("grpcio of Debian", "python", "client-debian", {}),
    ("grpcio", "python", "client", {}),
    ("grpcio without BDP probes", "python", "client", {"AXISGATE_BDP_PROBE": "0"}),
    ("grpc-js", "node", "client", {}),
    ("grpc-go", "go", "client", {}),
    ("grpc-java", "java", "client", {}),
    ("tonic", "rust", "client", {}),
]
AT_ONCE = 2  # cells; most of their time they wait


def cells(clients, every):
    """Row, client, host, and what is broken; a cell's own daemon serves it."""
    for at, (row, fault) in enumerate(FAULTS.items()):
        for number, client in enumerate(clients):
            yield row, client, "127.0.0.1", ""
            if row in IPV6:
                yield row, client, "::1", ""
            if every or number == at % len(clients):
                yield row, client, "127.0.0.1", fault


def judge(cell, fault):
    """What is wrong; a broken gateway must be noticed."""
    if fault:
        return "" if cell.fault else f"a gateway that {fault} was not noticed"
    return cell.fault


def run_cell(folder, row, client, host, fault):
    _, language, program, environment = client
    return run_row(folder / language / program, row, host, fault, environment)


def show(row, client, host, fault, cell):
    """One line of the table: PASS or FAIL, where, and what was seen."""
    complaint = judge(cell, fault)
    place = row + (" over IPv6" if host == "::1" else "") + (f", a gateway that {fault}" if fault else "")
    seen = f"noticed: {cell.fault}" if fault and cell.fault else f"{cell.calls} calls"
    notes = "".join(f" ({note})" for note in cell.notes if not fault)
    print(f"{'FAIL' if complaint else 'ok'}  {client[0]}  {place}: {complaint or seen[:160]}{notes}", flush=True)
    return not complaint


def run_clients(folder, clients, every):
    todo = list(cells(clients, every))
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        done = pool.map(lambda cell: run_cell(folder, *cell), todo)
        return [show(*cell, seen) for cell, seen in zip(todo, done)]


def versions(folder, clients):
    for name, language, program, _ in clients:
        shown = subprocess.run([folder / language / program, "--version"], capture_output=True, text=True, check=True)
        print(f"{name}: {shown.stdout.strip()}")


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("folder", type=pathlib.Path)
    arguments.add_argument("--only")
    arguments.add_argument("--every", action="store_true")
    given = arguments.parse_args()
    clients = [client for client in CLIENTS if given.only in (None, client[0])]
    versions(given.folder, clients)
    passed = run_clients(given.folder, clients, given.every)
    if given.only is None:
        passed += tools.run(given.folder)
    print(f"{sum(passed)} passed, {len(passed) - sum(passed)} failed")
    sys.exit(not all(passed))


if __name__ == "__main__":
    main()

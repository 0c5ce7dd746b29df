"""What the kernel reports of a process, and of the machine meanwhile."""

import dataclasses
import os
import pathlib
import platform
import re
import time

_TICKS_PER_S = os.sysconf("SC_CLK_TCK")
_PROC = pathlib.Path("/proc")


@dataclasses.dataclass(frozen=True)
class Sample:
    """Of a process, at one moment."""

    time: float
    cpu_s: float
    switches: int
    threads: dict  # by number: place and name, and CPU seconds
    anonymous_kib: int
    resident_kib: int


@dataclasses.dataclass(frozen=True)
class Cost:
    """Of a process, between two moments."""

    cpu_s: float
    cores: float
    switches: int
    shares: dict  # of its CPU time by place and name of the thread, the greatest first


def sample(pid):
    process = _PROC / str(pid)
    threads, switches = {}, 0
    # By their numbers they are in the order in which they were made, the first being the process's own.
    for place, task in enumerate(sorted((process / "task").iterdir(), key=lambda task: int(task.name)), start=1):
        try:
            name, cpu_s = _cpu_of(task)
            status = (task / "status").read_text(encoding="utf-8")
        except (FileNotFoundError, ProcessLookupError):
            continue  # it has just ended
        threads[task.name] = (f"{place} {name}", cpu_s)
        switches += sum(int(count) for count in re.findall(r"ctxt_switches:\s+(\d+)", status))
    status = (process / "status").read_text(encoding="utf-8")
    return Sample(time.monotonic(), _cpu_of(process)[1], switches, threads, _kib(status, "RssAnon"),
                  _kib(status, "VmRSS"))


def cost(before, after):
    cpu_s = after.cpu_s - before.cpu_s
    nothing = ("", 0)
    used = {name: seconds - before.threads.get(number, nothing)[1]
            for number, (name, seconds) in after.threads.items()}
    total = sum(used.values())
    shares = {name: one / total for name, one in sorted(used.items(), key=lambda item: -item[1])} if total else {}
    return Cost(cpu_s, cpu_s / (after.time - before.time), after.switches - before.switches, shares)


def _cpu_of(folder):
    """Name and CPU seconds of a process or of one of its threads."""
    name, rest = re.fullmatch(r"\d+ \((.*)\) (.*)\n", (folder / "stat").read_text(encoding="utf-8"), re.DOTALL).groups()
    fields = rest.split()  # from the third on
    return name, (int(fields[11]) + int(fields[12])) / _TICKS_PER_S


def _kib(status, name):
    return int(re.search(rf"{name}:\s+(\d+) kB", status)[1])


def description():
    model = re.search(r"model name\s*:\s*(.+)", (_PROC / "cpuinfo").read_text(encoding="utf-8"))
    return f"{model[1] if model else platform.machine()}, {os.cpu_count()} CPUs, Linux {platform.release()}"


class Meanwhile:
    """What the machine does from now until `end`."""

    def __init__(self):
        self.load = os.getloadavg()[0]
        self._begun, self._times = time.monotonic(), self._cpu_times()

    @staticmethod
    def _cpu_times():
        with open(_PROC / "stat", encoding="ascii") as file:
            return [int(field) for field in file.readline().split()[1:9]]

    def end(self):
        user, nice, system, idle, wait, irq, soft, steal = (
            after - before for before, after in zip(self._times, self._cpu_times()))
        total = max(1, user + nice + system + idle + wait + irq + soft + steal)
        return {"seconds": time.monotonic() - self._begun, "load_before": self.load, "load_after": os.getloadavg()[0],
                "busy": 1 - (idle + wait) / total, "stolen": steal / total}

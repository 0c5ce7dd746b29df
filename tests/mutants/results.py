"""What became of each mutation: kept in a file as it comes, and told at the end."""

import collections
import hashlib
import json


def hash_of(source):
    return hashlib.sha256(source.encode()).hexdigest()


class Results:
    """Lines of JSON. A kill holds while the mutated file is the same; a survivor is tried again at another commit."""

    def __init__(self, file, commit):
        self.file = file
        self.commit = commit
        self.known = {}
        if file.exists():
            for line in file.read_text(encoding="utf-8").splitlines():
                self._learn(line)

    def _learn(self, line):
        try:
            result = json.loads(line)
            self.known[result["id"], result["source"], result["after"]] = result
        except (ValueError, KeyError):
            pass  # half a line of an interrupted run

    def of(self, mutation, source):
        """What is known and still holds, or None."""
        result = self.known.get((mutation.id, hash_of(source), mutation.after))
        if result and (result["verdict"] != "survived" or result["commit"] == self.commit):
            return result
        return None

    def add(self, mutation, source, outcome):
        result = {"id": mutation.id, "source": hash_of(source), "commit": self.commit, "text": mutation.text,
                  "before": mutation.before, "after": mutation.after, **outcome}
        with self.file.open("a", encoding="utf-8") as out:
            out.write("\n" * self._ends_within_a_line() + json.dumps(result) + "\n")
        self.known[result["id"], result["source"], result["after"]] = result
        return result

    def _ends_within_a_line(self):
        if not self.file.exists() or self.file.stat().st_size == 0:
            return False
        return not self.file.read_bytes().endswith(b"\n")


def told(result):
    if result["verdict"] == "killed":
        how = "" if result["how"] == "failed" else f" ({result['how']})"
        return f"killed by {result['by']} {result['test']}{how}"
    if result["verdict"] == "equivalent":
        return f"equivalent: {result['reason']}"
    return {"survived": "SURVIVED", "not compiled": "does not compile"}[result["verdict"]]


def table(tried):
    """The lines at the end, of pairs of mutation and result."""
    verdicts = collections.Counter(result["verdict"] for _, result in tried)
    killers = collections.Counter(result["by"] for _, result in tried if result["verdict"] == "killed")
    lines = ["", "| of the mutations | number |", "|---|---|", f"| drawn | {len(tried)} |"]
    lines += [f"| not compiled | {verdicts['not compiled']} |"]
    lines += [f"| killed by {program} | {number} |" for program, number in killers.most_common()]
    lines += [f"| equivalent | {verdicts['equivalent']} |", f"| survived | {verdicts['survived']} |"]
    survivors = [mutation for mutation, result in tried if result["verdict"] == "survived"]
    if survivors:
        lines += ["", "survived:", *(f"  {mutation.id}  {mutation.description}" for mutation in survivors)]
    return lines

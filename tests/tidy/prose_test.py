"""Comments without a subject and long lines are found where people read."""

import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import prose  # noqa: E402
from tree import File  # noqa: E402


def rules(path, content):
    file = File(path, content)
    return [(found.line, found.rule) for found in prose.check(file, [file])]


class Comments(unittest.TestCase):
    def test_begin_with_their_subject(self):
        for path in ("server/a.cc", "tests/unit/a.h", "proto/axisgate/v1/a.proto"):
            self.assertEqual(rules(path, "int a = 0;  // What is left.\n// Of a mill: its pace.\nint b = 0;\n"),
                             [(1, "comment-subject"), (2, "comment-subject")], path)
            self.assertEqual(rules(path, "// Returns the rest.\n// Who waits is not told.\nint a;\n"), [], path)

    def test_in_code_and_texts_are_none(self):
        self.assertEqual(rules("server/a.cc", 'f("// What");\nWhat what;\n'), [])


class Lines(unittest.TestCase):
    def test_of_pages_and_protos_fit_a_screen(self):
        long = "word " * 30
        self.assertEqual(rules("docs/a.md", f"{long}\n    {long}\n| {long}|\n```\n{long}\n```\n"), [(1, "long-line")])
        self.assertEqual(rules("a.proto", f"// {long}\n"), [(1, "long-line")])
        self.assertEqual(rules("device/shrc203/COMMANDS.md", f"{long}\n"), [])


if __name__ == "__main__":
    unittest.main()

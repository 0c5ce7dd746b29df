"""Retired words are found where people read, and the list of those that are left only shrinks."""

import contextlib
import io
import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import words  # noqa: E402
from tree import File  # noqa: E402


def findings(path, content, left=None):
    """The findings in `path`: "line: what; mend" each."""
    file = File(path, content)
    files = [file] if left is None else [file, File(words.LEFT, left)]
    return [f"{found.line}: {found.what}; {found.mend}" for found in words.check(file, files)]


class Words(unittest.TestCase):
    def assert_found(self, path, content, *expected):
        """`expected`: (line, word) of each finding."""
        found = [(number, word) for number, word, _ in words.found(File(path, content))]
        self.assertEqual(found, list(expected), content)

    def test_in_markdown(self):
        self.assertEqual(findings("docs/a.md", "fine\nThe axis is at rest.\n"),
                         ['2: "at rest" is retired; say "stationary" (GLOSSARY.md)'])

    def test_on_two_lines(self):
        self.assert_found("docs/a.md", "The axis finds its\norigin.\n", (1, "finds its origin"))
        self.assert_found("a.proto", "// It comes to\n  // rest.\n", (1, "comes to rest"))
        self.assert_found("a.toml", "# It finds its\n# origin.\n", (1, "finds its origin"))
        self.assert_found("device/a.cc", 'f("It finds its "\n  "origin");\n', (1, "finds its origin"))

    def test_every_retired_word_is_found_and_none_within_another(self):
        for word in ("left-over", "leftovers", "tells another", "borne out", "reckoned", "owed", "keeps an eye", "he",
                     "Whoever", "set going", "asked for", "given up"):
            self.assert_found("docs/a.md", f"It {word}, or\n", (1, word))
        for word in ("powed", "the", "this", "tasked for", "forested", "newsletter", "stellst"):
            self.assert_found("docs/a.md", f"It {word}, or\n")

    def test_what_a_program_prints_is_not_judged_in_markdown(self):
        self.assert_found("docs/a.md", "```\nat rest\n```\nIt is at rest.\n", (4, "at rest"))
        self.assert_found("docs/a.md", "~~~text\nat rest\n~~~\n")
        self.assert_found("docs/a.md", "Text:\n\n    at rest\n\n    at rest\nat rest\n", (6, "at rest"))
        self.assert_found("docs/a.md", "See `news.cc`.\n")
        self.assert_found("docs/a.md", "- a list\n    at rest\n", (2, "at rest"))

    def test_in_a_literal(self):
        self.assert_found("clients/a.cc", 'print("at rest");\n', (1, "at rest"))
        self.assert_found("server/a.cc", 'f(R"(one\nat rest)");\n', (2, "at rest"))

    def test_in_an_identifier(self):
        self.assert_found("device/a.h", "int pay_speeds();\nint owed_;\n", (1, "pay_speeds"), (2, "owed"))

    def test_comments_of_code_are_not_judged(self):
        self.assert_found("device/a.cc", "// It is at rest.\nint a;  /* owed */\n")

    def test_paths_of_includes_are_not_judged(self):
        self.assert_found("device/a.cc", '#include "device/news.h"\n')

    def test_other_files_are_not_judged(self):
        for path in ("tests/unit/a.cc", "tests/a.py", "GLOSSARY.md", "a.txt"):
            self.assertEqual(findings(path, 'f("at rest");\n'), [], path)

    def test_names_of_the_interface_stay(self):
        self.assert_found("a.proto", "oneof news {\n")

    def test_an_allowance_holds(self):
        self.assertEqual(findings("docs/a.md", "at rest, owed\n", "docs/a.md 2\n"), [])

    def test_more_than_allowed(self):
        found = findings("docs/a.md", "at rest\nowed\n", "docs/a.md 1\n")
        self.assertEqual(len(found), 2)
        self.assertIn("2 here and 1 allowed", found[0])

    def test_fewer_than_allowed(self):
        for content, count in (("at rest\n", 1), ("fine\n", 0)):
            found = findings("docs/a.md", content, "docs/a.md 2\n")
            self.assertEqual(len(found), 1)
            self.assertTrue(found[0].endswith(f"; lower the count of docs/a.md in words_left.txt to {count}"), found)

    def test_the_list_names_files_that_are_there(self):
        left = File(words.LEFT, "docs/a.md 1\ndocs/gone.md 2\ndocs/a.md 0\nnonsense\n")
        found = [finding.line for finding in words.check(left, [File("docs/a.md", ""), left])]
        self.assertEqual(found, [2, 3, 4])

    def test_without_an_order_it_explains_itself(self):
        with contextlib.redirect_stderr(io.StringIO()) as errors:
            self.assertEqual(words.main([]), 2)
        self.assertIn("--count", errors.getvalue())


if __name__ == "__main__":
    unittest.main()

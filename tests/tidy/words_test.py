"""Retired words are found where people read."""

import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import words  # noqa: E402
from tree import File  # noqa: E402


def findings(path, content):
    """The findings in `path`: "line: what; mend" each."""
    file = File(path, content)
    return [f"{found.line}: {found.what}; {found.mend}" for found in words.check(file, [file])]


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

    def test_in_a_comment(self):
        for folder in ("device", "server", "clients", "tests/unit"):
            self.assert_found(f"{folder}/a.cc", "// It is at rest.\nint a;  /* owed */\n", (1, "at rest"), (2, "owed"))

    def test_in_a_comment_of_several_lines(self):
        self.assert_found("tests/a.cc", "// It finds its\n// origin.\n", (1, "finds its origin"))
        self.assert_found("tests/a.cc", "/* It finds its\n * origin. */\n", (1, "finds its origin"))
        self.assert_found("tests/a.cc", "  int a;  // it finds its\n          // origin\n", (1, "finds its origin"))

    def test_words_of_two_comments_do_not_belong_together(self):
        self.assert_found("tests/a.cc", "int a;  // as it is\nint b;  // told\n", (2, "told"))
        self.assert_found("tests/a.cc", "int a;  // at\nint b;  // rest\n")

    def test_quoted_data_in_a_comment_is_not_judged(self):
        for mark in "`\"":
            self.assert_found("device/a.cc", f"// Calls {mark}owed{mark}, then news.\n", (1, "news"))
            self.assert_found("device/a.cc", f"// Prints {mark}it was\n// owed{mark}.\n")
            self.assert_found("device/a.cc", f"int a;  // 5{mark}\nint b;  // owed\nint c;  // 5{mark}\n", (2, "owed"))
            self.assert_found("device/a.cc", f"// 5{mark}\n\n// owed\n\n// 5{mark}\n", (3, "owed"))

    def test_names_and_literals_of_tests_are_not_judged(self):
        self.assert_found("tests/unit/a.cc", 'int owed_ = f("at rest // news");  // plain\n')

    def test_paths_of_includes_are_not_judged(self):
        self.assert_found("device/a.cc", '#include "device/news.h"\n')

    def test_other_files_are_not_judged(self):
        for path in ("tests/unit/a.cc", "tests/a.py", "GLOSSARY.md", "a.txt"):
            self.assertEqual(findings(path, 'f("at rest");\n'), [], path)


if __name__ == "__main__":
    unittest.main()

"""What is drawn as a mutation and what is not, and what becomes of it when a test program runs."""

import itertools
import pathlib
import sys
import tempfile
import textwrap
import unittest

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parents[1]
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import drawing  # noqa: E402
import equivalents  # noqa: E402
import results  # noqa: E402
import sites  # noqa: E402
import trials  # noqa: E402

BODY = "int f() {{\n  {}\n}}\n"


def mutants(code, *kinds):
    """What a line in a function becomes, by each mutation of these kinds."""
    source = BODY.format(code)
    found = [mutation for mutation in sites.mutations("device/core/a.cc", source) if mutation.kind in kinds]
    return [mutation.applied(source).split("\n", 1)[1].rsplit("\n}", 1)[0].strip() for mutation in found]


class Kinds(unittest.TestCase):
    def test_each_comparison_takes_in_or_leaves_out_what_is_equal(self):
        for before, after in [("<", "<="), ("<=", "<"), (">", ">="), (">=", ">"), ("==", "!="), ("!=", "==")]:
            self.assertEqual(mutants(f"x = a {before} b;", "comparison"), [f"x = a {after} b;"])
        self.assertEqual(mutants("x = a <=> b;", "comparison"), [])

    def test_angle_brackets_and_arrows_are_no_comparisons(self):
        for code in ["std::vector<int> a(std::max<long>(b, c));", "a->b();", "template <typename T> void g();",
                     "auto g() -> int;", "bool operator<(const A&);", "bool operator==(const A&) const = default;"]:
            self.assertEqual(mutants(code, "comparison", "arithmetic"), [], code)

    def test_numbers_become_their_neighbours(self):
        for before, after in [("8", ["9", "7"]), ("0", ["1"]), ("0x0F", ["0x10", "0x0e"]), ("2U", ["3U", "1U"]),
                              ("999'999", ["1'000'000", "999'998"])]:
            self.assertCountEqual(mutants(f"x = {before};", "plus-one", "minus-one"), [f"x = {n};" for n in after])

    def test_what_only_looks_like_an_integer_stays(self):
        for code in ["x = 1.5;", "x = 1e9;", "x = .5;", "x1 = a2b;", "virtual int g() const = 0;", "x = 007;"]:
            self.assertEqual(mutants(code, "plus-one", "minus-one"), [], code)

    def test_conditions_are_negated(self):
        self.assertEqual(mutants("if (a && b(c)) g();", "negated"), ["if (!(a && b(c))) g();"])
        self.assertEqual(mutants("while (a < b) g();", "negated"), ["while (!(a < b)) g();"])
        self.assertEqual(mutants("if (auto a = b(); a) g();", "negated"), ["if (auto a = b(); !(a)) g();"])
        self.assertEqual(mutants("x = !a && !b();", "not-dropped"), ["x = a && !b();", "x = !a && b();"])

    def test_what_is_no_expression_is_not_negated(self):
        for code in ["if (const auto a = b()) g();", "while (true) g();", "if constexpr (a) g();"]:
            self.assertEqual(mutants(code, "negated"), [], code)

    def test_the_same_negation_is_drawn_once(self):
        self.assertEqual(mutants("if (!a) g();", "negated", "not-dropped"), ["if (a) g();"])
        self.assertEqual(mutants("if (a == b) g();", "negated", "comparison"), ["if (a != b) g();"])
        self.assertEqual(len(mutants("if (!a || b) g();", "negated", "not-dropped")), 2)

    def test_and_becomes_or(self):
        self.assertEqual(mutants("return a && b;", "logic"), ["return a || b;"])
        self.assertEqual(mutants("x = (a || b) == c;", "logic"), ["x = (a && b) == c;"])
        self.assertEqual(mutants("void g(A&& a, auto&& b);", "logic"), [])

    def test_other_operands_keep_their_meaning(self):
        self.assertEqual(mutants("return a && b(c, d) && e;", "logic"),
                         ["return a || (b(c, d) && e);", "return (a && b(c, d)) || e;"])
        self.assertEqual(mutants("x = a::b || c[1] || d ? e : f;", "logic"),
                         ["x = a::b && (c[1] || d) ? e : f;", "x = (a::b || c[1]) && d ? e : f;"])
        self.assertEqual(mutants("if (e) { g(); }\n  co_return a == b && c && !d;", "logic")[1],
                         "if (e) { g(); }\n  co_return (a == b && c) || !d;")

    def test_each_row_of_a_table_of_transitions_is_left_out(self):
        table = "constexpr auto kTable = std::to_array<Transition<S, E>>({{\n{}}});\nauto other = {{{{S::a, E::b, S::c}},}};"
        rows = ["{S::a, E::b, S::c},", "{S::c, E::d, S::a},"]
        found = mutants(table.format("\n".join(rows)), "transition-dropped")
        self.assertEqual([[row in one.split(";")[0] for row in rows] for one in found], [[False, True], [True, False]])

    def test_sums_become_differences(self):
        self.assertEqual(mutants("x = a + b - c;", "arithmetic"), ["x = a - b - c;", "x = a + b + c;"])
        self.assertEqual(mutants("x += a;", "arithmetic"), ["x -= a;"])
        for code in ['x = a + "b";', 'x = "b" + a;', "x = -a;", "++x;", "x = y ? -1 : +1;"]:
            self.assertEqual(mutants(code, "arithmetic"), [], code)

    def test_returned_truths_are_flipped(self):
        self.assertEqual(mutants("return true;", "returned"), ["return false;"])
        self.assertEqual(mutants("co_return false;", "returned"), ["co_return true;"])
        self.assertEqual(mutants("x = true;", "returned"), [])

    def test_guards_return_never_or_always(self):
        for code in ["return b;", "co_return;", "{\n    return b;\n  }"]:
            self.assertEqual(mutants(f"if (a || c) {code}", "guard-never", "guard-always"),
                             [f"if ((a || c) || true) {code}", f"if ((a || c) && false) {code}"])
        for code in ["if (a) b();", "while (a) return;", "if (a) { b(); return; }"]:
            self.assertEqual(mutants(code, "guard-never", "guard-always"), [], code)


class LeftAlone(unittest.TestCase):
    def assert_untouched(self, source):
        self.assertEqual([m.id for m in sites.mutations("device/core/a.cc", source)], [], source)

    def test_comments_and_literals(self):
        self.assert_untouched('// if (a < 1) return true;\n/* a && b + 2 */ auto c = "x < 3 && y";\n')
        self.assert_untouched("auto a = '1', b = ' ';\nauto c = R\"(if (a < 1) return true;)\";\n")

    def test_preprocessor_and_static_assert(self):
        self.assert_untouched("#if A > 1 && B\n#define C(x) \\\n  ((x) + 1)\n#endif\n#include <a/b1.h>\n")
        self.assert_untouched('static_assert(a.size() == static_cast<int>(b) + 1 &&\n              c < 2, "d");\n')

    def test_the_argument_of_guarded(self):
        found = sites.mutations("device/core/a.cc", BODY.format("if (guarded(Guard::x) && a > 2) g();"))
        self.assertEqual({m.kind for m in found}, {"negated", "logic", "comparison", "plus-one", "minus-one"})
        self.assert_untouched("bool a = guarded(Guard(1 + 2));\n")

    def test_lines_that_only_log(self):
        self.assert_untouched("  spdlog::info(a + 1);\n  log_.warn(b < 2);\n  impl->logger.error(!c);\n")

    def test_files_that_are_no_product(self):
        for path in ["device/core/task.h", "device/shot/line/line.cc", "device/rml1/machine/clip.cc", "server/access/roles.cc"]:
            self.assertTrue(drawing.is_mutated(path), path)
        for path in ["device/shrc203/simulator/pool.cc", "device/core/guard.h", "device/link/tcp.cc",
                     "server/config.cc", "device/shrc203/README.md", "tests/unit/a_test.cc"]:
            self.assertFalse(drawing.is_mutated(path), path)


class Names(unittest.TestCase):
    SOURCE = "// ü\nbool f(int a) {\n  return a < 3;  // why\n}\n"

    def test_a_mutation_tells_its_place_and_its_change(self):
        first = sites.mutations("device/core/a.cc", self.SOURCE)[0]
        self.assertEqual(first.id, "device/core/a.cc:3:12:comparison")
        self.assertEqual(first.description, "`<` -> `<=` in `return a < 3;  // why`")
        self.assertEqual(first.applied(self.SOURCE), self.SOURCE.replace("<", "<="))

    def test_a_description_is_one_line(self):
        found = sites.mutations("device/core/a.cc", BODY.format("if (a &&\n      b) return;"))
        self.assertTrue(found)
        self.assertFalse([m.description for m in found if "\n" in m.description])

    def test_one_is_found_by_its_name(self):
        sources = {"device/core/a.cc": self.SOURCE}
        self.assertEqual(drawing.named(sources, "device/core/a.cc:3:14:plus-one").after, "4")
        for wrong in ["device/core/a.cc:3:15:plus-one", "device/core/b.cc:3:14:plus-one", "nothing"]:
            with self.assertRaises(drawing.CannotRun):
                drawing.named(sources, wrong)


class Drawing(unittest.TestCase):
    SOURCES = {"device/core/long.cc": "int a() {\n" + "  b(1);\n" * 300 + "}\n",
               "device/core/short.cc": "int a() {\n" + "  b(1);\n" * 100 + "}\n",
               "device/core/words.cc": "// only words: 1 + 1\n"}

    def drawn(self, seed, count=None):
        return [m.id for m in itertools.islice(drawing.drawn(self.SOURCES, seed), count)]

    def test_a_seed_draws_the_same_again_and_another_does_not(self):
        self.assertEqual(self.drawn(5), self.drawn(5))
        self.assertNotEqual(self.drawn(5, 20), self.drawn(6, 20))
        self.assertEqual(self.drawn(5, 20), self.drawn(5)[:20])

    def test_each_is_drawn_once(self):
        everything = self.drawn(1)
        self.assertEqual(len(everything), 2 * 400)
        self.assertEqual(len(set(everything)), len(everything))

    def test_files_share_by_their_lines(self):
        long = sum(name.startswith("device/core/long.cc") for name in self.drawn(1, 200))
        self.assertTrue(130 <= long <= 170, long)

    def test_the_tree_has_all_kinds_and_no_name_twice(self):
        found = [mutation for folder in drawing.FOLDERS for file in sorted((PROJECT / folder).rglob("*"))
                 if drawing.is_mutated(path := file.relative_to(PROJECT).as_posix())
                 for mutation in sites.mutations(path, file.read_text(encoding="utf-8"))]
        self.assertGreater(len(found), 1000)
        self.assertEqual(len({mutation.id for mutation in found}), len(found))
        self.assertEqual(len({mutation.kind for mutation in found}), 11)
        stale = [entry for entry in equivalents.load() if not any(map(entry.is_of, found))]
        self.assertEqual(stale, [], "entries of equivalent.txt that are of no mutation")


class Equivalents(unittest.TestCase):
    ENTRY = "# why\n\n{}\n    return a < 3;\n    it is never\n    called with 3\n"

    def test_an_entry_holds_wherever_its_line_is(self):
        (entry,) = equivalents.parse(self.ENTRY.format("device/core/a.cc:90:12:comparison"))
        self.assertEqual(entry.reason, "it is never called with 3")
        source = "bool f(int a) {\n  return a < 3;  // a comment\n}\nbool g(int b) {\n  return b < 3;\n}\n"
        held = [m.id for m in sites.mutations("device/core/a.cc", source) if entry.is_of(m)]
        self.assertEqual(held, ["device/core/a.cc:2:12:comparison"])

    def test_an_entry_without_reason_is_refused(self):
        for wrong in ["device/core/a.cc:1:1:logic\na && b\n", "device/core/a.cc:logic\na && b\nwhy\n"]:
            with self.assertRaises(drawing.CannotRun):
                equivalents.parse(wrong)


class Results(unittest.TestCase):
    SOURCE = Names.SOURCE

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "results.jsonl"
        self.killed, self.survived = sites.mutations("device/core/a.cc", self.SOURCE)[:2]
        kept = results.Results(self.file, "one")
        kept.add(self.killed, self.SOURCE, {"verdict": "killed", "by": "unit_tests", "test": "A.B", "how": "crashed"})
        kept.add(self.survived, self.SOURCE, {"verdict": "survived"})

    def test_a_later_run_knows_them(self):
        kept = results.Results(self.file, "one")
        self.assertEqual(results.told(kept.of(self.killed, self.SOURCE)), "killed by unit_tests A.B (crashed)")
        self.assertEqual(results.told(kept.of(self.survived, self.SOURCE)), "SURVIVED")

    def test_survivors_are_tried_again_when_tests_may_have_come(self):
        kept = results.Results(self.file, "two")
        self.assertIsNotNone(kept.of(self.killed, self.SOURCE))
        self.assertIsNone(kept.of(self.survived, self.SOURCE))

    def test_another_source_makes_another_mutation(self):
        self.assertIsNone(results.Results(self.file, "one").of(self.killed, self.SOURCE + "\n"))

    def test_half_a_line_spoils_no_other(self):
        with self.file.open("a") as out:
            out.write('{"id": "dev')
        results.Results(self.file, "one").add(self.survived, self.SOURCE, {"verdict": "not compiled"})
        kept = results.Results(self.file, "one")
        self.assertEqual(kept.of(self.survived, self.SOURCE)["verdict"], "not compiled")
        self.assertEqual(kept.of(self.killed, self.SOURCE)["verdict"], "killed")


class Trials(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def program(self, body, name="unit_tests"):
        """A test program in shell that prints as GoogleTest does."""
        file = self.folder / name
        file.write_text("#!/bin/sh\n" + textwrap.dedent(body), encoding="utf-8")
        file.chmod(0o755)
        return file

    def test_all_shards_pass(self):
        self.assertIsNone(trials.run(self.program('echo "[  PASSED  ] 3 tests."\n'), 10))

    def test_one_shard_fails_and_stops_the_other(self):
        program = self.program("""
            echo "[ RUN      ] A.B/0"
            [ "$GTEST_SHARD_INDEX" = 1 ] || sleep 60
            echo "[  FAILED  ] A.B/0, where GetParam() = 0 (3 ms)"
            exit 1
            """)
        self.assertEqual(trials.run(program, 30), trials.Failure("A.B/0", "failed"))

    def test_a_crash_and_an_early_end_are_failures(self):
        for end in ["kill -9 $$", "exit 0"]:
            program = self.program(f'echo "[ RUN      ] A.B"\n{end}\n')
            self.assertEqual(trials.run(program, 10), trials.Failure("A.B", "crashed"))

    def test_a_hang_ends_at_the_time_limit(self):
        program = self.program('echo "[ RUN      ] A.B"\nsleep 60\n')
        self.assertEqual(trials.judge(program, 0.5), trials.Failure("A.B", "time limit"))

    def test_what_fails_only_once_does_not_count(self):
        program = self.program(f"""
            if mkdir "{self.folder}/once" 2> /dev/null; then
              echo "[  FAILED  ] A.B (3 ms)"
              exit 1
            fi
            echo "[  PASSED  ] 1 test."
            """)
        self.assertIsNone(trials.judge(program, 10))

    def test_guards_are_spread_by_their_names(self):
        program = self.program("""
            case "$*" in
            *list_tests*) printf 'Guards/Removed.\\n  IsMissed/a  # GetParam() = a\\n  IsMissed/b\\n' ;;
            *IsMissed/a*IsMissed/b*) exit 1 ;;
            *IsMissed/a) [ -z "$GTEST_TOTAL_SHARDS" ] && echo "[  PASSED  ] 1 test." ;;
            *IsMissed/b) printf '[  FAILED  ] Inner.One (1 ms)\\n[  FAILED  ] Guards/Removed.IsMissed/b\\n'; exit 1 ;;
            esac
            """, "guards_tests")
        self.assertEqual(trials.run(program, 10), trials.Failure("Guards/Removed.IsMissed/b", "failed"))


if __name__ == "__main__":
    unittest.main()

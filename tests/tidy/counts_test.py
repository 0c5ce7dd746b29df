"""Each figure of counts is shown on a small tree of which it is known."""

import contextlib
import importlib.machinery
import importlib.util
import io
import json
import pathlib
import sys
import tempfile
import types
import unittest

HERE = pathlib.Path(__file__).resolve().parent


def load_program():
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(HERE))
    loader = importlib.machinery.SourceFileLoader("counts", str(HERE / "counts"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("counts", loader))
    loader.exec_module(module)
    return module


COUNTS = load_program()


def run_counts(*arguments):
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as errors:
        code = COUNTS.main([str(argument) for argument in arguments])
    return types.SimpleNamespace(returncode=code, stdout=out.getvalue(), stderr=errors.getvalue())


class Tree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def write(self, path, content=""):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(content, encoding="utf-8")

    def figures(self):
        run = run_counts("--json", self.root)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def assert_figure(self, name, value, detail=None):
        figure = self.figures()[name]
        self.assertEqual(figure["value"], value, f"{name}: {figure}")
        if detail is not None:
            self.assertEqual(figure["detail"], detail, name)


class LargestClasses(Tree):
    def functions_of(self, body):
        self.write("device/a.h", f"namespace a {{\nclass A : public B<int> {{\n{body}\n}};\n}}\n")
        return self.figures()["most_functions"]["value"]

    def members_of(self, body):
        self.write("device/a.h", f"namespace a {{\nclass A final : public B {{\n{body}\n}};\n}}\n")
        return self.figures()["most_data_members"]["value"]

    def test_what_a_class_declares_as_a_function(self):
        for body in (
            "int run();", "public:\n  A() = default;", "~A() override;", "A() : a_(1), b_{2} { if (c) { d(); } }",
            "int run() const { return b({1}); }", "void run(int a = 1, B b = {});", "virtual void run() = 0;",
            "template <class T, class U = B<int>>\n  void run(T t) { t(); }",
            "bool operator==(const A&) const = default;",
            "auto operator<=>(const A&) const = default;", "[[nodiscard]] auto run() -> std::map<int, int>;",
            "static A of(int axis) { return A(axis); }", "std::function<void(int)> run();",
            "void run();  // and void walk();", "struct B run();",
        ):
            self.assertEqual(self.functions_of(body), 1, body)
            self.assertEqual(self.functions_of(body + "\n  void other();"), 2, body)

    def test_what_is_no_function_of_the_class(self):
        for body in (
            "int a_ = run();", "int a_{run()};", "static constexpr Duration kA = seconds(1);", "using A = B(int);",
            "friend bool operator==(A, A) { return true; }", "friend void run(A);", "enum class B { a, b };",
            "struct B { void run(); int c(); };", "class B;", "std::function<void(int)> a_;",
            "std::function<void()> a_{[] { run(); }};", "void (*a_)(int) = nullptr;", "alignas(64) int a_;",
            'static_assert(sizeof(B) == 1, "b");',
        ):
            self.assertEqual(self.functions_of(body + "\n  void a();\n  void b();"), 2, body)

    def test_the_data_members_that_end_in_an_underscore(self):
        for body, members in (
            ("int a_;", 1), ("int a_ = 1, *b_{}, c_[2];", 3), ("std::map<int, std::pair<int, B>> a_{{1, {2, b}}};", 1),
            ("prometheus::Counter& a_;", 1), ("std::function<void(int a_, int b_)> c_;", 1), ("unsigned a_ : 3;", 1),
            ("struct { int a; } b_;", 1), ("struct C { int a; };\n  C c_;", 1), ("void (*a_)(int) = nullptr;", 1),
            ("int a_ = run(b_, c_);", 1), ("std::function<void()> a_ = [] { run(); };\n  int b_;", 2),
            ("int a;", 0), ("static inline int a_ = 0;", 0), ("int run(int a_);", 0), ("using a_ = int;", 0),
            ("void run() { int a_; }", 0), ("// int a_;", 0), ("class B_;\n  enum class C_ : int;", 0),
        ):
            self.assertEqual(self.members_of(body), members, body)

    def test_the_largest_are_named(self):
        impl = "class Controller::Impl : public B {\n  void a();\n  void b();\n  int c_;\n};\n"
        self.write("device/shrc203/a.h", impl)
        self.write("server/b.cc", "struct B {\n  void a();\n  int c_, d_;\n  class D { void a(), b(); };\n};\n")
        self.write("clients/c.h", "class C {\n  void a();\n  void b();\n  void c();\n  int d_, e_, f_;\n};\n")
        self.assert_figure("most_functions", 2, "Controller::Impl in device/shrc203/a.h, 1 data members")
        self.assert_figure("most_data_members", 2, "B in server/b.cc")

    def test_a_nested_class_may_be_the_largest(self):
        self.write("device/a.h", "class A {\n  void a();\n  struct B {\n    void a();\n    void b();\n  };\n};\n")
        self.assert_figure("most_functions", 2, "A::B in device/a.h, 0 data members")


class Folders(Tree):
    def test_the_fullest_folder(self):
        for path in ("device/a/1.h", "device/a/b/1.h", "device/a/b/2.h", "device/a/c/1.h", "server/1.h", "server/2.h",
                     "tests/1.h", "tests/2.h", "tests/3.h", "tests/4.h"):
            self.write(path)
        self.assert_figure("fullest_folder", 3, "device/a/")
        for number in range(4):
            self.write(f"clients/x/{number}.py")
        self.assert_figure("fullest_folder", 4, "clients/x/")

    def test_files_of_the_server_that_name_the_controller(self):
        self.write("server/a.cc", '#include "device/shrc203/a.h"\n')
        self.write("server/rpc/README.md", "see shrc203\n")
        self.write("server/b.cc", "// SHRC203 and shrc-203\n")
        self.write("device/b.cc", "// shrc203\n")
        self.assert_figure("server_files_naming_shrc203", 2, "of 3 files")
        self.assert_figure("server_files", 3)


class CommandLiterals(Tree):
    def count(self, text, path="device/shrc203/a.cc"):
        self.write(path, f"void a() {{\n  {text}\n}}\n")
        return self.figures()["command_literals"]["value"]

    def test_what_looks_like_a_command(self):
        for text in ("D:", "?:MODE", "!:S", "!:", "GC:", "MS:ON", "*IDN?", "EP:3", "?:CMD\\r\\n", "PIT:GET,3"):
            self.assertEqual(self.count(f'b("{text}");'), 1, text)
        self.assertEqual(self.count('model().row("G"); model().make("G", c); b("G");'), 2)
        self.assertEqual(self.count('b(c ? "D:" : "J:", "say \\"D:\\"");'), 2)

    def test_what_does_not(self):
        for text in ('b("P:U1 lets a program go on");', 'b("see D:");', 'b("LONGER:A");', 'b("d:"); // "D:"',
                     'b("?:");', "b(':', '\"'); c(D::E);", 'b("HOST,PROGRAM");', '/* "D:" */', "make_command(name);",
                     'b("1D:");'):
            self.assertEqual(self.count(text), 0, text)

    def test_where_they_are_counted(self):
        for path, number in (
            ("device/shrc203/stop.cc", 1), ("device/shrc203/session/stop.h", 1), ("server/rpc/a.cc", 1),
            ("device/shrc203/simulator/a.cc", 0), ("device/shrc203/command/a.cc", 0), ("device/shrc203/rows_a.cc", 0),
            ("device/shrc203/command_table.cc", 0), ("device/shrc203/codec.h", 0), ("device/rml1/a.cc", 0),
            ("server/README.md", 0), ("device/shrc203/session/codec.cc", 1),
        ):
            self.assertEqual(self.count('b("D:");', path), number, path)
            (self.root / path).unlink()
            self.write("README.md")

    def test_in_how_many_files(self):
        self.count('b("D:", "J:");')
        self.count('b("D:");', "server/a.cc")
        self.assert_figure("command_literals", 3, "1 of them in server/")
        self.assert_figure("command_literal_files", 2, "most in device/shrc203/a.cc 2, server/a.cc 1")


class MotionFlags(Tree):
    def flags(self, members, before="", name="LiveMotion"):
        self.write("device/shrc203/a.h", f"{before}\nstruct {name} {{\n  {members}\n}};\n")
        figure = self.figures()["motion_flags"]
        listed = figure["detail"].split(", ") if figure["detail"] else []
        self.assertEqual(figure["value"], len(listed))
        return listed

    def test_flags_of_the_record_itself(self):
        for member in ("bool a = false;", "std::optional<bool> a;", "std::optional<TimePoint> a{};",
                       "std::optional<axisgate::Problem> a;", "Two a = Two::x;", "std::optional<Two> a;", "Inner a{};",
                       "std::map<int, bool> a;", "std::atomic<bool> a{true};"):
            before = "enum class Two { x, y };\n"
            self.assertEqual(self.flags(f"enum class Inner : int {{ x = 1, y, }};\n  {member}", before),
                             ["LiveMotion.a"], member)
        self.assertEqual(self.flags("bool a = false, b = true;"), ["LiveMotion.a", "LiveMotion.b"])

    def test_what_is_no_flag(self):
        for member in ("int a;", "TimePoint a;", "Problem a;", "std::optional<int> a;", "Three a;", "bool& a;",
                       "bool* a;", "bool a() const;", "static constexpr bool a = true;", "std::function<bool(bool)> a;",
                       "Other::Two a;", "std::vector<TimePoint> a;"):
            before = "enum class Three { x, y, z };\nstruct Other { enum class Two { x, y, z }; };\n"
            before += "enum Two { x, y };\n"
            self.assertEqual(self.flags(member, before), [], member)

    def test_what_it_holds_counts_too(self):
        before = "struct B {\n  bool b;\n};\n"
        for member in ("B a;", "std::optional<B> a;", "std::vector<shrc203::B> a;", "std::deque<B> a;", "C a;",
                       "std::variant<int, B> a;", "std::shared_ptr<B> a;", "std::unique_ptr<const B> a;", "Ptr a;"):
            more = "struct C : public shrc203::B {};\nusing Ptr = std::shared_ptr<B>;\n"
            self.assertEqual(self.flags(member, before + more), ["B.b"], member)
        self.assertEqual(self.flags("B a, c;\n  std::optional<B> d;", before), ["B.b"], "each place once")
        self.assertEqual(self.flags("B& a;\n  B* c;\n  std::function<B()> d;", before), [])

    def test_what_is_nested_and_what_lies_elsewhere(self):
        nested = "struct B {\n    bool inner;\n  };\n  std::deque<B> a;\n  C c;"
        self.write("device/core/c.h", "struct C {\n  bool far;\n};\nstruct B {\n  bool outer;\n};\n")
        self.write("device/shrc203/simulator/c.h", "struct C {\n  bool simulated;\n};\n")
        self.assertEqual(self.flags(nested), ["LiveMotion::B.inner", "C.far"])

    def test_where_names_meet_that_of_the_controllers_header_is_meant(self):
        for path in ("device/a/c.h", "device/shrc203/c.cc", "device/zeta/c.h"):
            self.write(path, "struct B {\n  bool other;\n};\n")
        self.assertEqual(self.flags("B a;", "struct B {\n  bool b;\n};\n"), ["B.b"])

    def test_the_record_under_its_other_name(self):
        self.assertEqual(self.flags("bool a;", name="MotionRecord"), ["MotionRecord.a"])

    def test_no_record_is_not_no_flag(self):
        self.write("device/shrc203/a.h", "struct Another {\n  bool a;\n};\n")
        self.assert_figure("motion_flags", None)
        self.assertIn("motion_flags: not found (", run_counts(self.root).stdout)


class LargestContext(Tree):
    def test_impl(self):
        self.write("device/shrc203/a.h", "class Controller::Impl {\n  int a_, b_, c_;\n  void run();\n};\n")
        self.write("device/shrc203/b.h", "struct RequestContext {\n  int a, b;\n};\n")
        self.write("device/shrc203/c.cc", "void Controller::Impl::run() {}\n")
        self.write("device/shrc203/deep/d.cc", "void run() { impl_.run(); }\n")
        self.write("device/shrc203/e.cc", "// Controller::Impl::run\nvoid e(RequestContext);\n")
        self.write("device/shrc203/simulator/e.cc", "void e() { impl_.run(); }\n")
        self.write("device/shrc203/e.h", "inline void e() { impl_.run(); }\n")
        self.assert_figure("largest_context_members", 3, "Controller::Impl in device/shrc203/a.h")
        self.assert_figure("largest_context_files", 2)

    def test_without_impl(self):
        self.write("device/shrc203/b.h", "struct RequestContext {\n  int a, b;\n};\n")
        self.write("device/shrc203/e.h", "struct Contextual {\n  int a, b, c;\n};\n")
        self.write("device/shrc203/c.cc", "void run(const RequestContext& c) {}\nvoid run(RequestContext c) {}\n")
        self.write("device/shrc203/d.cc", "void run(const OtherRequestContext& c) {}\n")
        self.write("device/core/b.h", "struct OtherContext {\n  int a, b, c;\n};\n")
        self.assert_figure("largest_context_members", 2, "RequestContext in device/shrc203/b.h")
        self.assert_figure("largest_context_files", 1)


class Occurrences(Tree):
    def assert_count(self, name, text, count, path="device/shrc203/a.cc"):
        self.write(path, text)
        self.assert_figure(name, count)
        (self.root / path).unlink()

    def test_writes_of_the_links_state(self):
        for text in ("state_.link = LinkState::up;", "impl_->state_.link = now;", "state->link = b;", "state.link=b;",
                     "state_ = LinkState::down;", "link_ = LinkState::down;", "state_ = a ? LinkState::up : b;",
                     "state_ =\n    LinkState::down;"):
            self.assert_count("link_state_writes", text, 1)
            self.assert_count("link_state_writes", f"{text}\n{text}", 2, "device/shot/line/a.cc")
            self.assert_count("link_state_writes", text, 1, "device/shrc203/a.h")
            for path in ("device/shrc203/simulator/a.cc", "server/a.cc"):
                self.assert_count("link_state_writes", text, 0, path)
        for text in ("if (state_.link == LinkState::up) a();", "a = state_.link;", "state_ = a; b(LinkState::up);",
                     "other_state.link = a;", "// state_.link = a;", "state_.link_problem = a;",
                     "state_ == LinkState::up;"):
            self.assert_count("link_state_writes", text, 0)

    def test_rows_that_end_in_three_empty_braces(self):
        for text in ("Problem{a, b, {}, {}, {}};", "return {a, {}, {},\n        {}};", "{{}, {}, {}, {}}"):
            self.assert_count("empty_problem_rows", text, 1)
            self.assert_count("empty_problem_rows", f"{text}\n{text}", 2, "server/rpc/a.h")
            self.assert_count("empty_problem_rows", text, 0, "clients/a.cc")
        for text in ("Problem{a, {}, {}, b};", "Problem{a, b, {}, {}};", "run({}, {}, {});", '"{},{},{}}"'):
            self.assert_count("empty_problem_rows", text, 0)

    def test_constants_of_time(self):
        self.write("device/shrc203/a.cc", "constexpr Duration kA = seconds(1), kB = milliseconds(2);\n")
        self.write("device/shrc203/b/b.h", "inline constexpr Duration kA = seconds(1);\n"
                                           "class A {\n  static constexpr Duration kB{a(1, 2)};\n};\n")
        self.write("device/shrc203/c.cc", "// constexpr Duration kA = b;\nconstexpr Duration run(int a);\n")
        self.write("device/shrc203/simulator/d.cc", "constexpr Duration kA = seconds(1);\n")
        self.write("server/e.cc", "constexpr Duration kA = seconds(1);\n")
        self.assert_figure("duration_constants", 4)
        self.assert_figure("duration_constant_files", 2)


class Program(Tree):
    def test_one_figure_a_line(self):
        self.write("server/a.cc", "// shrc203\n")
        lines = run_counts(self.root).stdout.splitlines()
        self.assertIn("server_files_naming_shrc203: 1 (of 1 files)", lines)
        self.assertEqual([line.split(":")[0] for line in lines], list(self.figures()))

    def test_code_that_does_not_balance_is_read_all_the_same(self):
        self.write("device/a.h", "class A {\n  void a();\n  void b() {\n")
        self.write("device/b.h", "}}} class B {\n  void a();\n);\n")
        self.assert_figure("most_functions", 2)

    def test_nothing_to_look_at_is_not_success(self):
        self.assertEqual(run_counts(self.root / "missing").returncode, 2)
        self.assertEqual(run_counts("--wrong").returncode, 2)
        self.assertEqual(run_counts(self.root, self.root).returncode, 2)


if __name__ == "__main__":
    unittest.main()

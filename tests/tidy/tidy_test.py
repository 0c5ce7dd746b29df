"""Each rule of tidy is shown to bite on a small tree, and to leave its lawful neighbours alone."""

import contextlib
import importlib.machinery
import importlib.util
import io
import pathlib
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parents[1]


def load_program():
    """tidy as a module: starting an interpreter for each small tree would take most of the time."""
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(HERE))
    loader = importlib.machinery.SourceFileLoader("tidy", str(HERE / "tidy"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("tidy", loader))
    loader.exec_module(module)
    return module


TIDY = load_program()


def run_tidy(root):
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as errors:
        code = TIDY.main([str(root)])
    return types.SimpleNamespace(returncode=code, stdout=out.getvalue(), stderr=errors.getvalue())


class Tree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        shutil.copy(PROJECT / ".clang-format", self.root)

    def write(self, path, content):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(content, encoding="utf-8")

    def findings(self, path, content):
        """The findings in a tree to which `path` was added: "line: rule" each."""
        self.write(path, content)
        run = run_tidy(self.root)
        lines = run.stdout.splitlines()
        self.assertEqual(run.returncode, 1 if lines else 0, run.stdout + run.stderr)
        (self.root / path).unlink()
        found = []
        for line in lines:
            where, number, rule, text = line.split(":", 3)
            self.assertEqual(where, path)
            self.assertIn("; ", text, "a finding names its mend")
            found.append(f"{number}:{rule}")
        return found

    def assert_clean(self, path, content):
        self.assertEqual(self.findings(path, content), [], path)

    def assert_include(self, path, target, *rules):
        include = target if target[0] in "<" else f'"{target}"'
        expected = [f"1: {rule}" for rule in rules]
        self.assertEqual(self.findings(path, f"#include {include}\n"), expected, f"{path} includes {include}")


class Floors(Tree):
    def test_an_include_may_not_point_up(self):
        for path, target in [
            ("device/core/a.h", "device/link/b.h"),
            ("device/core/a.h", "device/shrc203/b.h"),
            ("device/core/a.h", "server/b.h"),
            ("device/link/a.cc", "server/config/config.h"),
            ("device/shrc203/a.cc", "clients/cpp/b.h"),
            ("device/rml1/a.cc", "tests/unit/b.h"),
            ("server/a.cc", "server/rpc/b.h"),
            ("server/a.cc", "server/api/b.h"),
            ("server/devices/a.cc", "server/api/b.h"),
            ("server/api/a.cc", "server/rpc/b.h"),
            ("server/config/a.cc", "server/recording/b.h"),
            ("device/stage/a.cc", "device/shrc203/b.h"),
            ("device/shot/command/a.cc", "device/shot/line/b.h"),
            ("device/shrc203/state/a.cc", "device/shrc203/session/b.h"),
            ("device/shrc203/session/a.cc", "device/shrc203/motion/b.h"),
            ("device/shrc203/session/a.cc", "device/shrc203/controller.h"),
            ("server/events/a.cc", "server/rpc/b.h"),
            ("server/rpc/a.cc", "clients/b.h"),
            ("clients/a.cc", "tests/b.h"),
        ]:
            self.assert_include(path, target, "floors")

    def test_an_include_may_point_down_or_stay(self):
        for path, target in [
            ("device/core/a.cc", "device/core/a.h"),
            ("device/link/a.h", "device/core/b.h"),
            ("server/a.cc", "device/stage/kind.h"),
            ("device/shrc203/a.cc", "device/stage/b.h"),
            ("device/shrc203/motion/a.cc", "device/shrc203/planning/b.h"),
            ("device/shrc203/motion/a.cc", "device/shrc203/session/b.h"),
            ("server/rpc/a.cc", "server/api/b.h"),
            ("server/api/a.cc", "server/gateway.h"),
            ("server/rpc/a.cc", "server/events/b.h"),
            ("server/rpc/a.cc", "device/core/b.h"),
            ("clients/axisctl/a.cc", "device/core/b.h"),
            ("tests/unit/a.cc", "server/rpc/b.h"),
            ("tests/unit/a.cc", "tests/simulation/b.h"),
            ("device/core/a.h", "tl/expected.hpp"),
            ("device/core/a.h", "<vector>"),
        ]:
            self.assert_include(path, target)

    def test_siblings_may_not_include_each_other(self):
        self.assert_include("device/link/a.cc", "device/shrc203/b.h", "floors")
        self.assert_include("device/shrc203/a.cc", "device/link/b.h", "floors")
        self.assert_include("device/rml1/a.cc", "device/shrc203/b.h", "floors")
        self.assert_include("device/shrc203/simulator/a.cc", "device/link/b.h", "floors")
        self.assert_include("device/rml1/simulator/a.cc", "device/link/b.h", "floors")
        self.assert_include("server/events/a.cc", "server/journal/b.h", "floors")
        self.assert_include("server/events/a.cc", "server/config/config.h", "floors")

    def test_only_one_file_names_the_kinds_of_device(self):
        kinds = ("device/shrc203/kind.h", "device/rml1/kind.h", "device/rml1/language/parser.h")
        for path in ("server/gateway.cc", "server/devices/a.cc", "server/api/mill/a.cc", "server/rpc/a.cc"):
            for kind in kinds:
                self.assert_include(path, kind, "kinds")
        for kind in kinds:
            self.assert_include("server/kinds.cc", kind)

    def test_the_server_uses_stages_and_jobs(self):
        for path in ("server/config/a.h", "server/devices/a.cc", "server/api/mill/a.cc"):
            self.assert_include(path, "device/stage/kind.h")
            self.assert_include(path, "device/jobs/kind.h")
        self.assert_include("device/rml1/a.h", "device/jobs/job.h")
        self.assert_include("device/jobs/a.h", "device/use/permission.h")
        self.assert_include("device/jobs/a.h", "device/stage/event.h", "floors")
        self.assert_include("device/jobs/a.h", "device/rml1/machine/profile.h", "floors")
        self.assert_include("device/stage/a.h", "device/jobs/job.h", "floors")

    def test_those_who_wire_may(self):
        self.assert_include("device/shrc203/simulator/program/a.cc", "device/link/b.h")
        self.assert_include("device/rml1/simulator/program/a.cc", "device/link/b.h")
        self.assert_include("server/gateway.cc", "server/events/b.h")
        self.assert_include("server/axisgated.cc", "server/doors/b.h")

    def test_wiring_ends_at_the_server(self):
        self.assert_include("server/gateway.cc", "server/rpc/b.h", "floors")
        self.assert_include("server/axisgated.cc", "clients/b.h", "floors")
        self.assert_include("device/shrc203/simulator/program/a.cc", "server/b.h", "floors")

    def test_a_relative_include_is_no_way_out(self):
        self.write("device/link/b.h", "")
        self.assert_include("device/core/a.h", "../link/b.h", "floors", "rooted-include")
        self.assert_include("device/link/a.h", "b.h", "rooted-include")

    def test_a_comment_includes_nothing(self):
        self.assert_clean("device/core/a.h", '// #include "server/b.h"\n/*\n#include "server/b.h"\n*/\n')

    def test_an_include_is_found_wherever_it_stands(self):
        self.write(".clang-format", "DisableFormat: true\n")
        content = '#pragma once\n\n#ifdef FAST\n#  include "server/b.h"  // why not\n#endif\n'
        self.assertEqual(self.findings("device/core/a.h", content), ["4: floors"])


class SimulatorApart(Tree):
    def test_the_gateway_does_not_know_the_simulator(self):
        self.assert_include("device/shrc203/a.cc", "device/shrc203/simulator/options.h", "simulator-apart")

    def test_the_simulated_mill_and_the_check_do_not_know_each_other(self):
        for target in ("device/rml1/language/parser.h", "device/rml1/machine/machine.h", "device/rml1/machine/clip.h"):
            self.assert_include("device/rml1/simulator/a.cc", target, "simulator-apart")
            self.assert_include("device/rml1/simulator/program/a.cc", target, "simulator-apart")
        self.assert_include("device/rml1/a.cc", "device/rml1/simulator/machine.h", "simulator-apart")
        self.assert_include("device/rml1/model.cc", "device/rml1/simulator/machine.h")
        self.assert_include("device/rml1/simulator/a.cc", "device/rml1/machine/profile.h")
        self.assert_include("device/rml1/simulator/a.cc", "device/rml1/simulator/machine.h")

    def test_nor_through_what_they_include(self):
        self.write("device/rml1/language/dialect.h", '#pragma once\n#include "device/rml1/language/parser.h"\n')
        self.write("device/rml1/machine/profile.h", '#pragma once\n#include "device/rml1/language/dialect.h"\n')
        self.write("device/rml1/language/parser.h", "#pragma once\n")
        self.assert_include("device/rml1/simulator/a.cc", "device/rml1/machine/profile.h", "simulator-apart")

    def test_the_simulator_does_not_know_the_table(self):
        for target in ("device/shrc203/command/command_table.h", "device/shot/command/command.h"):
            self.assert_include("device/shrc203/simulator/a.cc", target, "simulator-apart")
            self.assert_include("device/shrc203/simulator/program/a.cc", target, "simulator-apart")

    def test_each_side_may_use_its_own(self):
        self.assert_include("device/shrc203/session/a.cc", "device/shrc203/command/command_table.h")
        self.assert_include("device/shrc203/simulator/a.cc", "device/shrc203/simulator/options.h")


class Libraries(Tree):
    def test_grpc_stays_in_rpc_and_protobuf_above_the_api(self):
        below = ("device/core/a.h", "device/link/a.cc", "server/a.cc", "server/gateway.cc", "server/events/a.h",
                 "server/api/a.h")
        above = ("server/rpc/a.cc", "clients/axisctl/a.cc", "tests/integration/a.cc")
        headers = ("<grpcpp/grpcpp.h>", "<grpc/status.h>", "<google/protobuf/message.h>", "axisgate/v1/stage.pb.h")
        for header in headers:
            for path in below:
                self.assert_include(path, header, "no-grpc")
            for path in above:
                self.assert_include(path, header)
        for header in headers[:2]:
            self.assert_include("server/proto/a.cc", header, "no-grpc")
        for header in headers[2:]:
            self.assert_include("server/proto/a.cc", header)

    def test_asio_stays_behind_the_link(self):
        for header in ("<boost/asio.hpp>", "<boost/asio/serial_port.hpp>"):
            for path in ("device/core/a.h", "device/shrc203/a.cc", "tests/unit/a.cc"):
                self.assert_include(path, header, "asio-in-link")
            for path in ("device/link/a.h", "server/a.cc", "clients/axisctl/a.cc"):
                self.assert_include(path, header)


class Time(Tree):
    READS = ("std::chrono::steady_clock::now()", "std::chrono::system_clock::now()", "Clock::now()", "time(nullptr)",
             "std::time(NULL)", "clock_gettime(CLOCK_MONOTONIC, &spec)", "gettimeofday(&value, nullptr)")

    def test_no_clock_is_read_below_the_shell(self):
        for read in self.READS:
            for path in ("device/core/a.cc", "device/shrc203/a.cc", "tests/simulation/a.cc"):
                self.assertEqual(self.findings(path, f"auto a = {read};\n"), ["1: time-is-injected"], read)

    def test_the_shell_may(self):
        for read in self.READS:
            for path in ("device/link/a.cc", "server/a.cc", "clients/axisctl/a.cc", "tests/bench/a.cc",
                         "tests/clock/a.cc"):
                self.assert_clean(path, f"auto a = {read};\n")

    def test_speaking_of_clocks_is_no_reading(self):
        self.assert_clean("device/core/a.cc", "// not steady_clock::now()\nMonotonicClock::time_point a;\n")
        self.assert_clean("device/core/a.cc", 'auto a = "time(nullptr)";\nauto b = R"(Clock::now())";\n')


class FileSize(Tree):
    def test_400_lines_are_enough(self):
        for path in ("server/a.cc", "server/a.h", "tests/a.py", "deploy/a.sh"):
            line = "#\n" if path.endswith(("py", "sh")) else "//\n"
            self.assert_clean(path, line * 400)
            self.assertEqual(self.findings(path, line * 401), ["401: file-size"], path)

    def test_programs_without_an_ending_count_too(self):
        for first in ("#!/usr/bin/env python3\n", "#!/bin/sh\n", "#!/usr/bin/env bash\n"):
            self.assertEqual(self.findings("deploy/a", first + "#\n" * 400), ["401: file-size"])

    def test_generated_code_and_prose_may_be_long(self):
        for path in ("clients/a.pb.cc", "clients/python/a_pb2.py", "README.md"):
            self.assert_clean(path, "//\n" * 401)


class FunctionSize(Tree):
    HEADS = ("int run() {", "std::vector<int> A::run() const noexcept {", "auto run(int a = {}) -> std::vector<int> {",
             "template <class T, class U = int>\nrequires true\nvoid run() {", "bool operator==(A, A) {",
             "TEST(Suite, Name) {", "void run(std::function<void(int)> a) {", "extern \"C\" int run() {",
             "A::A() : a_(1), b_{2}, c_{{3}} {", "A::~A() {", "auto run = [](int) {", "const auto run = [&a] {",
             "[[nodiscard]] struct B run() {", "void A::operator()(int) {")

    def body(self, lines):
        return "".join(f'  call("}}{{ {number}");\n' for number in range(lines))

    def findings_of_function(self, head, lines):
        self.write(".clang-format", "DisableFormat: true\n")
        return self.findings("server/a.cc", f"{head}\n{self.body(lines)}}};\n")

    def test_70_lines_are_enough_for_any_function(self):
        for head in self.HEADS:
            opening = head.count("\n") + 1
            self.assertEqual(self.findings_of_function(head, 70), [], head)
            self.assertEqual(self.findings_of_function(head, 71), [f"{opening}: function-size"], head)

    def test_a_function_is_found_in_namespaces_and_classes(self):
        self.write(".clang-format", "DisableFormat: true\n")
        before = "namespace a {\nclass A : public B<int> {\n public:\n  A() = default;\n  int a_{1};\n"
        content = before + "  void run() {\n" + self.body(71) + "  }\n  void other() {}\n};\n}\n"
        self.assertEqual(self.findings("server/a.cc", content), ["6: function-size"])

    def test_inner_blocks_belong_to_their_function(self):
        head = "void run() {\n  if (a) {\n  }\n  const auto b = [] { return B{1}; };\n"
        self.assertEqual(self.findings_of_function(head, 67), ["1: function-size"])

    def test_what_is_no_function_may_be_long(self):
        for head in ("namespace a {", "struct A {", "enum class A : int {", "const int a[] = {", "A a{",
                     "class A final : public B {", "extern \"C\" {"):
            self.assertEqual(self.findings_of_function(head, 71), [], head)

    def test_braces_in_text_and_comments_do_not_count(self):
        self.write(".clang-format", "DisableFormat: true\n")
        text = "void a() {\n  // {\n  /* { */ b = \"{\" R\"x({)\")x\"; c = '{'; d = 1'000;\n}\n#define E {\n"
        self.assert_clean("server/a.cc", text + "void f() {\n" + self.body(70) + "}\n")

    def test_a_lost_brace_is_told_because_it_hides_functions(self):
        self.write(".clang-format", "DisableFormat: true\n")
        self.assertEqual(self.findings("server/a.cc", "namespace a {\nvoid b() {\n"), ["2: braces"])
        self.assertEqual(self.findings("server/a.cc", "namespace a {\n}\n}\n"), ["3: braces"])
        self.assertEqual(self.findings("server/a.cc", "namespace a {\n"), ["2: braces"])


class Text(Tree):
    def test_no_path_of_a_machine(self):
        for folder in ("work", "root", "home/somebody", "Users/somebody"):
            self.assertEqual(self.findings("README.md", f"a\nsee /{folder}/x\n"), ["2: machine-path"], folder)

    def test_other_paths_are_fine(self):
        self.assert_clean("README.md", "/usr/bin/x /tmp/x https://example.org/home/a/x build/work/x ../root/x\n")

    def test_no_trailing_whitespace(self):
        for content in ("a\nb \n", "a\nb\t\n", "a\nb\r\n"):
            self.assertEqual(self.findings("deploy/a.toml", content), ["2: trailing-whitespace"])
        self.assert_clean("deploy/a.toml", "a\n\n  b\n")
        self.assert_clean("tests/fuzz/corpus/a.rml", "PA1,2;\r\n")


class Shell(Tree):
    HEAD = "#!/usr/bin/env bash\nset -euo pipefail\n"

    def test_nothing_leaves_a_pipe_early(self):
        for reader in ("head -n 1", "head", "grep -q b", "grep -Eq b", "grep -m1 b", "grep --quiet b", "sed 1q",
                       "sed -n '/b/{p;q}'", "awk '{ print $1; exit }'", "read -r line", "\\\n  head"):
            line = 4 if "\n" in reader else 3
            for path in ("deploy/a.sh", "deploy/a"):
                self.assertEqual(self.findings(path, f"{self.HEAD}cat a | {reader}\n"), [f"{line}: early-reader"], reader)

    def test_what_reads_to_the_end_may(self):
        for command in ("cat a | tail -n 1", "cat a | grep b", "cat a | sed 's/q/b/'", "a || head b", "head -n 1 a",
                        "grep -q b <<<\"$a\"", "cat a | awk '{ print $1 }'", "while read -r a; do b; done <c"):
            self.assert_clean("deploy/a.sh", f"{self.HEAD}{command}\n")
        self.assert_clean("deploy/a.sh", "#!/usr/bin/env bash\ncat a | head\n")
        self.assert_clean("docs/a.md", "set -o pipefail; cat a | head\n")


class Format(Tree):
    def test_the_code_is_formatted(self):
        for path in ("server/a.cc", "server/a.h"):
            self.assertEqual(self.findings(path, "int a;\nint  b;\n"), ["2: clang-format"])

    def test_the_format_must_be_there(self):
        (self.root / ".clang-format").unlink()
        self.write("server/a.cc", "int a;\n")
        run = run_tidy(self.root)
        self.assertEqual(run.returncode, 1)
        self.assertIn(".clang-format:1: clang-format: ", run.stdout)


class WhatIsLookedAt(Tree):
    BAD = "int  b;\n"

    def git(self, *arguments):
        subprocess.run(["git", "-C", str(self.root), *arguments], check=True, capture_output=True)

    def test_git_says_which_files(self):
        self.git("init")
        self.write(".gitignore", "build/\n")
        self.write("build/ignored.cc", self.BAD)
        self.write("server/tracked.cc", self.BAD)
        self.git("add", "server/tracked.cc")
        self.write("server/untracked.cc", self.BAD)
        self.write("server/deleted.cc", self.BAD)
        self.git("add", "server/deleted.cc")
        (self.root / "server/deleted.cc").unlink()
        named = [line.split(":")[0] for line in run_tidy(self.root).stdout.splitlines()]
        self.assertEqual(named, ["server/tracked.cc", "server/untracked.cc"])

    def test_without_git_all_but_build_trees(self):
        self.write("build/CMakeCache.txt", "")
        self.write("build/deep/generated.cc", self.BAD)
        self.write("server/a.cc", self.BAD)
        named = [line.split(":")[0] for line in run_tidy(self.root).stdout.splitlines()]
        self.assertEqual(named, ["server/a.cc"])

    def test_nothing_to_look_at_is_not_success(self):
        self.assertEqual(run_tidy(self.root / "missing").returncode, 2)
        (self.root / "empty").mkdir()
        self.assertEqual(run_tidy(self.root / "empty").returncode, 2)

    def test_without_an_argument_it_looks_at_its_own_tree(self):
        shutil.copytree(HERE, self.root / "tests/tidy", ignore=shutil.ignore_patterns("__pycache__"))
        self.write("server/a.cc", self.BAD)
        run = subprocess.run([str(self.root / "tests/tidy/tidy")], capture_output=True, text=True, check=False, cwd="/")
        self.assertEqual([line.split(":")[0] for line in run.stdout.splitlines()], ["server/a.cc"])
        self.assertEqual(run.returncode, 1)


if __name__ == "__main__":
    unittest.main()

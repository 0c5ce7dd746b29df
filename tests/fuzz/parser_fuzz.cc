// Fuzzer of the parser: it reports the same for any bytes, however they are cut into pieces.
#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>
#include <vector>

#include "device/rml1/language/parser.h"
#include "tests/fuzz/mutator.h"
#include "tests/fuzz/require.h"

namespace {

using namespace axisgate;
using namespace axisgate::rml1;
using axisgate::require;

struct Verdict {
  std::string_view name;
  jobs::Place place;
  bool first = false;
  std::uint8_t count = 0;
  std::array<bool, 4> given = {};
  std::array<double, 4> values = {};
  std::array<jobs::Place, 4> places = {};
  std::uint64_t end = 0;
  std::vector<std::tuple<char, double, bool, jobs::Place>> axes;

  friend bool operator==(const Verdict&, const Verdict&) = default;
};

class Listener : public ParserListener {
 public:
  void execute(const Instruction& instruction) override {
    Verdict one;
    one.name = instruction.row->name;
    one.place = instruction.place;
    one.first = instruction.first;
    one.count = instruction.count;
    one.end = instruction.end;
    // The entries after them are stale values from other commands.
    for (std::size_t index = 0; index < instruction.count; ++index) {
      one.given[index] = instruction.given[index];
      one.values[index] = instruction.values[index];
      one.places[index] = instruction.places[index];
    }
    for (const AxisTarget& axis : instruction.axes) {
      one.axes.emplace_back(axis.letter, axis.value, axis.point, axis.place);
    }
    told.push_back(std::move(one));
  }
  void quit() override { told.push_back({.name = "ESC.K"}); }

  std::vector<Verdict> told;
};

struct Read {
  std::vector<Verdict> told;
  std::uint64_t commands = 0;
  Diagnostics diagnostics;
};

Read read(std::string_view job, std::size_t piece) {
  Read read;
  Listener listener;
  Parser parser({{"J", "!0", "!1"}, {"YA"}}, read.diagnostics, listener);
  for (std::size_t begin = 0; begin < job.size(); begin += piece) parser.feed(job.substr(begin, piece));
  parser.finish();
  read.told = std::move(listener.told);
  read.commands = parser.commands();
  return read;
}

auto all_of(const Diagnostic& one) { return std::tie(one.number, one.severity, one.place, one.section, one.text); }

bool same(const Diagnostics& a, const Diagnostics& b) {
  for (const Severity severity : {Severity::note, Severity::warning, Severity::error}) {
    if (a.count(severity) != b.count(severity)) return false;
  }
  return std::equal(a.kept().begin(), a.kept().end(), b.kept().begin(), b.kept().end(),
                    [](const Diagnostic& one, const Diagnostic& other) { return all_of(one) == all_of(other); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view job(reinterpret_cast<const char*>(data), size);
  const Read whole = read(job, job.size() + 1);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}}) {
    const Read pieces = read(job, piece);
    require(pieces.told == whole.told && pieces.commands == whole.commands);
    require(same(pieces.diagnostics, whole.diagnostics));
  }
  return 0;
}

// Whatever the bytes and wherever they are cut, the parser tells the same.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "device/rml1/parser.h"
#include "tests/fuzz/mutator.h"

namespace {

using namespace axisgate::rml1;

class Listener : public ParserListener {
 public:
  void execute(const Instruction& instruction) override {
    told.push_back(static_cast<double>(instruction.place.offset));
    for (std::size_t index = 0; index < instruction.count; ++index) {
      if (instruction.given[index]) told.push_back(instruction.values[index]);
    }
    for (const AxisTarget& axis : instruction.axes) told.insert(told.end(), {1.0 * axis.letter, axis.value});
  }
  void quit() override { told.push_back(-1); }

  std::vector<double> told;
};

struct Read {
  std::vector<double> told;
  Diagnostics diagnostics;
};

Read read(std::string_view job, std::size_t piece) {
  Read read;
  Listener listener;
  Parser parser({{"J", "!0", "!1"}, {"YA"}}, read.diagnostics, listener);
  for (std::size_t begin = 0; begin < job.size(); begin += piece) parser.feed(job.substr(begin, piece));
  parser.finish();
  read.told = std::move(listener.told);
  return read;
}

bool same(const Diagnostics& a, const Diagnostics& b) {
  return std::equal(a.kept().begin(), a.kept().end(), b.kept().begin(), b.kept().end(),
                    [](const Diagnostic& one, const Diagnostic& other) {
                      return one.number == other.number && one.place == other.place && one.text == other.text;
                    }) &&
         a.omitted() == b.omitted();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view job(reinterpret_cast<const char*>(data), size);
  const Read whole = read(job, job.size() + 1);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}}) {
    const Read pieces = read(job, piece);
    if (pieces.told != whole.told || !same(pieces.diagnostics, whole.diagnostics)) std::abort();
  }
  return 0;
}

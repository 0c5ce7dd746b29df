#include "tests/refusals/manual.h"

#include <algorithm>
#include <stdexcept>

namespace axisgate::refusals {
namespace {

Lines way_in(Where where) {
  if (where == Where::program) return {"P:R"};
  if (where == Where::editing) return {"P:R", "P:ON"};
  if (where == Where::switches) return {"MS:ON"};
  return {};
}

Lines way_out(Where where) {
  if (where == Where::program) return {"P:H"};
  if (where == Where::editing) return {"P:OFF", "P:H"};
  if (where == Where::switches) return {"MS:OFF"};
  return {};
}

std::vector<Sentence> all() {
  std::vector<Sentence> sentences;
  for (const auto part : {questions, settings, origin_and_ways, interpolations, starts_and_speeds, inputs_and_triggers,
                          programs, memory_switches, saved_positions}) {
    for (Sentence& one : part()) sentences.push_back(std::move(one));
  }
  return sentences;
}

}  // namespace

Lines Sentence::way_there() const { return before.empty() ? way_in(where) : before; }

Lines Sentence::with(const std::string& line_instead) const {
  Lines lines = way_there();
  lines.push_back(line_instead);
  const Lines behind = before.empty() && after.empty() ? way_out(where) : after;
  lines.insert(lines.end(), behind.begin(), behind.end());
  return lines;
}

Lines Sentence::whole() const { return with(line); }

std::span<const Sentence> sentences() {
  static const std::vector<Sentence> kept = all();
  return kept;
}

const Sentence& sentence(std::string_view command) {
  const auto found = std::ranges::find(sentences(), command, &Sentence::command);
  if (found == sentences().end()) throw std::invalid_argument(std::string(command));
  return *found;
}

}  // namespace axisgate::refusals

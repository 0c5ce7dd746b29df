// What is reported about a job: the guideline's errors, and what saves a workpiece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/rml1/place.h"

namespace axisgate::rml1 {

enum class Severity { note, warning, error };
std::string_view name(Severity severity);

struct Diagnostic {
  int number = 0;  // of the guideline: 1, 2, 3, 11; 0 where it has none
  Severity severity = Severity::error;
  Place place;
  std::string_view section;  // of the guideline: "2-5"; lives as long as the program
  std::string text;
};

// The first hundred in the order of their finding, and a count of all. When they are full, an error takes the place of
// the last that is none, and the first warning or note of its kind that of the last whose kind stands there many times.
class Diagnostics {
 public:
  static constexpr std::size_t kKept = 100, kSame = 10;

  // `text` is called only for what is kept: a job may have millions. Each place in the code that reports something is a
  // kind.
  template <class Text>
  void add(int number, Severity severity, const Place& place, std::string_view section, Text&& text) {
    static constexpr char kKind = 0;
    ++counts_[static_cast<std::size_t>(severity)];
    if (severity == Severity::error ? !make_room_for_error() : !make_room_for(&kKind)) return;
    kept_.push_back({number, severity, place, section, std::string(text())});
    kinds_.push_back(&kKind);
  }
  template <class Text>
  void error(int number, const Place& place, std::string_view section, Text&& text) {
    add(number, Severity::error, place, section, std::forward<Text>(text));
  }

  const std::vector<Diagnostic>& kept() const { return kept_; }
  std::uint64_t count(Severity severity) const { return counts_[static_cast<std::size_t>(severity)]; }
  std::uint64_t omitted() const { return counts_[0] + counts_[1] + counts_[2] - kept_.size(); }

 private:
  using Kind = const void*;

  bool make_room_for_error();
  bool make_room_for(Kind kind);
  std::size_t times(Kind kind) const;
  template <class Which>
  bool drop_last(Which which);

  std::vector<Diagnostic> kept_;
  std::vector<Kind> kinds_;  // of those kept
  std::uint64_t counts_[3] = {};
};

}  // namespace axisgate::rml1

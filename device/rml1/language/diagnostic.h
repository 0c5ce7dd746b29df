// Diagnostics of a job: the guideline's errors, and warnings that save a workpiece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/jobs/place.h"
#include "device/rml1/language/warning.h"

namespace axisgate::rml1 {

enum class Severity { note, warning, error };
std::string_view name(Severity severity);

struct Diagnostic {
  int number = 0;  // number of the guideline: 1, 2, 3, 11; 0 if it has none
  Severity severity = Severity::error;
  jobs::Place place;
  std::string_view section;  // section of the guideline: "2-5"; lives as long as the program
  std::string text;
  std::optional<Warning> warning{};  // kind of a warning
};

// Keeps the first ten diagnostics of each kind in the order in which they were found, and counts all of them. Each
// place in the code that reports a diagnostic is a kind, so the number kept is limited. Not thread safe.
class Diagnostics {
 public:
  static constexpr std::uint64_t kSame = 10;

  // Diagnostics of one kind that were not kept.
  struct Omitted {
    Diagnostic first;
    std::uint64_t count = 0;
    jobs::Place last;
  };

  // `text` is called only for diagnostics that are kept, because a job may have millions.
  template <class Text>
  void error(int number, const jobs::Place& place, std::string_view section, Text&& text) {
    add(number, Severity::error, {}, place, section, text);
  }
  template <class Text>
  void warn(Warning warning, const jobs::Place& place, std::string_view section, Text&& text) {
    add(0, Severity::warning, warning, place, section, text);
  }
  template <class Text>
  void note(const jobs::Place& place, std::string_view section, Text&& text) {
    add(0, Severity::note, {}, place, section, text);
  }

  const std::vector<Diagnostic>& kept() const { return kept_; }
  // Returns the diagnostics by place in the job. At the same place, diagnostics of the whole job come first.
  std::vector<Diagnostic> in_order() const;
  std::uint64_t count(Severity severity) const { return counts_[static_cast<std::size_t>(severity)]; }
  std::uint64_t omitted_count() const { return counts_[0] + counts_[1] + counts_[2] - kept_.size(); }
  std::vector<Omitted> omitted() const;

 private:
  template <class Text>
  void add(int number, Severity severity, std::optional<Warning> warning, const jobs::Place& place,
           std::string_view section, Text&& text) {
    static constexpr char kKind = 0;
    ++counts_[static_cast<std::size_t>(severity)];
    if (keeps(&kKind, place)) kept_.push_back({number, severity, place, section, std::string(text()), warning});
  }

  struct Kind {
    const void* id;
    std::size_t first;  // index in kept_
    std::uint64_t count = 0;
    jobs::Place last;
  };

  bool keeps(const void* id, const jobs::Place& place);

  std::vector<Diagnostic> kept_;
  std::vector<Kind> kinds_;
  std::uint64_t counts_[3] = {};
};

}  // namespace axisgate::rml1

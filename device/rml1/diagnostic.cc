#include "device/rml1/diagnostic.h"

#include <algorithm>

namespace axisgate::rml1 {

std::string_view name(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      break;
  }
  return "error";
}

template <class Which>
bool Diagnostics::drop_last(Which which) {
  const auto last = std::find_if(kept_.rbegin(), kept_.rend(), which);
  if (last == kept_.rend()) return false;
  kept_.erase(std::next(last).base());
  return true;
}

bool Diagnostics::make_room_for_error() {
  return kept_.size() < kKept || drop_last([](const Diagnostic& one) { return one.severity != Severity::error; });
}

bool Diagnostics::make_room_for(const std::string& text) {
  if (kept_.size() < kKept) return true;
  const auto times = [this](const std::string& words) {
    return std::count_if(kept_.begin(), kept_.end(), [&](const Diagnostic& one) { return one.text == words; });
  };
  if (times(text) > 0) return false;
  return drop_last([&](const Diagnostic& one) {
    return one.severity != Severity::error && times(one.text) > static_cast<std::ptrdiff_t>(kSame);
  });
}

}  // namespace axisgate::rml1

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

bool Diagnostics::make_room(Severity severity) {
  if (kept_.size() < kKept) return true;
  if (severity != Severity::error) return false;
  const auto last =
      std::find_if(kept_.rbegin(), kept_.rend(), [](const Diagnostic& one) { return one.severity != Severity::error; });
  if (last == kept_.rend()) return false;
  kept_.erase(std::next(last).base());
  return true;
}

}  // namespace axisgate::rml1

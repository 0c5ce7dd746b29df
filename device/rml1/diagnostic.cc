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

// The last that is no error and of a kind that `which` accepts.
template <class Which>
bool Diagnostics::drop_last(Which which) {
  for (std::size_t index = kept_.size(); index-- > 0;) {
    if (kept_[index].severity == Severity::error || !which(kinds_[index])) continue;
    kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(index));
    kinds_.erase(kinds_.begin() + static_cast<std::ptrdiff_t>(index));
    return true;
  }
  return false;
}

bool Diagnostics::make_room_for_error() {
  return kept_.size() < kKept || drop_last([](Kind) { return true; });
}

bool Diagnostics::make_room_for(Kind kind) {
  if (kept_.size() < kKept) return true;
  if (times(kind) > 0) return false;
  return drop_last([this](Kind other) { return times(other) > kSame; });
}

std::size_t Diagnostics::times(Kind kind) const {
  return static_cast<std::size_t>(std::count(kinds_.begin(), kinds_.end(), kind));
}

}  // namespace axisgate::rml1

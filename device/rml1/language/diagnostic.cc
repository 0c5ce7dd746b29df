#include "device/rml1/language/diagnostic.h"

#include <algorithm>
#include <tuple>

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

std::vector<Diagnostic> Diagnostics::in_order() const {
  std::vector<Diagnostic> all = kept_;
  const auto key = [](const Diagnostic& one) { return std::tuple(one.place.offset, one.number != 0); };
  std::ranges::stable_sort(all, {}, key);
  return all;
}

std::vector<Diagnostics::Omitted> Diagnostics::omitted() const {
  std::vector<Omitted> all;
  for (const Kind& kind : kinds_) {
    if (kind.count > kSame) all.push_back({kept_[kind.first], kind.count - kSame, kind.last});
  }
  return all;
}

bool Diagnostics::keeps(const void* id, const jobs::Place& place) {
  auto kind = std::ranges::find(kinds_, id, &Kind::id);
  if (kind == kinds_.end()) kind = kinds_.insert(kind, {id, kept_.size(), 0, place});
  kind->last = place;
  return ++kind->count <= kSame;
}

}  // namespace axisgate::rml1

#include "device/rml1/mill/queued_check.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "device/rml1/language/warning.h"

namespace axisgate::rml1 {

void QueuedCheck::feed(std::string_view bytes) {
  check_.feed(bytes);
  pieces_.take(bytes);
}

std::optional<jobs::FoundError> QueuedCheck::error() const {
  const Diagnostics& found = check_.diagnostics();
  const auto all = found.in_order();
  const auto first = std::ranges::find(all, Severity::error, &Diagnostic::severity);
  if (first == all.end()) return std::nullopt;
  return jobs::FoundError{first->place, first->text, std::string(first->section), found.count(Severity::error) - 1};
}

std::vector<jobs::FoundWarning> QueuedCheck::warnings() const {
  std::map<Warning, jobs::FoundWarning> by_kind;
  for (const Diagnostic& one : check_.diagnostics().in_order()) {
    if (!one.warning) continue;
    const Warning warning = *one.warning;
    const auto [found, is_first] = by_kind.try_emplace(warning);
    if (is_first) {
      found->second = {std::string(name(warning)), std::string(remedy(warning)), one.place, one.text};
    } else {
      ++found->second.more;
      found->second.last = one.place;
    }
  }
  for (const Diagnostics::Omitted& one : check_.diagnostics().omitted()) {
    if (!one.first.warning) continue;
    jobs::FoundWarning& found = by_kind[*one.first.warning];
    found.more += one.count;
    found.last = one.last;
  }
  std::vector<jobs::FoundWarning> warnings;
  for (auto& [warning, found] : by_kind) warnings.push_back(std::move(found));
  return warnings;
}

}  // namespace axisgate::rml1

#include "device/shrc203/state/switch_audit.h"

#include <utility>

#include "device/core/quantity.h"
#include "device/shot/command/reply.h"
#include "device/shrc203/command/builders.h"

namespace axisgate::shrc203 {

std::optional<int> SwitchAudit::item_set_by(const Command& command) {
  if (command.row->meaning != Meaning::switches) return {};
  return static_cast<int>(*parse_integer(*command.arguments.first("k")));
}

Command SwitchAudit::question_of(int item) { return commands::ask_all_switches(item); }

void SwitchAudit::before(int item, std::optional<Values> values) { before_.try_emplace(item, std::move(values)); }

void SwitchAudit::after(int item, std::optional<Values> values) { after_.insert_or_assign(item, std::move(values)); }

std::vector<int> SwitchAudit::items() const {
  std::vector<int> items;
  for (const auto& [item, values] : before_) items.push_back(item);
  return items;
}

std::optional<SwitchesChanged> SwitchAudit::result(const std::string& who) const {
  SwitchesChanged reported{who, {}, false};
  for (const auto& [item, old] : before_) {
    const auto found = after_.find(item);
    const bool known = old && found != after_.end() && found->second && found->second->size() == old->size();
    if (!known) {
      reported.unknown = true;
      continue;
    }
    const Values& now = *found->second;
    for (std::size_t number = 0; number < now.size(); ++number) {
      if ((*old)[number] == now[number]) continue;
      reported.changes.push_back({item, static_cast<int>(number), (*old)[number], now[number]});
    }
  }
  if (reported.changes.empty() && !reported.unknown) return {};
  return reported;
}

}  // namespace axisgate::shrc203

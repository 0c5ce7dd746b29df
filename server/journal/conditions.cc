#include "server/journal/conditions.h"

#include <fmt/format.h>

namespace axisgate::server::journal {

void Conditions::add_any_of(const std::vector<EntryKind>& kinds) {
  std::string list;
  for (const EntryKind kind : kinds) list += fmt::format("{}{}", list.empty() ? "" : ",", static_cast<int>(kind));
  add(fmt::format("kind IN ({})", list));
}

void Conditions::bind(Statement& statement) const {
  int parameter = 0;
  for (const auto& value : values_) {
    ++parameter;
    std::visit([&](const auto& one) { statement.bind(parameter, one); }, value);
  }
}

void Conditions::add(std::string_view condition) {
  sql_ += fmt::format("{}{} ", sql_.empty() ? "WHERE " : "AND ", condition);
}

Conditions conditions_of(const Filter& filter) {
  Conditions all;
  if (filter.from) all.add("time_us >= ?", *filter.from);
  if (filter.to) all.add("time_us < ?", *filter.to);
  if (!filter.device.empty()) all.add("device = ?", filter.device);
  if (!filter.who.empty()) all.add("person = (SELECT id FROM person WHERE name = ?)", filter.who);
  if (!filter.identity.empty()) all.add(kOfIdentity, filter.identity);
  if (filter.motion != 0) all.add("motion = ?", static_cast<std::int64_t>(filter.motion));
  if (!filter.kinds.empty()) all.add_any_of(filter.kinds);
  if (filter.before != 0) all.add("number < ?", filter.before);
  if (filter.after != 0) all.add("number > ?", filter.after);
  if (filter.axis != 0) {
    all.add(fmt::format("EXISTS (SELECT 1 FROM json_each({}, '$.axes') WHERE value = ?)", kJsonBody), filter.axis);
  }
  if (!filter.outcome.empty()) {
    all.add_any_of({EntryKind::motion_ended});
    all.add(fmt::format("json_extract({}, '$.outcome') = ?", kJsonBody), filter.outcome);
  }
  if (!filter.text.empty()) all.add("instr(body, ?) > 0", filter.text);
  return all;
}

}  // namespace axisgate::server::journal

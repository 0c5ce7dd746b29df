#include <algorithm>
#include <cstdlib>
#include <vector>

#include "device/shot/command/command_row.h"
#include "device/shrc203/command/rows.h"

namespace axisgate::shrc203 {

std::span<const CommandRow> command_table() {
  static const std::vector<CommandRow> all = [] {
    std::vector<CommandRow> table;
    for (const auto part : {rows::questions(), rows::motion(), rows::arcs(), rows::settings(), rows::other_modes(),
                            rows::saved_positions()}) {
      table.insert(table.end(), part.begin(), part.end());
    }
    return table;
  }();
  return all;
}

const CommandRow& command_row(std::string_view name) {
  const auto row = std::ranges::find(command_table(), name, &CommandRow::name);
  if (row == command_table().end()) std::abort();
  return *row;
}

}  // namespace axisgate::shrc203

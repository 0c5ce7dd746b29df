#include "device/shrc203/command/listing.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203 {
namespace {

std::string described(const Parameter& parameter) {
  std::string text = fmt::format("{}: {}", parameter.letter, parameter.meaning);
  if (parameter.maximum > parameter.minimum) {
    text += fmt::format("; {} to {}", parameter.minimum, parameter.maximum);
    if (!parameter.unit.empty()) text += fmt::format(" {}", parameter.unit);
  }
  return text;
}

stage::CommandInfo info_of(const CommandRow& row) {
  stage::CommandInfo info{.name = std::string(row.name),
                          .format = std::string(row.format),
                          .description = std::string(row.description),
                          .parameters = {},
                          .section = fmt::format("{})", row.section),
                          .lane = row.lane,
                          .moves = row.moves()};
  for (const Parameter& parameter : row.parameters) info.parameters.push_back(described(parameter));
  return info;
}

using Request = stage::AdminCommand::Request;
constexpr std::array<stage::AdminCommand, 6> kAdminCommands = {{
    {"BEC:", Request::clear_errors},
    {"RESET:", Request::reset},
    {"FMT:"},
    {"MODE:"},
    {"MS:"},
    {"P:ON"},
}};

}  // namespace

std::vector<stage::CommandInfo> list_commands() {
  std::vector<stage::CommandInfo> list;
  for (const CommandRow& row : model().commands()) list.push_back(info_of(row));
  return list;
}

std::span<const stage::AdminCommand> admin_commands() { return kAdminCommands; }

}  // namespace axisgate::shrc203

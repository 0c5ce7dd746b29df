#include "device/stage/kind.h"

#include <array>

namespace axisgate::stage {

std::span<const Capability> Kind::capabilities() const {
  static constexpr std::array kUsual = {Capability::move, Capability::home, Capability::return_to_origin,
                                        Capability::jog};
  return kUsual;
}

std::vector<CommandInfo> Kind::commands() const { return {}; }

std::span<const AdminCommand> Kind::admin_commands() const { return {}; }

Result<std::vector<std::string>> Kind::lines_for(const Setting&, const State&) const {
  return fail(Reason::invalid_request, "a controller of this kind cannot be set like that");
}

std::span<const std::string_view> Kind::setting_questions() const { return {}; }

void Kind::read_setting(std::string_view, std::string_view, const State&, Settings&) const {}

std::optional<PositionLines> Kind::position_lines(const PositionSlot&) const { return {}; }

std::map<int, std::int64_t> Kind::read_position(const PositionSlot&, std::string_view, const State&) const {
  return {};
}

}  // namespace axisgate::stage

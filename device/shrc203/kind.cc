#include "device/shrc203/kind.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "device/shrc203/command/listing.h"
#include "device/shrc203/command/saved_positions.h"
#include "device/shrc203/command/setting_lines.h"
#include "device/shrc203/controller.h"
#include "device/shrc203/planning/transaction_lines.h"
#include "device/shrc203/simulator/options.h"
#include "device/shrc203/simulator/simulator.h"

namespace axisgate::shrc203 {
namespace {

constexpr std::array<std::string_view, 2> kScopes = {"axis", "controller"};
constexpr std::array<stage::KindSetting, 3> kSettings = {{
    {"busy_scope", kScopes, "controller"},
    {"prebuffer_scope", kScopes, "controller"},
    {"wait_for_inputs", {}, "false"},
}};

bool is(const Words& settings, std::string_view key, std::string_view word) {
  const auto found = settings.find(key);
  return found != settings.end() && found->second == word;
}

Scope scope(const Words& settings, std::string_view key) {
  return is(settings, key, "axis") ? Scope::axis : Scope::controller;
}

constexpr std::array kCapabilities = {stage::Capability::move,
                                      stage::Capability::home,
                                      stage::Capability::return_to_origin,
                                      stage::Capability::jog,
                                      stage::Capability::path,
                                      stage::Capability::arc,
                                      stage::Capability::scan,
                                      stage::Capability::saved_positions,
                                      stage::Capability::settings,
                                      stage::Capability::pins,
                                      stage::Capability::trigger,
                                      stage::Capability::commands};

class Shrc203 final : public stage::Kind {
 public:
  std::string_view name() const override { return "shrc203"; }
  int axis_count() const override { return kAxisCount; }
  std::span<const stage::KindSetting> settings() const override { return kSettings; }
  std::span<const stage::Capability> capabilities() const override { return kCapabilities; }

  std::unique_ptr<StageController> make_controller(const stage::Profile& profile, const Words& settings, ByteLink& link,
                                                   EventSink& events, Permission& permission) const override {
    Profile own(profile);
    own.busy_scope = scope(settings, "busy_scope");
    own.prebuffer_scope = scope(settings, "prebuffer_scope");
    own.wait_for_inputs = is(settings, "wait_for_inputs", "true");
    return std::make_unique<Controller>(std::move(own), link, events, permission);
  }

  Result<void> check_lines(const std::vector<std::string>& lines) const override {
    const auto commands = shrc203::check_lines(lines);
    return commands ? Result<void>() : tl::unexpected(commands.error());
  }

  bool changes_something(const std::vector<std::string>& lines) const override {
    const auto commands = shrc203::check_lines(lines);
    if (!commands) return false;
    const auto any = [&](auto holds) {
      return std::ranges::any_of(*commands, [&](const Command& command) { return holds(command.row->effect); });
    };
    return !any([](Effect effect) { return effect == Effect::stop; }) &&
           any([](Effect effect) { return effect != Effect::question; });
  }

  std::vector<stage::CommandInfo> commands() const override { return list_commands(); }

  std::span<const stage::AdminCommand> admin_commands() const override { return shrc203::admin_commands(); }

  Result<std::vector<std::string>> lines_for(const Setting& setting, const State& state) const override {
    return shrc203::lines_for(setting, state);
  }
  std::span<const std::string_view> setting_questions() const override { return shrc203::setting_questions(); }
  void read_setting(std::string_view question, std::string_view answer, const State& state,
                    Settings& settings) const override {
    shrc203::read_setting(question, answer, state.controllable(), settings);
  }

  std::optional<PositionLines> position_lines(const PositionSlot& slot) const override {
    return shrc203::position_lines(slot);
  }
  std::map<int, std::int64_t> read_position(const PositionSlot& slot, std::string_view answer,
                                            const State& state) const override {
    return shrc203::read_position(slot, answer, state.controllable());
  }

  Result<void> check_option(std::string_view name, std::string_view value) const override {
    return simulator::Options().set(name, value);
  }

  std::unique_ptr<Simulation> make_simulation(const Words& options, ByteLink& line) const override {
    simulator::Options chosen;
    for (const auto& [name, value] : options) (void)chosen.set(name, value);  // check_option() has checked them
    return std::make_unique<simulator::Simulator>(std::move(chosen), line);
  }
};

}  // namespace

const stage::Kind& kind() {
  static const Shrc203 only;
  return only;
}

}  // namespace axisgate::shrc203

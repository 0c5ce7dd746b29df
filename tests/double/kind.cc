#include "tests/double/kind.h"

#include <array>

#include "tests/double/controller.h"
#include "tests/double/simulated_rotor.h"

namespace axisgate::rotor {
namespace {

constexpr std::array<std::string_view, 2> kDirections = {"normal", "reversed"};
using Request = stage::AdminCommand::Request;
constexpr std::array<stage::AdminCommand, 2> kAdminCommands = {{
    {"clear errors", Request::clear_errors},
    {"reset", Request::reset},
}};
constexpr std::array<stage::KindSetting, 1> kSettings = {{{"direction", kDirections, "normal"}}};

class Rotor final : public stage::Kind {
 public:
  std::string_view name() const override { return "rotor"; }
  int axis_count() const override { return 1; }
  std::span<const stage::KindSetting> settings() const override { return kSettings; }

  std::unique_ptr<stage::StageController> make_controller(const stage::Profile& profile, const Words& settings,
                                                          ByteLink& link, stage::EventSink& events,
                                                          use::Permission& permission) const override {
    const auto direction = settings.find("direction");
    const bool reversed = direction != settings.end() && direction->second == "reversed";
    return std::make_unique<Controller>(profile, reversed, link, events, permission);
  }

  Result<void> check_lines(const std::vector<std::string>&) const override {
    return fail(Reason::not_allowed, "a rotor takes no lines of its callers'", "ask for moves, jogs and stops");
  }

  std::span<const stage::AdminCommand> admin_commands() const override { return kAdminCommands; }

  Result<void> check_option(std::string_view name, std::string_view value) const override {
    return SimulatedRotor::Options().set(name, value);
  }

  std::unique_ptr<Simulation> make_simulation(const Words& options, ByteLink& line) const override {
    SimulatedRotor::Options chosen;
    for (const auto& [name, value] : options) (void)chosen.set(name, value);  // already checked
    return std::make_unique<SimulatedRotor>(chosen, line);
  }
};

}  // namespace

const stage::Kind& kind() {
  static const Rotor only;
  return only;
}

}  // namespace axisgate::rotor

#include "tests/shot/kind.h"

#include "tests/shot/controller.h"
#include "tests/shot/simulated_unit.h"

namespace axisgate::shot2 {
namespace {

class Shot2 final : public stage::Kind {
 public:
  std::string_view name() const override { return "shot2"; }
  int axis_count() const override { return model().axis_count(); }
  std::span<const stage::KindSetting> settings() const override { return {}; }

  std::unique_ptr<StageController> make_controller(const stage::Profile& profile, const Words&, ByteLink& link,
                                                   EventSink& events, Permission& permission) const override {
    return std::make_unique<Controller>(shot::Profile{profile}, link, events, permission);
  }

  Result<void> check_lines(const std::vector<std::string>&) const override {
    return fail(Reason::not_allowed, "a SHOT-2 takes no lines of its callers", "ask for moves");
  }

  Result<void> check_option(std::string_view name, std::string_view value) const override {
    return SimulatedUnit::Options().set(name, value);
  }

  std::unique_ptr<Simulation> make_simulation(const Words& options, ByteLink& line) const override {
    SimulatedUnit::Options chosen;
    for (const auto& [name, value] : options) (void)chosen.set(name, value);  // already checked
    return std::make_unique<SimulatedUnit>(chosen, line);
  }
};

}  // namespace

const stage::Kind& kind() {
  static const Shot2 only;
  return only;
}

}  // namespace axisgate::shot2

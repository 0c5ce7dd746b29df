#include "tests/shot/kind.h"

#include "tests/shot/controller.h"
#include "tests/shot/simulated_unit.h"

namespace axisgate::shot2 {
namespace {

class Shot final : public stage::Kind {
 public:
  Shot(std::string_view name, int axis_count) : name_(name), model_(model_of(axis_count)) {}

  std::string_view name() const override { return name_; }
  int axis_count() const override { return model_.axis_count(); }
  std::span<const stage::KindSetting> settings() const override { return {}; }
  std::span<const stage::Capability> capabilities() const override {
    static constexpr std::array kAll = {stage::Capability::move, stage::Capability::home};
    return kAll;
  }

  std::unique_ptr<StageController> make_controller(const stage::Profile& profile, const Words&, ByteLink& link,
                                                   EventSink& events, Permission& permission) const override {
    return std::make_unique<Controller>(model_, shot::Profile{profile}, link, events, permission);
  }

  Result<void> check_lines(const std::vector<std::string>&) const override {
    return fail(Reason::not_allowed, "this controller takes no lines of its callers", "ask for moves");
  }

  Result<void> check_option(std::string_view name, std::string_view value) const override {
    return SimulatedUnit::Options().set(name, value);
  }

  std::unique_ptr<Simulation> make_simulation(const Words& options, ByteLink& line) const override {
    SimulatedUnit::Options chosen;
    for (const auto& [name, value] : options) (void)chosen.set(name, value);  // already checked
    return std::make_unique<SimulatedUnit>(model_.axis_count(), chosen, line);
  }

 private:
  const std::string_view name_;
  const Model& model_;
};

}  // namespace

const stage::Kind& kind_of(int axis_count) {
  static const Shot one("shot1", 1), two("shot2", 2), eight("shot8", 8);
  return axis_count == 1 ? one : axis_count == 2 ? two : eight;
}

}  // namespace axisgate::shot2

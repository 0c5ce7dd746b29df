#include "device/use/permission.h"

namespace axisgate::use {
namespace {

class EverybodyMay final : public Permission {
  Result<void> authorize(const Use&, TimePoint) override { return {}; }
  void begin(const Use&, Occupation, TimePoint) override {}
  void due(ActivityId, TimePoint) override {}
  void end(ActivityId, TimePoint) override {}
  void stop_asked(const Use&, const std::vector<Use>&, TimePoint) override {}
  void device_restarted(TimePoint) override {}
  void settings_changed(std::uint64_t) override {}
  Orders advance(TimePoint) override { return {}; }
  void stopped(std::uint64_t, TimePoint) override {}
  void settings_restored(std::uint64_t, TimePoint) override {}
  std::optional<TimePoint> next_deadline() const override { return {}; }
};

}  // namespace

Permission& everybody_may() {
  static EverybodyMay permission;
  return permission;
}

}  // namespace axisgate::use

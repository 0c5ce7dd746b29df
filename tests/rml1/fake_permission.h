// Permission to use a mill, set by a test.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/stage/permission.h"

namespace axisgate::rml1 {

class FakePermission final : public stage::Permission {
 public:
  Result<void> authorize(const stage::Use& use, TimePoint) override {
    asked.push_back(use);
    return allowed ? Result<void>() : fail(Reason::lease_held, "unix carl has held the mill for 5 s");
  }
  void begin(const stage::Use& use, stage::Occupation occupation, TimePoint) override {
    users[use.motion] = occupation.before + ", " + occupation.by;
  }
  void due(stage::MotionId, TimePoint) override {}
  void end(stage::MotionId job, TimePoint) override { users.erase(job); }
  void stop_asked(const stage::Use& stop, const std::vector<stage::Use>&, TimePoint) override {
    stops.push_back(stop.who);
  }
  void device_restarted(TimePoint) override {}
  void settings_changed(std::uint64_t) override {}
  stage::Orders advance(TimePoint) override { return std::exchange(orders, {}); }
  void stopped(std::uint64_t order, TimePoint) override { answered.push_back(order); }
  void settings_restored(std::uint64_t, TimePoint) override {}
  std::optional<TimePoint> next_deadline() const override {
    return orders.stops.empty() ? std::nullopt : std::optional(TimePoint());
  }

  bool allowed = true;
  std::vector<stage::Use> asked;
  std::map<stage::MotionId, std::string> users;
  std::vector<std::string> stops;
  stage::Orders orders;
  std::vector<std::uint64_t> answered;
};

}  // namespace axisgate::rml1

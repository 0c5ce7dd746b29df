// Permission to use a mill, set by a test.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/use/permission.h"

namespace axisgate::rml1 {

class FakePermission final : public use::Permission {
 public:
  Result<void> authorize(const use::Use& use, TimePoint) override {
    asked.push_back(use);
    return allowed ? Result<void>() : fail(Reason::lease_held, "unix carl has held the mill for 5 s");
  }
  void begin(const use::Use& use, use::Occupation occupation, TimePoint) override {
    users[use.activity] = occupation.before + ", " + occupation.by;
  }
  void due(use::ActivityId, TimePoint) override {}
  void end(use::ActivityId job, TimePoint) override { users.erase(job); }
  void stop_asked(const use::Use& stop, const std::vector<use::Use>&, TimePoint) override { stops.push_back(stop.who); }
  void device_restarted(TimePoint) override {}
  void settings_changed(std::uint64_t) override {}
  use::Orders advance(TimePoint) override { return std::exchange(orders, {}); }
  void stopped(std::uint64_t order, TimePoint) override { answered.push_back(order); }
  void settings_restored(std::uint64_t, TimePoint) override {}
  std::optional<TimePoint> next_deadline() const override {
    return orders.stops.empty() ? std::nullopt : std::optional(TimePoint());
  }

  bool allowed = true;
  std::vector<use::Use> asked;
  std::map<use::ActivityId, std::string> users;
  std::vector<std::string> stops;
  use::Orders orders;
  std::vector<std::uint64_t> answered;
};

}  // namespace axisgate::rml1

// What a controller is set to beside its motion.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/settings.h"
#include "server/access/access.h"
#include "server/api/request/call.h"
#include "server/api/request/pipeline.h"
#include "server/api/stage/setting_lines.h"
#include "server/gateway.h"

namespace axisgate::api {

// Thread safe.
class Settings {
 public:
  // All outlive this, and `access` the gateway.
  Settings(const server::Gateway& gateway, const server::Access& access, const Pipeline& pipeline)
      : gateway_(gateway), access_(access), pipeline_(pipeline) {}

  // Read from the device. What cannot be read while something moves is as it was last known. link_down, device_refused.
  void get(const Call& call, std::string_view device, Answer<stage::Settings> answer) const;

  // Each as one transaction. not_allowed for what the configuration keeps for administrators, and as lines_of() and
  // Kind::check_lines().
  void change(const Call& call, std::string_view device, const Result<SettingsChange>& change,
              Answer<void> answer) const;
  void set_coordinates(const Call& call, std::string_view device, const Result<NewCoordinates>& coordinates,
                       Answer<void> answer) const;
  void fire_trigger(const Call& call, std::string_view device, Answer<void> answer) const;
  void reset(const Call& call, std::string_view device, Answer<void> answer) const;

 private:
  template <class ToLines>
  void set(const Asked& asked, std::string_view verb, Answer<void> answer, ToLines to_lines) const;

  const server::Gateway& gateway_;
  const server::Access& access_;
  const Pipeline& pipeline_;
};

}  // namespace axisgate::api

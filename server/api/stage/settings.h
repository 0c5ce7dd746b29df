// Settings of a controller.
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
  // The referenced objects must outlive this one; `access` must also outlive the gateway.
  Settings(const server::Gateway& gateway, const server::Access& access, const Pipeline& pipeline)
      : gateway_(gateway), access_(access), pipeline_(pipeline) {}

  // Reads the settings from the controller. While an axis moves, settings that cannot be read keep their last known
  // value. Fails with link_down or device_refused.
  void get(const Call& call, std::string_view device, Answer<stage::Settings> answer) const;

  // Each of the following runs one transaction. Fails with not_allowed if the configuration keeps a line for
  // administrators, and as lines_of() and Kind::check_lines() do.
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

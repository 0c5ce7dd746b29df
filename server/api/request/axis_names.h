// Names of axes, as callers use them.
#pragma once

#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/axes.h"
#include "device/stage/profile.h"

namespace axisgate::server {
class Gateway;
}

namespace axisgate::api {

// AxisNames finds the axes of one stage as callers name them.
class AxisNames {
 public:
  // `profile` must outlive this object. Null: axes are known by their numbers only.
  explicit AxisNames(const stage::Profile* profile = nullptr) : profile_(profile) {}

  // Returns the axis with this number or configured name. Fails with unknown_axis, also for a number above kAxesMax.
  Result<int> find(std::string_view number_or_name) const;
  // Finds all of them. Fails with invalid_request if an axis is named twice. No axes stay no axes.
  Result<stage::AxisSet> find_all(const std::vector<std::string_view>& numbers_or_names) const;

 private:
  const stage::Profile* profile_;
};

// Returns the names of the stage with this name, or of the only stage if the name is empty. Of any other device only
// numbers are known: a request for it fails because of the device.
AxisNames axis_names(const server::Gateway& gateway, std::string_view device);

}  // namespace axisgate::api

// A kind of machine that is sent jobs. The machine's folder implements it; server/kinds.cc lists all of them.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "device/config/config_error.h"
#include "device/config/config_table.h"
#include "device/core/problem.h"
#include "device/jobs/model.h"

namespace axisgate::jobs {

// Stateless and thread safe.
class Kind {
 public:
  virtual ~Kind() = default;

  virtual std::string_view name() const = 0;  // value of `kind` in the configuration

  // Reads the keys of the device's table that only this kind has. Adds errors to the table, or to `errors` if they are
  // in another file. Returns null if the model cannot be read.
  virtual std::shared_ptr<const Model> read_model(ConfigTable& table, std::vector<ConfigError>& errors) const = 0;

  // Checks one option of a simulation. Fails with invalid_request and the permitted values.
  virtual Result<void> check_option(std::string_view name, std::string_view value) const = 0;
};

}  // namespace axisgate::jobs

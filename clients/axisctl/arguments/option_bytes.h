// Refusal of arguments that are not UTF-8.
#pragma once

#include <optional>

#include "clients/axisctl/failure.h"

namespace CLI {
class App;
}

namespace axisgate::axisctl {

// Returns an error for the first parsed argument that is not UTF-8; nullopt if all are. Refused before anything is
// sent, because protobuf accepts only UTF-8.
std::optional<Failure> not_utf8(const CLI::App& app);

}  // namespace axisgate::axisctl

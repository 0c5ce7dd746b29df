#include "server/api/audit.h"

#include <spdlog/spdlog.h>

namespace axisgate::api {

void audit(RequestKind kind, std::string_view who, std::string_view what) {
  if (rule_of(kind).audited) spdlog::info("{} {}", who, what);
}

}  // namespace axisgate::api

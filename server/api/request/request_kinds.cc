#include "server/api/request/request_kinds.h"

#include <algorithm>

namespace axisgate::api {

RequestKind kind_of(std::string_view method) {
  const auto found = std::ranges::find(kRules, method, &Rule::method);
  return method.empty() || found == kRules.end() ? RequestKind::unlisted : found->kind;
}

std::string_view name(RequestKind kind) { return rule_of(kind).name; }

const Rule& rule_of(RequestKind kind) { return kRules[static_cast<std::size_t>(kind)]; }

bool uses_axes(RequestKind kind) {
  const Use use = rule_of(kind).use;
  return use == Use::axes || use == Use::all_axes;
}

}  // namespace axisgate::api

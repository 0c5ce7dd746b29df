#include "server/proto/callers.h"

#include <array>
#include <string>
#include <utility>

namespace axisgate::proto {
namespace {

// The first word of a name says how the daemon identified its caller.
v1::Caller::Kind kind_of(std::string_view who) {
  static constexpr std::array<std::pair<std::string_view, v1::Caller::Kind>, 4> kKinds = {
      {{"unix", v1::Caller::KIND_UNIX_USER},
       {"cert", v1::Caller::KIND_CERTIFICATE},
       {"token", v1::Caller::KIND_TOKEN},
       {"tcp", v1::Caller::KIND_CONNECTION}}};
  if (who.starts_with("the gateway")) return v1::Caller::KIND_GATEWAY;
  const std::string_view way = who.substr(0, who.find(' '));
  for (const auto& [word, kind] : kKinds) {
    if (word == way) return kind;
  }
  return v1::Caller::KIND_UNSPECIFIED;
}

}  // namespace

v1::Caller to_caller(std::string_view who) {
  v1::Caller caller;
  caller.set_name(std::string(who));
  caller.set_kind(kind_of(who));
  return caller;
}

}  // namespace axisgate::proto

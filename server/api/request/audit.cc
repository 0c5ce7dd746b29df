#include "server/api/request/audit.h"

#include "device/core/escape.h"
#include "server/log.h"

namespace axisgate::api {
namespace {

constexpr std::size_t kWhatMax = 400;

}  // namespace

void audit(RequestKind kind, std::string_view who, std::string_view what) {
  if (rule_of(kind).audited) server::log::info("{} {}", escaped(who), escaped(what, kWhatMax));
}

void audit(RequestKind kind, const server::Device& device, const use::RequestContext& context, std::string_view what) {
  if (!rule_of(kind).audited) return;
  server::log::info("{}: {} requests: {}", device.name(), escaped(context.who), escaped(what, kWhatMax));
}

}  // namespace axisgate::api

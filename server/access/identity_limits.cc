#include "server/access/identity_limits.h"

#include <fmt/format.h>

namespace axisgate::server {
namespace {

constexpr std::size_t index(IdentityLimits::Kind kind) { return static_cast<std::size_t>(kind); }

}  // namespace

Result<void> IdentityLimits::check(const std::string& who, Kind kind) const {
  const int limit = limits_[index(kind)];
  {
    const std::lock_guard lock(mutex_);
    const auto identity = open_.find(who);
    if (identity == open_.end() || identity->second[index(kind)] < limit) return {};
  }
  if (kind == Kind::stream) {
    return fail(Reason::queue_full, fmt::format("{} has {} streams open, as many as one caller may have", who, limit),
                "close some that nobody reads, and try again in 1 s; or have `streams` in [limits] of the "
                "configuration raised");
  }
  return fail(Reason::queue_full,
              fmt::format("{} has {} requests in flight, as many as one caller may have", who, limit),
              "wait for some of them, and try again in 1 s; or have `calls` in [limits] of the configuration raised");
}

IdentityLimits::Place IdentityLimits::take(const std::string& who, Kind kind) {
  Open::iterator identity;
  {
    const std::lock_guard lock(mutex_);
    identity = open_.try_emplace(who).first;
    ++identity->second[index(kind)];
  }
  return Place(nullptr, [this, identity, kind](void*) { leave(identity, kind); });
}

std::size_t IdentityLimits::identities() const {
  const std::lock_guard lock(mutex_);
  return open_.size();
}

void IdentityLimits::leave(Open::iterator identity, Kind kind) {
  const std::lock_guard lock(mutex_);
  --identity->second[index(kind)];
  if (identity->second == Open::mapped_type{}) open_.erase(identity);
}

}  // namespace axisgate::server

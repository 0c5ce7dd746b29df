#include "server/connections/certificate_watch.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "device/core/explain.h"
#include "server/connections/certificates.h"
#include "server/log.h"

namespace axisgate::server {
namespace {

constexpr auto kSoon = std::chrono::days(14);  // the same as in the alert AxisgateCertificateExpires
constexpr auto kPause = std::chrono::days(1);
constexpr auto kAfterExpiry = std::chrono::seconds(1);  // covers a small difference between the clocks

}  // namespace

CertificateNotice notice_of(const std::string& path, const Result<WallTime>& until, WallTime now) {
  if (!until) return {explain(until.error()), kPause};
  const auto left = *until - now;
  if (left > kSoon) return {"", kPause};
  const bool expired = left <= WallTime::duration::zero();
  const std::string when = fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(WallTime::clock::to_time_t(*until)));
  return {
      fmt::format("the certificate {} {} {}; callers from the network {} no longer connect; replace it and its key, "
                  "no restart is needed",
                  path, expired ? "expired at" : "expires at", when, expired ? "can" : "can then"),
      expired ? Duration(kPause) : std::min<Duration>(kPause, left + kAfterExpiry)};
}

void watch_certificate(const std::string& path, Timeouts& timeouts) {
  const CertificateNotice notice = notice_of(path, expiry(path), std::chrono::system_clock::now());
  if (!notice.text.empty()) log::warn("{}", notice.text);
  timeouts.after(notice.next_look, [path, &timeouts] { watch_certificate(path, timeouts); });
}

}  // namespace axisgate::server

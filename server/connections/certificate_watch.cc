#include "server/connections/certificate_watch.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "device/core/explain.h"
#include "server/connections/certificates.h"
#include "server/limits.h"
#include "server/log.h"

namespace axisgate::server {
CertificateNotice notice_of(const std::string& path, const Result<WallTime>& until, WallTime now) {
  if (!until) return {explain(until.error()), kCertificateLook};
  const auto left = *until - now;
  if (left > kCertificateEndsSoon) return {"", kCertificateLook};
  const bool expired = left <= WallTime::duration::zero();
  const std::string when = fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(WallTime::clock::to_time_t(*until)));
  return {
      fmt::format("the certificate {} {} {}; callers from the network {} no longer connect; replace it and its key, "
                  "no restart is needed",
                  path, expired ? "expired at" : "expires at", when, expired ? "can" : "can then"),
      expired ? Duration(kCertificateLook) : std::min<Duration>(kCertificateLook, left + kCertificateMargin)};
}

void watch_certificate(const std::string& path, Timeouts& timeouts) {
  const CertificateNotice notice = notice_of(path, expiry(path), std::chrono::system_clock::now());
  if (!notice.text.empty()) log::warn("{}", notice.text);
  timeouts.after(notice.next_look, [path, &timeouts] { watch_certificate(path, timeouts); });
}

}  // namespace axisgate::server

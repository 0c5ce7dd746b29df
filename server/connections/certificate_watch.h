// Warns in the log before a server certificate expires and after it has expired.
#pragma once

#include <string>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "server/events/timeouts.h"
#include "server/events/wall_time.h"

namespace axisgate::server {

struct CertificateNotice {
  std::string text;      // for the log; empty if the certificate is valid for long enough
  Duration next_look{};  // from now
};

// `until` is expiry() of the file at `path`.
CertificateNotice notice_of(const std::string& path, const Result<WallTime>& until, WallTime now);

// Checks the file now, once a day, and when the certificate expires, and logs problems. Each check reads the file
// again, since it may be replaced while the daemon runs. `timeouts` must outlive the call; its end ends the watch.
void watch_certificate(const std::string& path, Timeouts& timeouts);

}  // namespace axisgate::server

// The daemon's log: lines on standard error, collected and written in portions.
#pragma once

namespace axisgate::server {

// Makes it spdlog's default. A line that warns goes out at once, others within a second. SPDLOG_LEVEL in the
// environment sets what is logged.
void start_logging();

}  // namespace axisgate::server

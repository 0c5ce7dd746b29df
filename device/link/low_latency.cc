#include "device/link/low_latency.h"

#include <fmt/format.h>
#include <linux/serial.h>
#include <sys/ioctl.h>

#include <fstream>
#include <system_error>

namespace axisgate {
namespace {

constexpr int kShortest = 1;  // ms

// Sets the flag. A driver that does not support it refuses, and has no latency to change.
void set_flag(int port) {
  serial_struct settings{};
  if (::ioctl(port, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  ::ioctl(port, TIOCSSERIAL, &settings);
}

}  // namespace

std::optional<std::string> ask_for_low_latency(int port, const std::filesystem::path& path,
                                               const std::filesystem::path& classes) {
  set_flag(port);
  std::error_code error;
  const std::filesystem::path tty = std::filesystem::canonical(path, error);
  if (error) return std::nullopt;
  const std::filesystem::path timer = classes / tty.filename() / "device" / "latency_timer";
  int milliseconds = 0;
  if (!(std::ifstream(timer) >> milliseconds) || milliseconds <= kShortest) return std::nullopt;
  return fmt::format(
      "the adapter of {} holds replies back for up to {} ms: `echo {} > {}` as root ends that until "
      "it is unplugged",
      path.string(), milliseconds, kShortest, timer.string());
}

}  // namespace axisgate

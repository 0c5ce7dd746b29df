#include "device/link/serial_port.h"

#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "device/link/descriptor.h"

// termios2 with BOTHER accepts any baud rate, while <termios.h> has only the rates with a B constant. The header of
// termios2 cannot be included together with <termios.h>.

namespace axisgate {
namespace {

namespace fs = std::filesystem;

std::string error_text(int number) { return std::generic_category().message(number); }

tl::unexpected<Problem> refuse(const SerialSettings& settings, std::string_view why, std::string hint = {}) {
  return fail(Reason::link_down, fmt::format("serial port {}: {}", settings.path, why), std::move(hint));
}

bool has_open(const fs::path& process, const fs::path& device) {
  std::error_code error;
  for (fs::directory_iterator entry(process / "fd", error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unreadable;
    if (fs::read_symlink(entry->path(), unreadable) == device) return true;
  }
  return false;
}

// Returns the id of another process that has the port open, as far as /proc shows it to this process.
std::optional<int> holder_of(const std::string& path) {
  std::error_code error;
  const fs::path device = fs::canonical(path, error);
  if (error) return std::nullopt;
  for (fs::directory_iterator entry("/proc", error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename();
    int process = 0;
    const auto [rest, parsed] = std::from_chars(name.data(), name.data() + name.size(), process);
    const bool other = parsed == std::errc() && rest == name.data() + name.size() && process != ::getpid();
    if (other && has_open(entry->path(), device)) return process;
  }
  return std::nullopt;
}

tl::unexpected<Problem> refuse_as_held(const SerialSettings& settings) {
  const auto holder = holder_of(settings.path);
  return refuse(settings, holder ? fmt::format("held by another process (pid {})", *holder) : "held by another process",
                "Only one program can talk to a controller: end the other one, or let it use this gateway.");
}

tl::unexpected<Problem> refuse_to_open(const SerialSettings& settings, int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return refuse(settings, "no such device", "Check that the cable is plugged in and the path is right.");
    case EACCES:
    case EPERM:
      return refuse(settings, "permission denied",
                    "Add the user that runs this program to the group dialout and log in again.");
    case EBUSY:
      return refuse_as_held(settings);
    default:
      return refuse(settings, error_text(error));
  }
}

// Reports whether the port is a pseudo terminal. A pseudo terminal keeps TIOCEXCL for as long as its master lives, so
// nobody could open it after its first user; flock must be enough for it.
bool is_pseudo_terminal(int port) {
  constexpr unsigned kFirstMajor = 136, kLastMajor = 143;  // UNIX98_PTY_SLAVE_MAJOR and its count
  struct stat status {};
  if (::fstat(port, &status) != 0) return false;
  return major(status.st_rdev) >= kFirstMajor && major(status.st_rdev) <= kLastMajor;
}

constexpr cc_t kXon = 0x11, kXoff = 0x13;  // DC1, DC3 of ASCII

termios2 raw_mode(const SerialSettings& settings) {
  termios2 mode{};
  mode.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
  if (settings.parity != Parity::none) mode.c_cflag |= PARENB;
  if (settings.parity == Parity::odd) mode.c_cflag |= PARODD;
  if (settings.stop_bits == 2) mode.c_cflag |= CSTOPB;
  if (settings.flow == FlowControl::rts_cts) mode.c_cflag |= CRTSCTS;
  if (settings.parity != Parity::none) mode.c_iflag = INPCK | IGNPAR;
  if (settings.flow == FlowControl::xon_xoff) {
    mode.c_iflag |= IXON;
    mode.c_cc[VSTART] = kXon;
    mode.c_cc[VSTOP] = kXoff;
  }
  mode.c_cc[VMIN] = 1;
  mode.c_cc[VTIME] = 0;
  mode.c_ispeed = static_cast<speed_t>(settings.baud);
  mode.c_ospeed = static_cast<speed_t>(settings.baud);
  return mode;
}

// Sets the mode and reads it back: a driver reports success if it could carry out any part of the request.
Result<void> configure(int port, const SerialSettings& settings) {
  const termios2 wanted = raw_mode(settings);
  termios2 actual{};
  if (::ioctl(port, TCSETS2, &wanted) != 0 || ::ioctl(port, TCGETS2, &actual) != 0) {
    return refuse(settings, "its driver refuses the line settings: " + error_text(errno));
  }
  constexpr double kToleranceOfUarts = 0.025;
  const double baud = settings.baud;
  if (actual.c_ospeed < baud * (1 - kToleranceOfUarts) || actual.c_ospeed > baud * (1 + kToleranceOfUarts)) {
    return refuse(settings, fmt::format("its driver gives {} baud instead of {}", actual.c_ospeed, settings.baud),
                  "Choose a rate that the adapter has.");
  }
  constexpr tcflag_t kChecked = CSIZE | PARENB | PARODD | CSTOPB | CRTSCTS;
  if (!is_pseudo_terminal(port) && ((wanted.c_cflag ^ actual.c_cflag) & kChecked) != 0) {
    return refuse(settings, "its driver does not take this parity, number of stop bits or flow control",
                  "Choose others, in the configuration and at the controller.");
  }
  return {};
}

Result<void> check(const SerialSettings& settings) {
  if (settings.baud < 1)
    return refuse(settings, fmt::format("{} is no baud rate", settings.baud),
                  "Take 38400, or what the controller is set to.");
  if (settings.stop_bits != 1 && settings.stop_bits != 2) {
    return refuse(settings, fmt::format("{} stop bits are not possible", settings.stop_bits), "Take 1 or 2.");
  }
  return {};
}

}  // namespace

Result<int> open_serial(const SerialSettings& settings) {
  if (auto good = check(settings); !good) return tl::unexpected(good.error());
  Descriptor port(::open(settings.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!port.valid()) return refuse_to_open(settings, errno);
  if (!::isatty(port.get())) return refuse(settings, "not a serial port", "Check the path.");
  if (::flock(port.get(), LOCK_EX | LOCK_NB) != 0) return refuse_as_held(settings);
  if (!is_pseudo_terminal(port.get())) ::ioctl(port.get(), TIOCEXCL);
  if (auto configured = configure(port.get(), settings); !configured) return tl::unexpected(configured.error());
  ::ioctl(port.get(), TCFLSH, TCIFLUSH);
  return port.release();
}

bool forbids(FlowControl flow, int modem_lines) {
  switch (flow) {
    case FlowControl::rts_cts:
      return (modem_lines & TIOCM_CTS) == 0;
    case FlowControl::dtr_dsr:
      return (modem_lines & TIOCM_DSR) == 0;
    default:
      return false;
  }
}

bool is_held(int port, FlowControl flow) {
  int modem_lines = 0;
  return ::ioctl(port, TIOCMGET, &modem_lines) == 0 && forbids(flow, modem_lines);
}

}  // namespace axisgate

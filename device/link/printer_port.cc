#include "device/link/printer_port.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>

#include "device/link/descriptor.h"

namespace axisgate {
namespace {

tl::unexpected<Problem> refuse_printer(const PrinterSettings& settings, std::string_view why, std::string hint = {}) {
  return fail(Reason::link_down, fmt::format("printer {}: {}", settings.path, why), std::move(hint));
}

tl::unexpected<Problem> refuse_to_open_printer(const PrinterSettings& settings, int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
      return refuse_printer(settings, "no such device",
                            "Check that the mill is on and plugged in, and that the path is right.");
    case EACCES:
    case EPERM:
      return refuse_printer(settings, "permission denied",
                            "Add the user that runs this program to the group lp and log in again.");
    case EBUSY:
      return refuse_printer(settings, "held by another process",
                            "Only one program can send to a mill: end the other one, such as a print spooler.");
    default:
      return refuse_printer(settings, std::generic_category().message(error));
  }
}

// Reports whether the path may be a printer: a file would accept any job, and a terminal would change its bytes.
bool may_be_printer(int port) {
  struct stat status {};
  return ::fstat(port, &status) == 0 && !S_ISREG(status.st_mode) && ::isatty(port) == 0;
}

}  // namespace

Result<int> open_printer(const PrinterSettings& settings) {
  Descriptor port(::open(settings.path.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!port.valid()) return refuse_to_open_printer(settings, errno);
  if (!may_be_printer(port.get())) {
    return refuse_printer(settings, "not a printer device",
                          "Check the path; a serial port is connection = \"serial\".");
  }
  return port.release();
}

}  // namespace axisgate

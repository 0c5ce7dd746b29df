#include "device/link/pty.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace axisgate {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Problem> refuse_pty(const std::string& link_path, const std::string& why, std::string hint = {}) {
  return fail(Reason::link_down, fmt::format("pseudo terminal {}: {}", link_path, why), std::move(hint));
}

std::string error_text(int number) { return std::generic_category().message(number); }

Result<void> place_link(const std::string& device, const std::string& link_path) {
  std::error_code error;
  const fs::file_status present = fs::symlink_status(link_path, error);
  if (fs::exists(present) && !fs::is_symlink(present)) {
    return refuse_pty(link_path, "something that is not a symbolic link is already there", "Choose another name.");
  }
  const std::string fresh = fmt::format("{}.{}.new", link_path, ::getpid());
  fs::create_symlink(device, fresh, error);
  if (!error) {
    fs::rename(fresh, link_path, error);
    std::error_code ignored;
    if (error) fs::remove(fresh, ignored);
  }
  if (error) return refuse_pty(link_path, "the symbolic link cannot be made: " + error.message());
  return {};
}

}  // namespace

Pty::Pty(Descriptor master, std::string device, std::string link)
    : master_(std::move(master)), device_(std::move(device)), link_(std::move(link)) {}

Pty::~Pty() {
  if (!master_.valid() || link_.empty()) return;
  std::error_code error;
  if (fs::read_symlink(link_, error) == device_) fs::remove(link_, error);
}

Pty& Pty::operator=(Pty&& other) noexcept {
  std::swap(master_, other.master_);
  std::swap(device_, other.device_);
  std::swap(link_, other.link_);
  return *this;
}

bool Pty::has_client() const {
  pollfd query{master_.get(), 0, 0};
  return ::poll(&query, 1, 0) == 0;
}

bool Pty::is_reserved() const {
  const Descriptor trial(::open(device_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!trial.valid()) return errno == EBUSY;
  int reserved = 0;
  return ::ioctl(trial.get(), TIOCGEXCL, &reserved) == 0 && reserved != 0;
}

// Two places keep unread bytes. One is the buffer between the ends, which the master can empty. The other is the line
// discipline of the other end, which is emptied when its mode is set with TCSAFLUSH; on Linux a master can set the mode
// of its other end.
void Pty::discard_unread() {
  termios mode{};
  ::tcflush(master_.get(), TCOFLUSH);
  if (::tcgetattr(master_.get(), &mode) == 0) ::tcsetattr(master_.get(), TCSAFLUSH, &mode);
}

void Pty::make_raw() {
  termios mode{};
  ::tcflush(master_.get(), TCOFLUSH);
  if (::tcgetattr(master_.get(), &mode) != 0) return;
  ::cfmakeraw(&mode);
  ::tcsetattr(master_.get(), TCSAFLUSH, &mode);
}

Result<Pty> open_pty(const std::string& link_path) {
  Descriptor master(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 64> device{};
  if (!master.valid() || ::grantpt(master.get()) != 0 || ::unlockpt(master.get()) != 0 ||
      ::ptsname_r(master.get(), device.data(), device.size()) != 0) {
    return refuse_pty(link_path, "none to be had: " + error_text(errno));
  }
  // Opens the other end once: the master sees that no client is there only after a client has been there.
  Descriptor(::open(device.data(), O_RDWR | O_NOCTTY | O_CLOEXEC)).reset();
  Pty pty(std::move(master), device.data(), {});
  pty.make_raw();
  if (auto placed = place_link(pty.device_, link_path); !placed) return tl::unexpected(placed.error());
  pty.link_ = link_path;
  return pty;
}

}  // namespace axisgate

#include "clients/axisctl/live_display.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>

#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

// Returns the width of the terminal; no limit if the terminal does not know its size.
std::size_t terminal_columns() {
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : std::string::npos;
}

}  // namespace

LiveDisplay::LiveDisplay() : terminal_(::isatty(STDOUT_FILENO) == 1) {}

LiveDisplay::~LiveDisplay() { finish(); }

void LiveDisplay::fact(std::string_view line) {
  const std::lock_guard lock(mutex_);
  erase();
  print_line(line);
  if (terminal_ && !shown_.empty()) put_in_place();
}

void LiveDisplay::in_place(const std::string& line) {
  const std::lock_guard lock(mutex_);
  if (line == shown_) return;
  shown_ = line;
  if (!terminal_) return print_line(line);
  erase();
  put_in_place();
}

void LiveDisplay::finish() {
  const std::lock_guard lock(mutex_);
  erase();
  std::fflush(stdout);
}

std::chrono::milliseconds LiveDisplay::interval() const { return std::chrono::milliseconds(terminal_ ? 100 : 500); }

void LiveDisplay::erase() {
  if (is_in_place_) std::fputs("\r\033[K", stdout);
  is_in_place_ = false;
}

void LiveDisplay::put_in_place() {
  std::fputs(shown_.substr(0, terminal_columns()).c_str(), stdout);
  std::fflush(stdout);
  is_in_place_ = true;
}

}  // namespace axisgate::axisctl

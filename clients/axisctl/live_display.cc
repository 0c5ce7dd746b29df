#include "clients/axisctl/live_display.h"

#include <unistd.h>

#include <cstdio>

#include "clients/axisctl/print.h"

namespace axisgate::axisctl {

LiveDisplay::LiveDisplay() : terminal_(::isatty(STDOUT_FILENO) == 1) {}

LiveDisplay::~LiveDisplay() { finish(); }

void LiveDisplay::fact(std::string_view line) {
  const std::lock_guard lock(mutex_);
  erase();
  print_line(line);
  if (terminal_ && !shown_.empty()) {
    std::fputs(shown_.c_str(), stdout);
    std::fflush(stdout);
    in_place_ = true;
  }
}

void LiveDisplay::positions(const std::string& line) {
  const std::lock_guard lock(mutex_);
  if (line == shown_) return;
  shown_ = line;
  if (!terminal_) return print_line(line);
  erase();
  std::fputs(line.c_str(), stdout);
  std::fflush(stdout);
  in_place_ = true;
}

void LiveDisplay::finish() {
  const std::lock_guard lock(mutex_);
  erase();
  std::fflush(stdout);
}

std::chrono::milliseconds LiveDisplay::interval() const { return std::chrono::milliseconds(terminal_ ? 100 : 500); }

void LiveDisplay::erase() {
  if (in_place_) std::fputs("\r\033[K", stdout);
  in_place_ = false;
}

}  // namespace axisgate::axisctl

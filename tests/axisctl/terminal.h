// Terminal in the place of a file descriptor.
#pragma once

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <string>

namespace axisgate::axisctl {

// A Terminal replaces a file descriptor until it is destroyed.
class Terminal {
 public:
  explicit Terminal(int replaced, unsigned short columns = 80) : replaced_(replaced), kept_(::dup(replaced)) {
    std::fflush(nullptr);  // earlier output must not reach the terminal
    winsize size{};
    size.ws_col = columns;
    int end = -1;
    EXPECT_EQ(::openpty(&person_, &end, nullptr, nullptr, &size), 0);
    ::dup2(end, replaced);
    ::close(end);
  }
  ~Terminal() {
    ::dup2(kept_, replaced_);
    ::close(kept_);
    ::close(person_);
  }

  void type(const std::string& text) { EXPECT_EQ(::write(person_, text.data(), text.size()), ssize_t(text.size())); }
  // Returns the next `count` bytes that were written to the terminal.
  std::string read(std::size_t count) {
    std::string text(count, '\0');
    for (std::size_t at = 0; at < count;) {
      const ssize_t more = ::read(person_, text.data() + at, count - at);
      if (more <= 0) return text.substr(0, at);
      at += static_cast<std::size_t>(more);
    }
    return text;
  }

 private:
  const int replaced_, kept_;
  int person_ = -1;
};

}  // namespace axisgate::axisctl

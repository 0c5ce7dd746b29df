// Where a verb writes a text that is meant to be kept.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace axisgate::axisctl {

// Throws Failure when the file cannot be made or written, and says why.
class Output {
 public:
  // "" or "-": the standard output. An existing file is overwritten.
  explicit Output(std::string path);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  // Handed to the system when it returns, so that an interruption later loses nothing.
  void write(std::string_view text);

  bool is_file() const { return file_ != stdout; }
  const std::string& path() const { return path_; }

 private:
  const std::string path_;
  std::FILE* file_ = stdout;
};

}  // namespace axisgate::axisctl

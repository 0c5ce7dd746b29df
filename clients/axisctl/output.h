// Output file of a verb that writes a text to keep.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace axisgate::axisctl {

// An Output is a file or the standard output. Throws Failure, with the reason, if the file cannot be created or
// written.
class Output {
 public:
  // Opens the file, and overwrites an existing one. "" or "-" means the standard output.
  explicit Output(std::string path);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  // Writes and flushes the text, so that a later interruption loses nothing.
  void write(std::string_view text);

  bool is_file() const { return file_ != stdout; }
  const std::string& path() const { return path_; }

 private:
  const std::string path_;
  std::FILE* file_ = stdout;
};

}  // namespace axisgate::axisctl

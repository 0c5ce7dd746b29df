// A small text in a mapped file of the state directory. If the process is killed, the newest complete text remains.
// Writing does not wait for the disk.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "device/core/problem.h"

namespace axisgate::server {

// Not thread safe, except sync().
class MappedText {
 public:
  static constexpr std::size_t kMax = 8192;  // bytes; more is cut off

  // Fails with internal if the file cannot be created or is not a regular file.
  static Result<std::unique_ptr<MappedText>> open(const std::string& path);
  ~MappedText();
  MappedText(const MappedText&) = delete;
  MappedText& operator=(const MappedText&) = delete;

  // Returns the newest text, which stays valid until the second replace() after this call.
  std::string_view text() const;
  void replace(const std::string& text);

  // Writes the newest text to the disk, so that it also survives a power cut. Waits for the disk. May be called from
  // any thread.
  void sync() const;

 private:
  struct Content;
  explicit MappedText(Content* content) : content_(content) {}
  std::size_t counting() const;

  Content* const content_;
};

}  // namespace axisgate::server

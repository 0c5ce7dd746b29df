// Progress on the standard output: facts line by line; positions rewritten in place at the bottom of a terminal, and
// line by line when the output is none.
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

namespace axisgate::axisctl {

// Thread safe.
class LiveDisplay {
 public:
  LiveDisplay();
  ~LiveDisplay();

  void fact(std::string_view line);
  // Nothing is shown when it is what was shown before.
  void positions(const std::string& line);
  // Takes the line in place away.
  void finish();

  // How often positions are worth asking for.
  std::chrono::milliseconds interval() const;

 private:
  void erase();

  const bool terminal_;
  std::mutex mutex_;
  std::string shown_;
  bool in_place_ = false;
};

}  // namespace axisgate::axisctl

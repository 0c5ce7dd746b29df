// Progress on the standard output: facts line by line; one line rewritten in place at the bottom of a terminal, such as
// positions, and line by line when the output is none.
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
  // Nothing is shown when it is what was shown before. A terminal shows as much of it as fits into a row, because only
  // one row is rewritten.
  void in_place(const std::string& line);
  // Takes the line in place away.
  void finish();

  // How often positions are worth asking for.
  std::chrono::milliseconds interval() const;

 private:
  void erase();
  void put_in_place();

  const bool terminal_;
  std::mutex mutex_;
  std::string shown_;
  bool is_in_place_ = false;
};

}  // namespace axisgate::axisctl

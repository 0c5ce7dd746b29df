// Progress on the standard output: facts line by line, and one line, such as positions, that is rewritten in place at
// the bottom of a terminal. If the output is not a terminal, this line is also printed line by line.
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
  // Shows the line that is rewritten in place, unless it has not changed. On a terminal it is cut to one row, because
  // only one row can be rewritten.
  void in_place(const std::string& line);
  // Erases the line that is rewritten in place.
  void finish();

  // Returns the useful interval between updates of the positions: shorter on a terminal.
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

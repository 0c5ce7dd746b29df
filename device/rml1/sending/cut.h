// Where a job may be cut in writes: a number that is cut in two would be executed as another one, if an abort came
// between.
#pragma once

#include <cstddef>
#include <string_view>

namespace axisgate::rml1 {

// Goes through a job, write after write. The job outlives it. In all it reads each byte a few times, however long a
// command is.
class Cutter {
 public:
  Cutter(std::string_view job, std::size_t window);

  // The next write: a command with the delimiters behind it. One that is longer than `window` is cut behind the comma
  // of a complete set of coordinates, where it has one. At the end of the job both are its size.
  std::size_t begin() const { return begin_; }
  std::size_t end() const { return end_; }
  void next();

 private:
  std::size_t find_end();
  std::size_t end_of_delimiters(std::size_t at) const;

  const std::string_view job_;
  const std::size_t window_;
  std::size_t set_ = 0;  // how many numbers make a set of the list in which the write begins; 0: it begins a command
  std::size_t begin_ = 0, end_ = 0;
};

}  // namespace axisgate::rml1

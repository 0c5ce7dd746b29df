// Record of the mill's actions as lines of JSON, which README.md lists.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/time.h"
#include "device/rml1/simulator/command.h"
#include "device/rml1/simulator/route.h"

namespace axisgate::rml1::simulator {

class Record {
 public:
  // `write` receives each line without its end.
  using Write = std::function<void(std::string_view line)>;

  explicit Record(Write write) : write_(std::move(write)) {}

  // Sets the time of all following lines, relative to the first call.
  void at(TimePoint now);

  void command(const Order& order, std::size_t buffered);
  void path(TimePoint began, const Position& from, const Position& to);
  void wait(std::string_view what, Duration time);
  void turn(double degrees);
  void spindle(double rpm);  // 0: stopped
  void error(int number);
  void panel(std::string_view what);
  void discarded(std::string_view by, std::size_t bytes);

 private:
  template <class... Values>
  void line(std::string_view format, const Values&... values);

  Write write_;
  TimePoint begin_{};
  Duration now_{};
  bool begun_ = false;
};

}  // namespace axisgate::rml1::simulator

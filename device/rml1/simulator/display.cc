#include "device/rml1/simulator/display.h"

#include <algorithm>

namespace axisgate::rml1::simulator {

void Display::command_error(int number) {
  const auto end = command_errors_.end();
  if (std::find(command_errors_.begin(), end, number) == end) command_errors_.push_back(number);
}

void Display::line_error(int number) {
  if (!line_error_) line_error_ = number;
}

void Display::clear() {
  command_errors_.clear();
  line_error_.reset();
}

std::string Display::text() const {
  std::string text;
  const auto add = [&text](int number) { text += (text.empty() ? "" : ",") + std::to_string(number); };
  for (const int number : command_errors_) add(number);
  if (line_error_) add(*line_error_);
  return text.empty() ? "none" : text;
}

}  // namespace axisgate::rml1::simulator

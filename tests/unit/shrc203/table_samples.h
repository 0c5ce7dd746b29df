// Random commands from the table's rows, for table_properties_test.cc.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/shot/command/pattern.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203 {

std::vector<std::string> words(std::string_view text);

struct Sample {
  using Values = std::vector<std::pair<std::string, std::string>>;
  Values values;
  std::vector<std::size_t> places;  // offset of each value in the line
  std::string line;                 // assembled here, not by the encoder

  Sample with(std::size_t which, std::string value) const;
  Arguments arguments() const;
};

// A SampleGenerator makes random commands. It interprets the format itself, so that it does not repeat the encoder's
// mistakes.
class SampleGenerator {
 public:
  SampleGenerator(const CommandRow& row, std::uint64_t seed) : row_(row), random_(seed) {}

  Sample sample();
  std::uint64_t below(std::uint64_t end) { return random_() % end; }

 private:
  void write(std::string_view format);
  void repeat(std::string_view inner);
  void add(std::string_view letter);
  std::string draw(const Parameter& parameter);
  std::string decimal(const Parameter& parameter);
  std::int64_t between(std::int64_t minimum, std::int64_t maximum);
  std::string fraction(std::int64_t whole);
  std::string text();

  const CommandRow& row_;
  std::mt19937_64 random_;
  Sample sample_;
  std::size_t repeats_ = 1;
  bool pulses_ = true;
  std::int64_t minimum_speed_ = 0;
};

}  // namespace axisgate::shrc203

// Tests of lines and columns within a long text.
#include "device/rml1/mill/place_index.h"

#include <gtest/gtest.h>

#include <string>

#include "device/rml1/mill/approach.h"

namespace axisgate::rml1 {
namespace {

void expect_each_place(const std::string& text) {
  const PlaceIndex index(text);
  for (std::size_t offset = 0; offset <= text.size(); ++offset) {
    ASSERT_EQ(index.at(offset), jobs::place_of(text, offset)) << offset;
  }
  EXPECT_EQ(index.at(text.size() + 1), jobs::place_of(text, text.size()));
}

TEST(APlaceIndex, HasEachPlace) {
  expect_each_place("");
  expect_each_place("PU;\nPD1,2;\n\nPU;");
  expect_each_place(std::string(4096, ';'));
  std::string lines;
  for (int i = 0; i < 2000; ++i) lines += std::string(static_cast<std::size_t>(i % 7), ';') + "\n";
  expect_each_place(lines);
}

TEST(APlaceIndex, OfOneLongLine) {
  const std::string text(10'000, ';');
  const PlaceIndex index(text);
  EXPECT_EQ(index.at(9'999), (jobs::Place{9'999, 1, 10'000}));
  EXPECT_EQ(index.at(4'096), (jobs::Place{4'096, 1, 4'097}));
}

}  // namespace
}  // namespace axisgate::rml1

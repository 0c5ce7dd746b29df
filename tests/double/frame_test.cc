// Tests of frames that are typed by hand.
#include "tests/double/frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace axisgate::rotor {
namespace {

using testing::ElementsAre;

TEST(RotorFrame, IsWhatTheProtocolSays) {
  const std::string move = encode({0x10, 7, -2});
  EXPECT_EQ(hex(move), "a5 10 07 ff ff ff fe b3");
  FrameParser parser;
  for (const char byte : move.substr(0, 7)) EXPECT_FALSE(parser.feed(byte));
  EXPECT_EQ(parser.feed(move[7]), (Frame{0x10, 7, -2}));
}

TEST(RotorFrame, IsFoundAfterGarbageAndBehindHalfAFrame) {
  const Frame first{0x90, 0xA5, 0x00A5A5A5}, second{0x82, 9, 12};
  const std::string stream = "\x01\xA5\x42" + encode({0x81, 1, 1}).substr(0, 5) + encode(first) + "\xA5" +
                             encode(second) + std::string(3, '\xA5') + encode(first);
  FrameParser parser;
  std::vector<Frame> found;
  for (const char byte : stream) {
    if (const auto frame = parser.feed(byte)) found.push_back(*frame);
  }
  EXPECT_THAT(found, ElementsAre(first, second, first));
}

TEST(RotorFrame, WithAFlippedBitIsNone) {
  for (std::size_t bit = 0; bit < 64; ++bit) {
    std::string bytes = encode({0x82, 3, 1234});
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    FrameParser parser;
    for (const char byte : bytes) EXPECT_FALSE(parser.feed(byte)) << "bit " << bit;
  }
}

}  // namespace
}  // namespace axisgate::rotor

// HTTP/2 frames; the expected bytes are RFC 9113's layouts, typed by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/http2/frames.h"

namespace axisgate::front::http2_frames_test {
namespace {

using namespace std::string_literals;
using testing::ElementsAre;
using testing::Pair;

const std::string kPing = "\0\0\x08\x06\0\0\0\0\0abcdefgh"s;
const std::string kData = "\0\0\x03\0\x01\0\0\0\x05xyz"s;

std::vector<std::string> payloads(FrameReader& reader, std::string_view bytes) {
  std::vector<std::string> heard;
  reader.feed(bytes, [&](const Frame& frame) {
    heard.emplace_back(frame.payload);
    return true;
  });
  return heard;
}

TEST(Http2Frames, AreCutOutOfBytesHoweverTheyCome) {
  const std::string both = kPing + kData;
  for (std::size_t cut = 0; cut <= both.size(); ++cut) {
    FrameReader reader;
    std::vector<std::string> heard = payloads(reader, both.substr(0, cut));
    for (std::string& more : payloads(reader, both.substr(cut))) heard.push_back(std::move(more));
    EXPECT_THAT(heard, ElementsAre("abcdefgh", "xyz")) << cut;
    EXPECT_FALSE(reader.in_frame());
  }
}

TEST(Http2Frames, SayWhatTheyAre) {
  FrameReader reader;
  reader.feed(kData, [](const Frame& frame) {
    EXPECT_EQ(frame.type, FrameType::data);
    EXPECT_TRUE(frame.has(FrameFlag::end_stream));
    EXPECT_FALSE(frame.has(FrameFlag::padded));
    EXPECT_EQ(frame.stream, 5u);
    EXPECT_EQ(frame.raw, kData);
    return true;
  });
}

TEST(Http2Frames, OneThatIsTooLongEndsTheReading) {
  FrameReader reader;
  const std::string longest = "\0\x40\0\0\0\0\0\0\1"s + std::string(16'384, 'a');
  EXPECT_EQ(payloads(reader, longest).size(), 1u);
  EXPECT_FALSE(reader.too_long());
  EXPECT_FALSE(reader.feed("\0\x40\1\0\0\0\0\0\1"s, [](const Frame&) { return true; }));
  EXPECT_TRUE(reader.too_long());
}

TEST(Http2Frames, AreWrittenAsTheyAreRead) {
  EXPECT_EQ(frame(FrameType::data, 1, 5, "xyz"), kData);
  EXPECT_EQ(ping_ack("abcdefgh"), "\0\0\x08\x06\1\0\0\0\0abcdefgh"s);
  EXPECT_EQ(settings_ack(), "\0\0\0\4\1\0\0\0\0"s);
  EXPECT_EQ(settings_frame({{4, 65'536}}), "\0\0\6\4\0\0\0\0\0\0\4\0\1\0\0"s);
  EXPECT_EQ(window_update(3, 258), "\0\0\4\x08\0\0\0\0\3\0\0\1\2"s);
  EXPECT_EQ(rst_stream(7, ErrorCode::no_error), "\0\0\4\3\0\0\0\0\7\0\0\0\0"s);
  EXPECT_EQ(goaway(9, ErrorCode::enhance_your_calm, "why"), "\0\0\x0b\7\0\0\0\0\0\0\0\0\x09\0\0\0\x0bwhy"s);
}

TEST(Http2Frames, SettingsAreSixBytesEach) {
  EXPECT_THAT(*settings_in("\0\4\0\0\1\0\0\5\0\0\x40\0"s), ElementsAre(Pair(4, 256), Pair(5, 16'384)));
  EXPECT_FALSE(settings_in("\0\4\0\0\1"s));
}

TEST(Http2Frames, ContentIsWithoutPaddingAndPriority) {
  const auto content = [](FrameType type, int flags, std::string_view payload) {
    return content_of({type, static_cast<std::uint8_t>(flags), 1, payload, {}});
  };
  EXPECT_EQ(content(FrameType::data, 0x8, "\2abc\0\0"s), "abc");
  EXPECT_EQ(content(FrameType::headers, 0x20, "\0\0\0\0\x10head"s), "head");
  EXPECT_EQ(content(FrameType::headers, 0x28, "\1\0\0\0\0\x10head\0"s), "head");
  EXPECT_FALSE(content(FrameType::data, 0x8, "\4abc"s));
  EXPECT_FALSE(content(FrameType::data, 0x8, ""));
  EXPECT_FALSE(content(FrameType::headers, 0x20, "\0\0\0\0"s));
}

}  // namespace
}  // namespace axisgate::front::http2_frames_test

// Messages of a request: whole or in pieces, plain or compressed, and within bounds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <string>

#include "server/front/request_body.h"

namespace axisgate::front::request_body_test {
namespace {

using namespace std::string_literals;

constexpr std::size_t kMost = 100'000, kAll = 150'000;
enum Format { gzip = 15 + 16, deflate = 15 };  // values of zlib's windowBits

std::string compressed(const std::string& text, Format format) {
  z_stream stream{};
  ::deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, format, 9, Z_DEFAULT_STRATEGY);
  std::string bytes(::deflateBound(&stream, text.size()) + 100, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  ::deflate(&stream, Z_FINISH);
  bytes.resize(stream.total_out);
  ::deflateEnd(&stream);
  std::string message = with_prefix(bytes);
  message[0] = 1;
  return message;
}

class RequestBodyTest : public testing::Test {
 protected:
  // Returns the gRPC code of the refusal; 0 if the bytes were accepted.
  int take(RequestBody& body, const std::string& bytes) {
    const auto refusal = body.take(bytes, out);
    return refusal ? refusal->code : 0;
  }

  HeldBytes all{kAll};
  std::string out;
};

TEST_F(RequestBodyTest, PlainMessagesPassInWhateverPieces) {
  const std::string both = with_prefix("one") + with_prefix("") + with_prefix("three");
  for (std::size_t cut = 0; cut <= both.size(); ++cut) {
    RequestBody body("", kMost, all);
    out.clear();
    EXPECT_EQ(take(body, both.substr(0, cut)), 0);
    EXPECT_EQ(body.unfinished(), cut != 0 && cut != 8 && cut != 13 && cut != both.size()) << cut;
    EXPECT_EQ(take(body, both.substr(cut)), 0);
    EXPECT_EQ(out, both);
    EXPECT_FALSE(body.unfinished());
  }
}

TEST_F(RequestBodyTest, CompressedOnesComeOutPlain) {
  for (const auto& [encoding, format] : {std::pair{"gzip", gzip}, {"deflate", deflate}}) {
    const std::string packed = compressed("message", format);
    for (std::size_t cut = 0; cut <= packed.size(); ++cut) {
      RequestBody body(encoding, kMost, all);
      out.clear();
      EXPECT_EQ(take(body, packed.substr(0, cut)), 0);
      EXPECT_EQ(take(body, packed.substr(cut) + with_prefix("plain")), 0);
      EXPECT_EQ(out, "\0\0\0\0\7message"s + with_prefix("plain")) << encoding << cut;
    }
  }
}

// .NET sends an empty message with gzip like this.
TEST_F(RequestBodyTest, AnEmptyMessageMayCallItselfCompressed) {
  RequestBody body("gzip", kMost, all);
  EXPECT_EQ(take(body, "\1\0\0\0\0"s), 0);
  EXPECT_EQ(out, "\0\0\0\0\0"s);
}

// Other requests have taken all the shared room.
TEST_F(RequestBodyTest, ACompressedStopFindsRoom) {
  Holding others(all);
  others.take(kAll);
  RequestBody body("gzip", kMost, all);
  EXPECT_EQ(take(body, compressed("stop", gzip)), 0);
  EXPECT_EQ(take(body, compressed(std::string(2'000, 'x'), gzip)), 8);
}

// A megabyte of zeros compresses to a thousand bytes.
TEST_F(RequestBodyTest, ABombIsRefusedBeforeItIsUnpacked) {
  RequestBody body("gzip", kMost, all);
  EXPECT_EQ(take(body, compressed(std::string(1 << 20, '\0'), gzip)), 8);
  EXPECT_EQ(out, "");
  EXPECT_LE(all.held(), kMost);
}

TEST_F(RequestBodyTest, AllTogetherAreBounded) {
  RequestBody first("gzip", kMost, all), second("gzip", kMost, all);
  EXPECT_EQ(take(first, compressed(std::string(90'000, '\0'), gzip)), 0);
  EXPECT_EQ(all.held(), 90'000u - 1024);
  EXPECT_EQ(take(second, compressed(std::string(90'000, '\0'), gzip)), 8);
  first.passed_on();
  RequestBody third("gzip", kMost, all);
  EXPECT_EQ(take(third, compressed(std::string(90'000, '\0'), gzip)), 0);
}

TEST_F(RequestBodyTest, WhatItHeldIsGivenBack) {
  {
    RequestBody body("gzip", kMost, all);
    const std::string packed = compressed(std::string(90'000, '\0'), gzip);
    take(body, packed.substr(0, packed.size() - 8));
    EXPECT_EQ(all.held(), 90'000u - 1024);
    EXPECT_EQ(body.take_cost(), 90'000u);
    EXPECT_EQ(body.take_cost(), 0u);
  }
  EXPECT_EQ(all.held(), 0u);
}

TEST_F(RequestBodyTest, WhatCannotBeReadIsRefused) {
  const std::string packed = compressed("message", gzip);
  std::string cut = with_prefix(packed.substr(5, packed.size() - 9)), longer = with_prefix(packed.substr(5) + "x");
  cut[0] = longer[0] = 1;
  const auto refused = [this](const char* encoding, const std::string& bytes) {
    RequestBody body(encoding, kMost, all);
    return take(body, bytes);
  };
  EXPECT_EQ(refused("gzip", cut), 3);
  EXPECT_EQ(refused("gzip", longer), 3);
  EXPECT_EQ(refused("gzip", "\1\0\0\0\3abc"s), 3);
  EXPECT_EQ(refused("gzip", "\2\0\0\0\3abc"s), 3);
  EXPECT_EQ(refused("", "\1\0\0\0\3abc"s), 3);
  EXPECT_EQ(refused("snappy", "\1\0\0\0\3abc"s), 12);
  EXPECT_EQ(refused("snappy", "\0\0\0\0\3abc"s), 0);
  EXPECT_EQ(refused("", "\0\0\1\x86\xa1"s), 8);  // 100,001 bytes
  EXPECT_EQ(refused("", "\0\0\1\x86\xa0"s), 0);
}

TEST_F(RequestBodyTest, OneMessageIsOne) {
  EXPECT_EQ(only_message(with_prefix("abc")), "abc");
  EXPECT_EQ(only_message(with_prefix("")), "");
  EXPECT_FALSE(only_message(""));
  EXPECT_FALSE(only_message("\0\0\0\0"s));
  EXPECT_FALSE(only_message(with_prefix("abc") + "d"));
  EXPECT_FALSE(only_message(with_prefix("abc").substr(0, 7)));
}

}  // namespace
}  // namespace axisgate::front::request_body_test

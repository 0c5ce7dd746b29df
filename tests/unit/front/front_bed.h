// A conversation with one client, whose filter the test controls. The test plays the client and gRPC, frame by frame.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/front/conversation.h"
#include "tests/http2/frames.h"
#include "tests/http2/header_codec.h"

namespace axisgate::front {

inline constexpr std::uint8_t kAck = 1, kEndStream = 1, kEndHeaders = 4;
inline constexpr FrontLimits kLimits{};

// Answer of a call; returns the replies that the test has given since the last take().
class TestAnswer final : public Answer {
 public:
  explicit TestAnswer(std::shared_ptr<std::vector<Reply>> replies) : replies_(std::move(replies)) {}
  std::vector<Reply> take() override { return std::exchange(*replies_, {}); }

 private:
  const std::shared_ptr<std::vector<Reply>> replies_;
};

// Decides by method: /forward forwards, /stop answers, /ask answers with a place; anything else is refused, /denied
// as a denied call.
class TestCallFilter final : public CallFilter {
 public:
  Decision decide(const Headers& headers, const Peer&, bool stops_only) override {
    const std::string path(find(headers, ":path").value_or(""));
    decided.push_back(path);
    if (path == "/stop") return {.what = Decision::What::answer, .uncounted = true};
    if (path == "/ask") return {.what = Decision::What::answer, .place = place};
    if (path == "/forward" && !stops_only) {
      return {.what = Decision::What::forward, .place = place, .path = "/forwarded", .caller = caller};
    }
    return {
        .what = Decision::What::refuse, .refusal = {.code = 7, .message = "no: 100 %"}, .denied = path == "/denied"};
  }
  Reply no_room() override { return {.code = 8, .message = "no room"}; }
  std::unique_ptr<Answer> answer(const Headers&, const Peer&, std::optional<std::string_view> message,
                                 std::function<void()> wake) override {
    auto replies = std::make_shared<std::vector<Reply>>();
    asked.emplace_back(std::optional<std::string>(message), [replies, wake = std::move(wake)](Reply reply) {
      replies->push_back(std::move(reply));
      wake();
    });
    return std::make_unique<TestAnswer>(std::move(replies));
  }

  std::shared_ptr<int> place = std::make_shared<int>();
  std::string caller;
  std::vector<std::string> decided;
  // Requests with their message; nullopt if the request was not exactly one message.
  std::vector<std::pair<std::optional<std::string>, std::function<void(Reply)>>> asked;
};

struct Seen {
  FrameType type;
  std::uint8_t flags;
  std::uint32_t stream;
  std::string payload;

  bool ends_stream() const { return (flags & kEndStream) != 0; }
};

inline std::vector<Seen> frames_in(FrameReader& reader, const std::string& bytes) {
  std::vector<Seen> seen;
  reader.feed(bytes, [&](const Frame& frame) {
    seen.push_back({frame.type, frame.flags, frame.stream, std::string(frame.payload)});
    return true;
  });
  return seen;
}

inline std::vector<Seen> only(FrameType type, std::vector<Seen> seen) {
  std::erase_if(seen, [type](const Seen& one) { return one.type != type; });
  return seen;
}

class ConversationTest : public testing::Test {
 protected:
  // Opens the conversation; afterwards both ends have exchanged their settings.
  void open(bool stops_only = false) {
    client_reader = server_reader = FrameReader();
    encoder = HeaderEncoder();
    grpc_encoder = HeaderEncoder();
    decoder = HeaderDecoder();
    grpc_decoder = HeaderDecoder();
    greeted = false;
    begin(stops_only);
    say(std::string(kPreface) + settings_frame({}) + settings_ack());
    EXPECT_THAT(only(FrameType::settings, heard()), testing::SizeIs(2));  // SETTINGS and the acknowledgement
  }
  void begin(bool stops_only = false) {
    conversation.emplace(
        shared, Peer{.who = "unix anna", .source = "uid 1"}, stops_only,
        [this](StreamId stream) { conversation->pull(stream); }, now);
  }
  void say(const std::string& bytes) { conversation->from_client(bytes, now); }
  void grpc_says(const std::string& bytes) { conversation->from_grpc(bytes); }

  static Headers headers_for(const std::string& path, Headers more = {}) {
    Headers headers = {{":method", "POST"}, {":scheme", "http"}, {":path", path},
                       {":authority", "x"}, {"te", "trailers"},  {"content-type", "application/grpc"}};
    for (Header& header : more) headers.push_back(std::move(header));
    return headers;
  }
  std::string call(std::uint32_t stream, const std::string& path, bool whole = false, Headers more = {}) {
    const auto flags = static_cast<std::uint8_t>(kEndHeaders | (whole ? kEndStream : 0));
    return frame(FrameType::headers, flags, stream, encoder.encode(headers_for(path, std::move(more))));
  }
  // Returns the header frame of gRPC's answer to a call; with `last` it is the whole answer.
  std::string answer(std::uint32_t stream, bool last) {
    return grpc_headers(stream, last, {{":status", "200"}, {"grpc-status", "0"}});
  }
  std::string trailers(std::uint32_t stream) { return grpc_headers(stream, true, {{"grpc-status", "0"}}); }
  std::string grpc_headers(std::uint32_t stream, bool last, const Headers& headers) {
    const auto flags = static_cast<std::uint8_t>(kEndHeaders | (last ? kEndStream : 0));
    return frame(FrameType::headers, flags, stream, grpc_encoder.encode(headers));
  }
  static std::string message(std::uint32_t stream, const std::string& text, bool last = true) {
    return frame(FrameType::data, last ? kEndStream : 0, stream, with_prefix(text));
  }
  std::vector<Seen> heard() { return frames_in(client_reader, conversation->take_to_client()); }
  // Returns the frames that gRPC receives. gRPC sends its SETTINGS at once, as a server does.
  std::vector<Seen> passed_on() {
    std::string bytes = conversation->take_to_grpc();
    if (bytes.starts_with(kPreface)) bytes.erase(0, kPreface.size());
    if (!bytes.empty() && !std::exchange(greeted, true)) grpc_says(settings_frame({}) + settings_ack());
    return frames_in(server_reader, bytes);
  }
  Headers headers_of(const Seen& seen) { return *decoder.decode(seen.payload, 1 << 16); }
  std::string fault() const { return conversation->fault() ? conversation->fault()->text : ""; }
  std::uint32_t error_told() {
    const std::vector<Seen> farewell = only(FrameType::goaway, heard());
    return farewell.empty() ? 0 : number_at(farewell.back().payload, 4);
  }

  TimePoint now{std::chrono::seconds(1)};
  TestCallFilter filter;
  Sources sources{kLimits.source};
  HeldBytes held{kLimits.held_bytes};
  Conversation::Shared shared{filter, kLimits, sources, held};
  std::shared_ptr<Source> source = sources.of("uid 1", now);
  std::optional<Conversation> conversation;
  HeaderEncoder encoder, grpc_encoder;
  HeaderDecoder decoder, grpc_decoder;
  FrameReader client_reader, server_reader;
  bool greeted = false;
};

}  // namespace axisgate::front

// Fuzzer of the front's HTTP/2, for any bytes from client and gRPC in any pieces: only whole frames are sent, calls end
// once, waiting data stays bounded, and nothing passes after a fault.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/front/conversation.h"
#include "tests/fuzz/require.h"
#include "tests/http2/frames.h"
#include "tests/http2/header_codec.h"

namespace {

using namespace axisgate;
using namespace axisgate::front;

constexpr FrontLimits kLimits{.message_bytes = 3'000, .stop_bytes = 1'000, .held_bytes = 6'000};

// The fuzzer's input, consumed from its beginning.
class Choices {
 public:
  explicit Choices(std::string_view bytes) : bytes_(bytes) {}

  bool none_left() const { return bytes_.empty(); }
  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const auto first = static_cast<std::uint8_t>(bytes_.front());
    bytes_.remove_prefix(1);
    return first;
  }
  std::string text() {
    const std::size_t size = std::min<std::size_t>(byte(), bytes_.size());
    const std::string taken(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return taken;
  }

 private:
  std::string_view bytes_;
};

class FuzzAnswer final : public Answer {
 public:
  explicit FuzzAnswer(std::shared_ptr<std::vector<Reply>> replies) : replies_(std::move(replies)) {}
  std::vector<Reply> take() override { return std::exchange(*replies_, {}); }

 private:
  const std::shared_ptr<std::vector<Reply>> replies_;
};

// Forwards /f, answers /s and /a, and refuses every other path.
class FuzzCallFilter final : public CallFilter {
 public:
  Decision decide(const Headers& headers, const Peer&, bool stops_only) override {
    const auto path = find(headers, ":path").value_or("");
    if (path == "/s") return {.what = Decision::What::answer, .uncounted = true};
    if (path == "/a") return {.what = Decision::What::answer, .place = std::make_shared<int>()};
    if (path == "/f" && !stops_only) {
      return {.what = Decision::What::forward, .place = std::make_shared<int>(), .path = "/g"};
    }
    return {.refusal = {.code = 12, .message = "no"}, .denied = path != "/f"};
  }
  Reply no_room() override { return {.code = 8, .message = "no room"}; }
  std::unique_ptr<Answer> answer(const Headers&, const Peer&, std::optional<std::string_view> message,
                                 std::function<void()> wake) override {
    require(!message || message->size() <= kLimits.message_bytes);
    auto replies = std::make_shared<std::vector<Reply>>();
    asked.push_back([replies, wake = std::move(wake)](Reply reply) {
      replies->push_back(std::move(reply));
      wake();
    });
    return std::make_unique<FuzzAnswer>(std::move(replies));
  }

  std::vector<std::function<void(Reply)>> asked;
};

class World {
 public:
  explicit World(bool stops_only) {
    conversation_.emplace(
        shared_, Peer{.who = "unix anna", .source = "uid 1"}, stops_only,
        [this](StreamId stream) { conversation_->pull(stream); }, now_);
    conversation_->from_client(kPreface, now_);
  }
  ~World() {
    conversation_.reset();
    require(held_.held() == 0);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void step(Choices& choices) {
    const bool over = conversation_->over();
    const std::uint8_t what = choices.byte();
    act(what, choices);
    const std::string to_client = conversation_->take_to_client(), to_grpc = conversation_->take_to_grpc();
    require(!over || conversation_->over());
    require(held_.held() <= kLimits.held_bytes);
    follow(to_client_, to_client);
    std::string_view bytes = to_grpc;
    if (!bytes.empty() && std::exchange(fresh_, false)) {
      require(bytes.starts_with(kPreface));
      bytes.remove_prefix(std::string_view(kPreface).size());
    }
    follow(to_grpc_, bytes);
  }

 private:
  void act(std::uint8_t what, Choices& choices) {
    constexpr std::uint8_t kActs = 12;
    switch (what % kActs) {
      case 0:
        return from_client(choices.text());
      case 1:
        return from_client(any_frame(choices));
      case 2:
        return from_client(call(choices));
      case 3:
        now_ += std::chrono::milliseconds(50 * choices.byte());
        return conversation_->check(now_, choices.byte() % 8 != 0);
      case 4:
        return from_grpc(any_frame(choices));
      case 5:
        if (filter_.asked.empty()) return;
        filter_.asked.back()({.body = choices.text(), .last = choices.byte() % 2 == 0});
        if (choices.byte() % 4 == 0) filter_.asked.pop_back();
        return;
      case 6:
        return from_client(settings_ack());
      case 7:
        return from_client(body(choices));
      case 8:
        return from_grpc(answer(choices));
      case 9:
        return from_grpc(settings_frame({}));
      case 10:
        if (choices.byte() % 8 == 0) conversation_->grpc_left();
        return;
      default:
        if (choices.byte() % 8 == 0) conversation_->grpc_failed();
    }
  }

  void from_client(const std::string& bytes) { conversation_->from_client(bytes, now_); }
  void from_grpc(const std::string& bytes) {
    if (!fresh_) conversation_->from_grpc(bytes);
  }

  static std::string any_frame(Choices& choices) {
    const auto type = static_cast<FrameType>(choices.byte() % 12);
    const std::uint8_t flags = choices.byte(), stream = choices.byte() % 16;
    return frame(type, flags, stream, choices.text());
  }

  static std::string call(Choices& choices) {
    static const std::vector<std::string> paths = {"/f", "/s", "/a", "/x"};
    const std::uint8_t flags = choices.byte(), stream = choices.byte() % 32;
    const std::uint8_t which = choices.byte();
    Headers headers = {{":method", "POST"},
                       {":scheme", "http"},
                       {":path", paths[which % paths.size()]},
                       {":authority", "x"},
                       {"content-type", "application/grpc"}};
    if (which & 0x80) headers.push_back({"grpc-encoding", "gzip"});
    return frame(FrameType::headers, flags | 4, stream, encode_without_table(headers));
  }

  // Returns a message whose length prefix is correct.
  static std::string body(Choices& choices) {
    const std::uint8_t flags = choices.byte() & 1, stream = choices.byte() % 32;
    std::string bytes = with_prefix(choices.text());
    bytes[0] = static_cast<char>(choices.byte() % 4 == 0);
    return frame(FrameType::data, flags, stream, bytes);
  }

  static std::string answer(Choices& choices) {
    const std::uint8_t flags = (choices.byte() & 1) | 4, stream = choices.byte() % 32;
    Headers headers = {{"grpc-status", "0"}};
    if (choices.byte() % 2 == 0) headers.insert(headers.begin(), {":status", "200"});
    return frame(FrameType::headers, flags, stream, encode_without_table(headers));
  }

  static void follow(FrameReader& reader, std::string_view bytes) {
    reader.feed(bytes, [](const Frame&) { return true; });
    require(!reader.too_long() && !reader.in_frame());
  }

  TimePoint now_{std::chrono::seconds(1)};
  FuzzCallFilter filter_;
  Sources sources_{kLimits.source};
  HeldBytes held_{kLimits.held_bytes};
  Conversation::Shared shared_{filter_, kLimits, sources_, held_};
  std::optional<Conversation> conversation_;
  FrameReader to_client_, to_grpc_;
  bool fresh_ = true;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices choices({reinterpret_cast<const char*>(data), size});
  World world(choices.byte() % 4 == 0);
  while (!choices.none_left()) world.step(choices);
  return 0;
}

// Whatever a client and gRPC send, in whatever pieces: what goes out is whole frames, calls end once, what waits stays
// bounded, and after a fault nothing passes any more.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/front/conversation.h"
#include "server/front/frames.h"
#include "server/front/header_codec.h"

namespace {

using namespace axisgate;
using namespace axisgate::front;

void require(bool good) {
  if (!good) std::abort();
}

// What the fuzzer chose, taken from the front.
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

// /f is forwarded, /s and /a answered, anything else refused.
class FuzzDesk final : public Desk {
 public:
  Verdict judge(const Headers& headers, const Peer&, bool stops_only) override {
    const auto path = find(headers, ":path").value_or("");
    if (path == "/s") return {.what = Verdict::What::answer};
    if (path == "/a") return {.what = Verdict::What::answer, .place = std::make_shared<int>()};
    if (path == "/f" && !stops_only) return {.what = Verdict::What::forward, .place = std::make_shared<int>()};
    return {.refusal = {.code = 12, .message = "no"}, .unwanted = path != "/f"};
  }
  Reply no_room() override { return {.code = 8, .message = "no room"}; }
  std::unique_ptr<Answer> answer(const Headers&, const Peer&, const std::string& message,
                                 std::function<void()> wake) override {
    require(message.size() <= 64 << 10);
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
  explicit World(bool stops_only)
      : conversation_(
            desk_, limits_, sources_, Peer{.who = "unix anna", .source = "uid 1"}, stops_only,
            [this](std::uint32_t stream) { conversation_.pull(stream); }, now_) {
    conversation_.from_client(kPreface, now_);
  }

  void step(Choices& choices) {
    const bool ended = conversation_.fault().has_value();
    const std::uint8_t what = choices.byte();
    act(what, choices);
    const std::string to_client = conversation_.take_to_client(), to_server = conversation_.take_to_server();
    require(!ended || to_server.empty());
    follow(to_client_, to_client);
    if (to_server.empty()) return;
    require(conversation_.upstream() == Conversation::Upstream::open);
    std::string_view bytes = to_server;
    if (std::exchange(fresh_, false)) {
      require(bytes.starts_with(kPreface));
      bytes.remove_prefix(std::string_view(kPreface).size());
    }
    follow(to_server_, bytes);
  }

 private:
  void act(std::uint8_t what, Choices& choices) {
    constexpr std::uint8_t kActs = 8;
    switch (what % kActs) {
      case 0:
        return conversation_.from_client(choices.text(), now_);
      case 1:
        return conversation_.from_client(any_frame(choices), now_);
      case 2:
        return conversation_.from_client(call(choices), now_);
      case 3:
        now_ += std::chrono::milliseconds(choices.byte());
        return;
      case 4:
        if (conversation_.upstream() == Conversation::Upstream::open) conversation_.from_server(any_frame(choices));
        return;
      case 5:
        if (desk_.asked.empty()) return;
        desk_.asked.back()({.body = choices.text(), .last = choices.byte() % 2 == 0});
        if (choices.byte() % 4 == 0) desk_.asked.pop_back();
        return;
      case 6:
        return conversation_.from_client(settings_ack(), now_);
      default:
        return conversation_.upstream_failed();
    }
  }

  static std::string any_frame(Choices& choices) {
    const auto type = static_cast<FrameType>(choices.byte() % 11);
    const std::uint8_t flags = choices.byte(), stream = choices.byte() % 16;
    return frame(type, flags, stream, choices.text());
  }

  static std::string call(Choices& choices) {
    static const std::vector<std::string> paths = {"/f", "/s", "/a", "/x"};
    const std::uint8_t flags = choices.byte(), stream = choices.byte() % 32;
    const Headers headers = {{":method", "POST"}, {":path", paths[choices.byte() % paths.size()]}};
    return frame(FrameType::headers, flags, stream, encode_without_table(headers));
  }

  static void follow(FrameReader& reader, std::string_view bytes) {
    reader.feed(bytes, [](const Frame&) { return true; });
    require(!reader.too_long() && !reader.in_frame());
  }

  static constexpr FrontLimits limits_{};
  TimePoint now_{std::chrono::seconds(1)};
  FuzzDesk desk_;
  Sources sources_{limits_.source};
  Conversation conversation_;
  FrameReader to_client_, to_server_;
  bool fresh_ = true;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices choices({reinterpret_cast<const char*>(data), size});
  World world(choices.byte() % 4 == 0);
  while (!choices.none_left()) world.step(choices);
  return 0;
}

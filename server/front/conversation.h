// One client's HTTP/2, from its first byte: passes on to gRPC what may pass, answers the rest, and says when the
// connection has cost too much. No I/O, no threads: bytes in, bytes out.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "device/core/time.h"
#include "server/front/budget.h"
#include "server/front/closing.h"
#include "server/front/desk.h"
#include "server/front/frames.h"
#include "server/front/header_codec.h"
#include "server/front/limits.h"
#include "server/front/own_calls.h"
#include "server/front/spending.h"

namespace axisgate::front {

class Conversation {
 public:
  // gRPC's side, which is opened with the first call that is its.
  enum class Upstream { none, open };
  // Why it ended, where this side ended it.
  struct Fault {
    ErrorCode code = ErrorCode::no_error;
    Closing why;
  };

  // `desk`, `limits` and `sources` outlive it.
  Conversation(Desk& desk, const FrontLimits& limits, Sources& sources, Peer peer, bool stops_only,
               OwnCalls::OnAnswer on_answer, TimePoint now);

  void from_client(std::string_view bytes, TimePoint now);
  void from_server(std::string_view bytes);
  // After on_answer: the desk has more for this call.
  void pull(std::uint32_t stream);

  // gRPC cannot be reached: its calls are refused, and from now on only stops are served.
  void upstream_failed();

  // What is to be written. Each is taken once.
  std::string take_to_client();
  std::string take_to_server() { return std::exchange(to_server_, {}); }
  bool has_for_client() const { return !to_client_.empty(); }
  bool has_for_server() const { return !to_server_.empty(); }
  // As much of it as a side may leave untaken: nothing more is read from the other.
  bool full() const { return to_client_.size() > kUntaken || to_server_.size() > kUntaken; }

  Upstream upstream() const { return upstream_; }
  const std::optional<Fault>& fault() const { return fault_; }
  // Nothing more is to be read from the client before then.
  TimePoint not_before() const { return spending_.not_before(); }
  bool stops_only() const { return stops_only_; }
  bool admitted() const { return spending_.admitted(); }  // a call was let in
  bool in_frame() const { return reader_.in_frame() || !preface_.empty() || block_; }
  std::size_t calls() const { return open_.size() + own_calls_.size(); }

 private:
  static constexpr std::size_t kUntaken = 64 << 10;

  // Headers that are not whole yet.
  struct Block {
    std::uint32_t stream = 0;
    bool ends_stream = false;
    std::size_t frames = 0;
    std::string bytes;
  };

  void end(ErrorCode code, std::string why);
  bool spend(Cost cost, double tokens);
  bool take_preface(std::string_view& bytes);

  bool take_frame(const Frame& frame);
  void take_headers(const Frame& frame);
  void take_continuation(const Frame& frame);
  void take_block(Block block);
  void take_data(const Frame& frame);
  void take_settings(const Frame& frame);
  void take_window_update(const Frame& frame);
  void widen(const Frame& frame);
  void take_reset(const Frame& frame);
  void take_ping(const Frame& frame);

  void begin_call(std::uint32_t stream, Headers headers, bool whole);
  void forward_headers(std::uint32_t stream, Headers headers, bool ends_stream);
  void refuse(std::uint32_t stream, const Reply& refusal, bool whole);
  void take_own_data(const Frame& frame);
  void ask_desk(std::uint32_t stream);
  void open_upstream();
  void give_back(std::size_t bytes);
  void tell_given_back();
  void send_answers();
  void send(const std::string& bytes);

  bool take_server_frame(const Frame& frame);
  void note_data(const Frame& frame);

  Desk& desk_;
  const FrontLimits& limits_;
  const Peer peer_;
  Spending spending_;
  bool stops_only_;
  TimePoint now_;
  std::optional<Fault> fault_;
  Upstream upstream_ = Upstream::none;

  std::string preface_{kPreface};  // what of it has not come yet
  FrameReader reader_, server_reader_;
  HeaderDecoder decoder_;
  HeaderEncoder encoder_;
  std::optional<Block> block_;
  std::uint32_t last_stream_ = 0;
  std::map<std::uint32_t, std::shared_ptr<void>> open_;  // gRPC's calls and their places
  OwnCalls own_calls_;

  // RFC 9113, 6.5: each SETTINGS is acknowledged once. The front sends and takes the first ones itself.
  std::map<std::uint16_t, std::uint32_t> client_settings_;
  int acks_for_front_ = 1;  // outstanding, of the client
  int acks_from_server_ = 0;

  // What the client lets the daemon send on the whole connection, and how much of that the front used without gRPC's
  // knowledge.
  std::int64_t window_ = kFirstWindow;
  std::int64_t window_used_ = 0;
  int acknowledgements_due_ = 0;  // WINDOW_UPDATEs for what gRPC has sent
  std::size_t untold_ = 0;        // bytes that the client may send again, and does not know
  bool in_server_block_ = false;
  std::string held_;  // until gRPC's headers have ended

  std::string to_client_, to_server_;
};

}  // namespace axisgate::front

#include "server/front/conversation.h"

#include <algorithm>
#include <utility>

#include "server/front/replies.h"

namespace axisgate::front {
namespace {

// A quarter of what a client may send before it must know that it may send more (RFC 9113, 6.9.2).
constexpr std::size_t kUntoldMax = 16 << 10;

std::uint8_t flags(bool end_headers, bool end_stream) {
  return static_cast<std::uint8_t>((end_headers ? static_cast<int>(FrameFlag::end_headers) : 0) |
                                   (end_stream ? static_cast<int>(FrameFlag::end_stream) : 0));
}

std::uint16_t id_of(SettingId id) { return static_cast<std::uint16_t>(id); }

// Longer frames and larger tables than the front's are nobody's: both sides have to do with the first values.
std::map<std::uint16_t, std::uint32_t> bounded(std::map<std::uint16_t, std::uint32_t> settings, bool from_server) {
  settings.erase(id_of(SettingId::max_frame_size));
  if (from_server) settings.erase(id_of(SettingId::header_table_size));
  return settings;
}

Cause cause_of(ErrorCode code) {
  return code == ErrorCode::enhance_your_calm ? Cause::over_budget : Cause::protocol_error;
}

bool is_own(const Header& header) { return header.name == kCallerHeader || header.name == kSourceHeader; }

bool ends_call(const Frame& frame) {
  const bool carries = frame.type == FrameType::headers || frame.type == FrameType::data;
  return frame.type == FrameType::rst_stream || (carries && frame.has(FrameFlag::end_stream));
}

}  // namespace

Conversation::Conversation(Desk& desk, const FrontLimits& limits, Sources& sources, Peer peer, bool stops_only,
                           OwnCalls::OnAnswer on_answer, TimePoint now)
    : desk_(desk),
      limits_(limits),
      peer_(std::move(peer)),
      spending_(limits, sources, peer_.source, now),
      stops_only_(stops_only),
      now_(now),
      own_calls_(desk, limits, peer_, std::move(on_answer)) {
  to_client_ =
      settings_frame({{id_of(SettingId::max_header_list_size), static_cast<std::uint32_t>(limits.header_bytes)}});
}

void Conversation::end(ErrorCode code, std::string why) {
  if (fault_) return;
  to_client_ += goaway(last_stream_, code, why);
  fault_ = Fault{code, {cause_of(code), std::move(why)}};
}

bool Conversation::spend(Cost cost, double tokens) {
  if (spending_.spend(cost, tokens, now_)) return true;
  end(ErrorCode::enhance_your_calm, "more frames a second than the daemon takes from one client");
  return false;
}

bool Conversation::take_preface(std::string_view& bytes) {
  const std::size_t size = std::min(preface_.size(), bytes.size());
  if (bytes.substr(0, size) != std::string_view(preface_).substr(0, size)) {
    end(ErrorCode::protocol_error, "this is not HTTP/2");
    return false;
  }
  preface_.erase(0, size);
  bytes.remove_prefix(size);
  return preface_.empty();
}

void Conversation::from_client(std::string_view bytes, TimePoint now) {
  now_ = now;
  if (fault_ || (!preface_.empty() && !take_preface(bytes))) return;
  reader_.feed(bytes, [this](const Frame& frame) { return take_frame(frame); });
  if (reader_.too_long()) end(ErrorCode::frame_size_error, "a frame is longer than 16384 bytes");
}

bool Conversation::take_frame(const Frame& frame) {
  if (block_ && (frame.type != FrameType::continuation || frame.stream != block_->stream)) {
    end(ErrorCode::protocol_error, "headers are not followed by their CONTINUATION");
    return false;
  }
  switch (frame.type) {
    case FrameType::headers:
      take_headers(frame);
      break;
    case FrameType::continuation:
      take_continuation(frame);
      break;
    case FrameType::data:
      take_data(frame);
      break;
    case FrameType::settings:
      take_settings(frame);
      break;
    case FrameType::window_update:
      take_window_update(frame);
      break;
    case FrameType::rst_stream:
      take_reset(frame);
      break;
    case FrameType::ping:
      take_ping(frame);
      break;
    case FrameType::push_promise:
      end(ErrorCode::protocol_error, "a client must not push");
      break;
    case FrameType::goaway:    // the client's connection ends when it closes it
    case FrameType::priority:  // nobody here has an order of streams
    default:
      spend(Cost::control, 1);
  }
  return !fault_;
}

void Conversation::take_headers(const Frame& frame) {
  const auto content = content_of(frame);
  if (!content || frame.stream % 2 == 0) {
    return end(ErrorCode::protocol_error, "HEADERS with a wrong stream or padding");
  }
  if (!spend(Cost::header_bytes, static_cast<double>(frame.payload.size()))) return;
  Block block{frame.stream, frame.has(FrameFlag::end_stream), 0, std::string(*content)};
  if (frame.has(FrameFlag::end_headers)) return take_block(std::move(block));
  block_ = std::move(block);
}

void Conversation::take_continuation(const Frame& frame) {
  if (!block_) return end(ErrorCode::protocol_error, "CONTINUATION without headers");
  block_->bytes.append(frame.payload);
  ++block_->frames;
  if (block_->frames > limits_.continuations || block_->bytes.size() > limits_.header_bytes) {
    return end(ErrorCode::enhance_your_calm, "too many headers");
  }
  if (!spend(Cost::header_bytes, static_cast<double>(frame.payload.size()))) return;
  if (!frame.has(FrameFlag::end_headers)) return;
  Block block = *std::move(block_);
  block_.reset();
  take_block(std::move(block));
}

void Conversation::take_block(Block block) {
  std::optional<Headers> headers = decoder_.decode(block.bytes, limits_.header_bytes);
  if (!headers) return end(ErrorCode::compression_error, "headers that cannot be read, or are too long");
  if (open_.contains(block.stream)) return forward_headers(block.stream, *std::move(headers), block.ends_stream);
  if (block.stream <= last_stream_) return;  // behind the end of its call
  last_stream_ = block.stream;
  if (!spend(Cost::stream, 1)) return;
  if (calls() >= limits_.open_calls) {
    return end(ErrorCode::enhance_your_calm, "too many calls are open on this connection");
  }
  begin_call(block.stream, *std::move(headers), block.ends_stream);
}

void Conversation::begin_call(std::uint32_t stream, Headers headers, bool whole) {
  const Verdict verdict = desk_.judge(headers, peer_, stops_only_);
  if (verdict.unwanted && !spend(Cost::refusal, 1)) return;
  if (!verdict.unwanted) spending_.admit(verdict.caller, now_);
  switch (verdict.what) {
    case Verdict::What::refuse:
      return refuse(stream, verdict.refusal, whole);
    case Verdict::What::forward:
      open_[stream] = verdict.place;
      std::erase_if(headers, is_own);
      headers.push_back({std::string(kCallerHeader), peer_.who});
      headers.push_back({std::string(kSourceHeader), peer_.source});
      return forward_headers(stream, std::move(headers), whole);
    case Verdict::What::answer:
      break;
  }
  if (!own_calls_.within_limits()) {
    return end(ErrorCode::enhance_your_calm, "too many stops, or requests in pieces, are open on this connection");
  }
  own_calls_.begin(stream, std::move(headers), verdict.place);
  if (whole) ask_desk(stream);
}

void Conversation::forward_headers(std::uint32_t stream, Headers headers, bool ends_stream) {
  open_upstream();
  const std::string block = encoder_.encode(headers);
  std::string_view rest = block;
  FrameType type = FrameType::headers;
  do {
    const std::string_view piece = rest.substr(0, kFramePayloadMax);
    rest.remove_prefix(piece.size());
    const bool first = type == FrameType::headers;
    to_server_ += frame(type, flags(rest.empty(), first && ends_stream), stream, piece);
    type = FrameType::continuation;
  } while (!rest.empty());
}

void Conversation::refuse(std::uint32_t stream, const Reply& refusal, bool whole) {
  send(ending_frame(stream, refusal, true));
  // What the client still sends of it is dropped.
  if (!whole) send(rst_stream(stream, ErrorCode::no_error));
}

void Conversation::ask_desk(std::uint32_t stream) {
  if (const auto refusal = own_calls_.ask(stream)) refuse(stream, *refusal, true);
}

void Conversation::pull(std::uint32_t stream) {
  own_calls_.pull(stream);
  send_answers();
}

// More when this has been written.
void Conversation::send_answers() {
  if (in_server_block_ || fault_ || full()) return;
  const std::int64_t before = window_;
  const std::string answers = own_calls_.frames(window_);
  window_used_ += before - window_;
  if (answers.empty()) return;
  tell_given_back();
  to_client_ += answers;
}

std::string Conversation::take_to_client() {
  std::string bytes = std::exchange(to_client_, {});
  send_answers();
  return bytes;
}

// Not between a HEADERS of gRPC and its CONTINUATION (RFC 9113, 6.10).
void Conversation::send(const std::string& bytes) { (in_server_block_ ? held_ : to_client_) += bytes; }

void Conversation::take_data(const Frame& frame) {
  if (frame.payload.empty() && !frame.has(FrameFlag::end_stream) && !spend(Cost::control, 1)) return;
  if (open_.contains(frame.stream)) {
    to_server_ += frame.raw;
    return;
  }
  give_back(frame.payload.size());
  if (own_calls_.has(frame.stream)) take_own_data(frame);
}

void Conversation::take_own_data(const Frame& frame) {
  const auto content = content_of(frame);
  if (!content) return end(ErrorCode::protocol_error, "DATA with a wrong padding");
  const bool whole = frame.has(FrameFlag::end_stream);
  if (const auto refusal = own_calls_.take(frame.stream, *content)) return refuse(frame.stream, *refusal, whole);
  if (whole) ask_desk(frame.stream);
}

// What gRPC did not see it does not allow to be sent again. The client learns of it with the next answer, or when it is
// much: a frame of its own would cost it a wake-up.
void Conversation::give_back(std::size_t bytes) {
  untold_ += bytes;
  if (untold_ >= kUntoldMax) tell_given_back();
}

void Conversation::tell_given_back() {
  if (untold_ > 0) send(window_update(0, static_cast<std::uint32_t>(std::exchange(untold_, 0))));
}

void Conversation::take_settings(const Frame& frame) {
  if (frame.has(FrameFlag::ack)) {
    if (acks_for_front_ > 0) {
      --acks_for_front_;
    } else if (upstream_ == Upstream::open) {
      to_server_ += frame.raw;
    }
    return;
  }
  const auto settings = settings_in(frame.payload);
  if (!settings) return end(ErrorCode::frame_size_error, "SETTINGS of a wrong length");
  if (!spend(Cost::settings, 1)) return;
  if (const auto first = settings->find(id_of(SettingId::initial_window_size)); first != settings->end()) {
    if (first->second > kWindowMax) return end(ErrorCode::flow_control_error, "a window that cannot be");
    own_calls_.set_first_window(first->second);
  }
  if (upstream_ == Upstream::open) {
    to_server_ += settings_frame(bounded(*settings, false));
    return;
  }
  for (const auto& [id, value] : *settings) {
    constexpr std::size_t kKept = 32;
    if (client_settings_.size() < kKept) client_settings_[id] = value;
  }
  send(settings_ack());
}

void Conversation::open_upstream() {
  if (std::exchange(upstream_, Upstream::open) == Upstream::open) return;
  to_server_ += kPreface;
  to_server_ += settings_frame(bounded(client_settings_, false));
  acks_from_server_ = 1;
  if (window_ > kFirstWindow) {
    to_server_ += window_update(0, static_cast<std::uint32_t>(window_ - kFirstWindow));
    window_used_ = 0;
  } else {
    window_used_ = kFirstWindow - window_;
  }
}

void Conversation::upstream_failed() {
  upstream_ = Upstream::none;
  stops_only_ = true;
  to_server_.clear();
  encoder_ = HeaderEncoder();
  for (const auto& [stream, place] : std::exchange(open_, {})) refuse(stream, desk_.no_room(), false);
}

void Conversation::take_window_update(const Frame& frame) {
  if (acknowledgements_due_ > 0) {
    --acknowledgements_due_;
  } else if (!spend(Cost::control, 1)) {
    return;
  }
  constexpr std::size_t kBytes = 4;
  if (frame.payload.size() != kBytes) return end(ErrorCode::frame_size_error, "WINDOW_UPDATE of a wrong length");
  if (frame.stream != 0) {
    if (open_.contains(frame.stream)) to_server_ += frame.raw;
    if (own_calls_.has(frame.stream)) widen(frame);
    return;
  }
  const std::int64_t bytes = number_at(frame.payload, 0) & kWindowMax;
  if (bytes == 0 || window_ + bytes > kWindowMax) return end(ErrorCode::protocol_error, "WINDOW_UPDATE out of range");
  window_ += bytes;
  if (upstream_ == Upstream::open) {
    const std::int64_t kept = std::min(bytes, window_used_);
    window_used_ -= kept;
    if (bytes > kept) to_server_ += window_update(0, static_cast<std::uint32_t>(bytes - kept));
  }
  send_answers();
}

void Conversation::widen(const Frame& frame) {
  if (!own_calls_.widen(frame.stream, number_at(frame.payload, 0) & kWindowMax)) {
    return end(ErrorCode::flow_control_error, "a window that cannot be");
  }
  send_answers();
}

void Conversation::take_reset(const Frame& frame) {
  if (!spend(Cost::reset, 1)) return;
  own_calls_.forget(frame.stream);
  if (open_.erase(frame.stream) > 0) to_server_ += frame.raw;
}

// The daemon's answer to a PING is the front's: gRPC would count pings, and close the connections of clients that keep
// themselves alive by them.
void Conversation::take_ping(const Frame& frame) {
  if (frame.has(FrameFlag::ack)) {
    if (upstream_ == Upstream::open) to_server_ += frame.raw;
    return;
  }
  constexpr std::size_t kBytes = 8;
  if (frame.payload.size() != kBytes) return end(ErrorCode::frame_size_error, "PING of a wrong length");
  if (spend(Cost::control, 1)) send(ping_ack(frame.payload));
}

void Conversation::from_server(std::string_view bytes) {
  server_reader_.feed(bytes, [this](const Frame& frame) { return take_server_frame(frame); });
}

bool Conversation::take_server_frame(const Frame& frame) {
  const bool block = frame.type == FrameType::headers || frame.type == FrameType::continuation;
  if (block) in_server_block_ = !frame.has(FrameFlag::end_headers);
  if (frame.type == FrameType::settings) {
    if (!frame.has(FrameFlag::ack)) {
      to_client_ +=
          settings_frame(bounded(settings_in(frame.payload).value_or(std::map<std::uint16_t, std::uint32_t>{}), true));
      return true;
    }
    if (acks_from_server_ > 0) {
      --acks_from_server_;
      return true;
    }
  }
  if (frame.type == FrameType::data) note_data(frame);
  to_client_ += frame.raw;
  if (ends_call(frame)) open_.erase(frame.stream);
  if (!in_server_block_) to_client_ += std::exchange(held_, {});
  send_answers();
  return true;
}

// Clients acknowledge what they were sent, on its stream and on the connection: that costs them nothing, or a thousand
// streams of events would be a flood.
void Conversation::note_data(const Frame& frame) {
  constexpr int kAcknowledgements = 2, kMost = 100'000;
  window_ -= static_cast<std::int64_t>(frame.payload.size());
  acknowledgements_due_ = std::min(acknowledgements_due_ + kAcknowledgements, kMost);
}

}  // namespace axisgate::front

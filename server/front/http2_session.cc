#include "server/front/http2_session.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace axisgate::front {
namespace {

std::string_view text_of(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

std::uint8_t* bytes_of(const std::string& text) {
  return reinterpret_cast<std::uint8_t*>(const_cast<char*>(text.data()));  // nghttp2's pointers are not const
}

std::vector<nghttp2_nv> fields_of(const Headers& headers) {
  std::vector<nghttp2_nv> fields;
  fields.reserve(headers.size());
  for (const Header& header : headers) {
    fields.push_back({.name = bytes_of(header.name),
                      .value = bytes_of(header.value),
                      .namelen = header.name.size(),
                      .valuelen = header.value.size(),
                      .flags = NGHTTP2_NV_FLAG_NONE});
  }
  return fields;
}

bool ends_stream(const nghttp2_frame& frame) { return (frame.hd.flags & NGHTTP2_FLAG_END_STREAM) != 0; }

}  // namespace

// The library's callbacks. Each calls its session.
struct Http2Session::Callbacks {
  static Http2Session& of(void* session) { return *static_cast<Http2Session*>(session); }
  static int answer(bool continues) { return continues ? 0 : NGHTTP2_ERR_CALLBACK_FAILURE; }

  static int frame_begun(nghttp2_session*, const nghttp2_frame_hd* frame, void* session) {
    return answer(of(session).events_.frame_begun(*frame));
  }
  static int block_begun(nghttp2_session*, const nghttp2_frame* frame, void* session) {
    const bool trailers = frame->headers.cat == NGHTTP2_HCAT_HEADERS;
    of(session).block_.emplace(HeaderBlock{.stream = frame->hd.stream_id, .headers = {}, .trailers = trailers});
    return 0;
  }
  static int header(nghttp2_session*, const nghttp2_frame*, const std::uint8_t* name, std::size_t name_size,
                    const std::uint8_t* value, std::size_t value_size, std::uint8_t, void* session) {
    of(session).header_came(text_of(name, name_size), text_of(value, value_size));
    return 0;
  }
  static int frame_came(nghttp2_session*, const nghttp2_frame* frame, void* session) {
    return answer(of(session).frame_came(*frame));
  }
  static int frame_refused(nghttp2_session*, const nghttp2_frame*, int, void* session) {
    return answer(of(session).events_.frame_refused());
  }
  static int data(nghttp2_session*, std::uint8_t, StreamId stream, const std::uint8_t* bytes, std::size_t size,
                  void* session) {
    return answer(of(session).events_.data_came(stream, text_of(bytes, size)));
  }
  static int frame_sent(nghttp2_session*, const nghttp2_frame* frame, void* session) {
    of(session).frame_sent(*frame);
    return 0;
  }
  static int not_sent(nghttp2_session*, const nghttp2_frame* frame, int, void* session) {
    if (frame->hd.type == NGHTTP2_HEADERS) of(session).headers_not_sent(frame->hd.stream_id);
    return 0;
  }
  static int skip_unknown(nghttp2_session*, void**, const nghttp2_frame_hd*, void*) { return NGHTTP2_ERR_CANCEL; }
  static int closed(nghttp2_session*, StreamId stream, std::uint32_t error, void* session) {
    of(session).closed(stream, error);
    return 0;
  }
  static ssize_t fill(nghttp2_session*, StreamId stream, std::uint8_t* buffer, std::size_t size, std::uint32_t* flags,
                      nghttp2_data_source* source, void*) {
    return of(source->ptr).fill(stream, buffer, size, flags);
  }

  static nghttp2_session_callbacks* make() {
    nghttp2_session_callbacks* all = nullptr;
    ::nghttp2_session_callbacks_new(&all);
    ::nghttp2_session_callbacks_set_on_begin_frame_callback(all, frame_begun);
    ::nghttp2_session_callbacks_set_on_begin_headers_callback(all, block_begun);
    ::nghttp2_session_callbacks_set_on_header_callback(all, header);
    ::nghttp2_session_callbacks_set_on_frame_recv_callback(all, frame_came);
    ::nghttp2_session_callbacks_set_on_invalid_frame_recv_callback(all, frame_refused);
    ::nghttp2_session_callbacks_set_on_data_chunk_recv_callback(all, data);
    ::nghttp2_session_callbacks_set_on_frame_send_callback(all, frame_sent);
    ::nghttp2_session_callbacks_set_on_frame_not_send_callback(all, not_sent);
    ::nghttp2_session_callbacks_set_on_stream_close_callback(all, closed);
    ::nghttp2_session_callbacks_set_unpack_extension_callback(all, skip_unknown);
    return all;
  }

  // The front has its own budgets; these limits are above them.
  static nghttp2_option* options() {
    constexpr std::size_t kAcks = 100'000, kSettings = 64, kContinuations = 64;
    constexpr std::uint64_t kResets = 1'000'000;
    nghttp2_option* all = nullptr;
    ::nghttp2_option_new(&all);
    ::nghttp2_option_set_no_auto_window_update(all, 1);
    ::nghttp2_option_set_peer_max_concurrent_streams(all, std::numeric_limits<std::int32_t>::max());
    ::nghttp2_option_set_max_outbound_ack(all, kAcks);
    ::nghttp2_option_set_max_settings(all, kSettings);
    ::nghttp2_option_set_max_continuations(all, kContinuations);
    ::nghttp2_option_set_stream_reset_rate_limit(all, kResets, kResets);
    // A blank at the end of a value is harmless, and some clients send one.
    ::nghttp2_option_set_no_rfc9113_leading_and_trailing_ws_validation(all, 1);
    // Otherwise the library skips frames of unknown types without a report.
    constexpr int kKnownTypes = 10, kTypes = 256;
    for (int type = kKnownTypes; type < kTypes; ++type) {
      ::nghttp2_option_set_user_recv_extension_type(all, static_cast<std::uint8_t>(type));
    }
    return all;
  }
};

Http2Session::Http2Session(Role role, const SessionTerms& terms, Events& events)
    : role_(role), terms_(terms), events_(events) {
  open(role);
}

void Http2Session::open(Role role) {
  static const nghttp2_session_callbacks* const kCallbacks = Callbacks::make();
  static const nghttp2_option* const kOptions = Callbacks::options();
  nghttp2_session* made = nullptr;
  std::vector<nghttp2_settings_entry> settings = {
      {NGHTTP2_SETTINGS_INITIAL_WINDOW_SIZE, terms_.stream_window},
      {NGHTTP2_SETTINGS_MAX_HEADER_LIST_SIZE, static_cast<std::uint32_t>(terms_.list_bytes)}};
  if (role == Role::server) {
    ::nghttp2_session_server_new2(&made, kCallbacks, this, kOptions);
    settings.push_back({NGHTTP2_SETTINGS_MAX_CONCURRENT_STREAMS, terms_.open_streams});
    settings.push_back({NGHTTP2_SETTINGS_NO_RFC7540_PRIORITIES, 1});
  } else {
    ::nghttp2_session_client_new2(&made, kCallbacks, this, kOptions);
    settings.push_back({NGHTTP2_SETTINGS_ENABLE_PUSH, 0});
  }
  session_.reset(made);
  ::nghttp2_submit_settings(made, NGHTTP2_FLAG_NONE, settings.data(), settings.size());
  ::nghttp2_session_set_local_window_size(made, NGHTTP2_FLAG_NONE, 0, terms_.connection_window);
}

bool Http2Session::feed(std::string_view bytes) {
  if (ended_) return false;
  const ssize_t taken =
      ::nghttp2_session_mem_recv(session_.get(), reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  if (taken >= 0) return true;
  if (ended_) return false;
  if (taken == NGHTTP2_ERR_BAD_CLIENT_MAGIC) {
    fail(NGHTTP2_PROTOCOL_ERROR, "this is not HTTP/2");
  } else if (taken == NGHTTP2_ERR_FLOODED) {
    fail(NGHTTP2_ENHANCE_YOUR_CALM, "more acknowledgements are due than the daemon keeps for one client");
  } else {
    fail(NGHTTP2_INTERNAL_ERROR, ::nghttp2_strerror(static_cast<int>(taken)));
  }
  return false;
}

void Http2Session::fail(std::uint32_t error, std::string_view why) {
  end(error, why);
  events_.failed(error, why);
}

std::string Http2Session::take(std::size_t limit) {
  std::string bytes;
  while (bytes.size() < limit) {
    const std::uint8_t* piece = nullptr;
    const ssize_t size = ::nghttp2_session_mem_send(session_.get(), &piece);
    if (size <= 0) break;
    bytes.append(text_of(piece, static_cast<std::size_t>(size)));
  }
  return bytes;
}

bool Http2Session::is_over() const { return ::nghttp2_session_want_read(session_.get()) == 0 && !has_more(); }

bool Http2Session::has_more() const { return ::nghttp2_session_want_write(session_.get()) != 0; }

void Http2Session::header_came(std::string_view name, std::string_view value) {
  block_->bytes += list_bytes(name.size(), value.size());
  block_->fits = block_->fits && block_->bytes <= terms_.list_bytes && block_->headers.size() < terms_.list_fields;
  if (block_->fits) block_->headers.push_back({std::string(name), std::string(value)});
}

bool Http2Session::frame_came(const nghttp2_frame& frame) {
  switch (frame.hd.type) {
    case NGHTTP2_HEADERS: {
      HeaderBlock block = *std::exchange(block_, std::nullopt);
      block.last = ends_stream(frame);
      if (role_ == Role::server && !block.trailers) take_turns(block.stream, NGHTTP2_EXTPRI_DEFAULT_URGENCY);
      return events_.headers_came(std::move(block));
    }
    case NGHTTP2_DATA:
      return !ends_stream(frame) || events_.stream_ended(frame.hd.stream_id);
    case NGHTTP2_GOAWAY:
      events_.going_away(frame.goaway.last_stream_id, frame.goaway.error_code);
      return true;
    default:
      return true;
  }
}

void Http2Session::frame_sent(const nghttp2_frame& frame) {
  if (frame.hd.type == NGHTTP2_GOAWAY && frame.goaway.error_code != NGHTTP2_NO_ERROR && !std::exchange(ended_, true)) {
    const std::string_view why = text_of(frame.goaway.opaque_data, frame.goaway.opaque_data_len);
    const std::uint32_t error = frame.goaway.error_code;
    return events_.failed(error, why.empty() ? ::nghttp2_http2_strerror(error) : why);
  }
  const bool carries = frame.hd.type == NGHTTP2_HEADERS || frame.hd.type == NGHTTP2_DATA;
  if (role_ == Role::client || !carries || !ends_stream(frame)) return;
  // An answered call ends here: the rest of its request is not read.
  const StreamId stream = frame.hd.stream_id;
  if (::nghttp2_session_get_stream_remote_close(session_.get(), stream) == 0) reset(stream, NGHTTP2_NO_ERROR);
}

// The headers of an answer were too long. The library itself closes the stream of a request refused after a GOAWAY.
void Http2Session::headers_not_sent(StreamId stream) {
  if (role_ == Role::server) reset(stream, NGHTTP2_INTERNAL_ERROR);
}

void Http2Session::closed(StreamId stream, std::uint32_t error) {
  const std::size_t left = unsent(stream);
  bodies_.erase(stream);
  events_.stream_closed(stream, error, left);
}

void Http2Session::request(StreamId stream, const Headers& headers, bool last) {
  const std::vector<nghttp2_nv> fields = fields_of(headers);
  nghttp2_data_provider body{.source = {.ptr = this}, .read_callback = Callbacks::fill};
  if (!last) bodies_.try_emplace(stream);
  ::nghttp2_session_set_next_stream_id(session_.get(), stream);
  ::nghttp2_submit_request(session_.get(), nullptr, fields.data(), fields.size(), last ? nullptr : &body, nullptr);
}

void Http2Session::respond(StreamId stream, const Headers& headers, bool last) {
  if (::nghttp2_session_find_stream(session_.get(), stream) == nullptr) return;
  const std::vector<nghttp2_nv> fields = fields_of(headers);
  nghttp2_data_provider body{.source = {.ptr = this}, .read_callback = Callbacks::fill};
  if (!last) bodies_.try_emplace(stream);
  ::nghttp2_submit_response(session_.get(), stream, fields.data(), fields.size(), last ? nullptr : &body);
}

void Http2Session::write(StreamId stream, std::string_view bytes) {
  const auto body = bodies_.find(stream);
  if (body == bodies_.end()) return;
  body->second.bytes.append(bytes);
  wake(stream, body->second);
}

void Http2Session::finish(StreamId stream, Headers trailers) {
  const auto body = bodies_.find(stream);
  if (body == bodies_.end()) return;
  body->second.trailers = std::move(trailers);
  body->second.finished = true;
  wake(stream, body->second);
}

void Http2Session::wake(StreamId stream, Body& body) {
  if (std::exchange(body.sleeps, false)) ::nghttp2_session_resume_data(session_.get(), stream);
}

ssize_t Http2Session::fill(StreamId stream, std::uint8_t* buffer, std::size_t size, std::uint32_t* flags) {
  Body& body = bodies_.at(stream);
  const std::size_t sent = std::min(size, body.left());
  if (sent == 0 && !body.finished) {
    body.sleeps = true;
    return NGHTTP2_ERR_DEFERRED;
  }
  std::memcpy(buffer, body.bytes.data() + body.at, sent);
  body.at += sent;
  constexpr std::size_t kSentMax = 64 << 10;
  if (body.left() == 0 || body.at > kSentMax) body.bytes.erase(0, std::exchange(body.at, 0));
  if (body.finished && body.left() == 0) {
    *flags |= NGHTTP2_DATA_FLAG_EOF;
    if (!body.trailers.empty()) {
      *flags |= NGHTTP2_DATA_FLAG_NO_END_STREAM;
      const std::vector<nghttp2_nv> fields = fields_of(body.trailers);
      ::nghttp2_submit_trailer(session_.get(), stream, fields.data(), fields.size());
    }
  }
  const bool ends = body.finished && body.left() == 0;
  if (sent > 0) events_.sent(stream, sent);
  if (ends) bodies_.erase(stream);
  return static_cast<ssize_t>(sent);
}

std::size_t Http2Session::unsent(StreamId stream) const {
  const auto body = bodies_.find(stream);
  return body == bodies_.end() ? 0 : body->second.left();
}

void Http2Session::reset(StreamId stream, std::uint32_t error) {
  ::nghttp2_submit_rst_stream(session_.get(), NGHTTP2_FLAG_NONE, stream, error);
}

void Http2Session::put_first(StreamId stream) { take_turns(stream, NGHTTP2_EXTPRI_URGENCY_HIGH); }

// Otherwise the library would send one answer completely before the next answer of the same urgency.
void Http2Session::take_turns(StreamId stream, std::uint32_t urgency) {
  const nghttp2_extpri priority{.urgency = urgency, .inc = 1};
  constexpr int kWhateverTheClientSays = 1;
  ::nghttp2_session_change_extpri_stream_priority(session_.get(), stream, &priority, kWhateverTheClientSays);
}

void Http2Session::consume(StreamId stream, std::size_t bytes) {
  if (bytes > 0) ::nghttp2_session_consume(session_.get(), stream, bytes);
}

void Http2Session::end(std::uint32_t error, std::string_view why) {
  if (ended_) return;
  ended_ = error != NGHTTP2_NO_ERROR;
  ::nghttp2_submit_goaway(session_.get(), NGHTTP2_FLAG_NONE, ::nghttp2_session_get_last_proc_stream_id(session_.get()),
                          error, reinterpret_cast<const std::uint8_t*>(why.data()), why.size());
}

}  // namespace axisgate::front

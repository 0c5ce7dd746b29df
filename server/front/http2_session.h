// One end of an HTTP/2 connection (RFC 9113), by nghttp2: bytes in, bytes out. Frames, compression of headers, flow
// control and the rules of the protocol are the library's. What a call means, and what it may cost, is its owner's.
#pragma once

#include <nghttp2/nghttp2.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "server/front/headers.h"

namespace axisgate::front {

using StreamId = std::int32_t;

// Headers that are whole.
struct HeaderBlock {
  StreamId stream = 0;
  Headers headers;        // those that fit into SessionTerms::list_bytes and list_fields
  std::size_t bytes = 0;  // of all of them, as list_bytes() counts
  bool fits = true;       // all of them did
  bool trailers = false;  // of a stream that has had headers
  bool last = false;      // nothing follows on this stream
};

// One end announces these bounds, and enforces them.
struct SessionTerms {
  std::size_t list_bytes = 0, list_fields = 0;  // of headers, or of trailers
  std::uint32_t open_streams = 0;               // which the other end may have at once; a server's only
  std::uint32_t stream_window = 0;              // bytes of a stream that may be underway to this end
  std::int32_t connection_window = 0;           // likewise of all streams together
};

// Not thread safe.
class Http2Session {
 public:
  enum class Role { server, client };

  // What happens, within feed() and take(). After a false, which end() came before, nothing more of the feed is read.
  class Events {
   public:
    virtual ~Events() = default;
    // Each frame, before its payload is read, also one that the library then ignores.
    virtual bool frame_begun(const nghttp2_frame_hd& frame) = 0;
    // One that is against the rules, so that its stream is reset.
    virtual bool frame_refused() = 0;
    virtual bool headers_came(HeaderBlock block) = 0;
    // Part of the payload of DATA; consume() allows as much to be sent again.
    virtual bool data_came(StreamId stream, std::string_view bytes) = 0;
    // The other end sends nothing more on this stream.
    virtual bool stream_ended(StreamId stream) = 0;
    // The stream has gone; of what was written to it `unsent` bytes were not sent.
    virtual void stream_closed(StreamId stream, std::uint32_t error, std::size_t unsent) = 0;
    // As many bytes of write() are on their way.
    virtual void sent(StreamId stream, std::size_t bytes) = 0;
    // The other end takes no new streams beyond `last`.
    virtual void going_away(StreamId last, std::uint32_t error) = 0;
    // The library ends the connection on its own account.
    virtual void failed(std::uint32_t error, std::string_view why) = 0;
  };

  // `events` outlives it.
  Http2Session(Role role, const SessionTerms& terms, Events& events);
  Http2Session(const Http2Session&) = delete;
  Http2Session& operator=(const Http2Session&) = delete;

  // False: the connection is over, and nothing more may be fed.
  bool feed(std::string_view bytes);
  // What is to be sent next; about `limit` bytes at most.
  std::string take(std::size_t limit);
  bool has_more() const;
  // Neither end will say more: the other sent a GOAWAY, and the last stream has ended.
  bool is_over() const;
  // Frames that wait to be taken.
  std::size_t waiting() const { return ::nghttp2_session_get_outbound_queue_size(session_.get()); }

  // A client's: opens a stream, with an odd number above all before. Its body follows by write() and finish(); there is
  // none, if `last`.
  void request(StreamId stream, const Headers& headers, bool last);
  // A server's: the head of an answer. Likewise.
  void respond(StreamId stream, const Headers& headers, bool last);
  // Part of a body. It waits until the other end's windows let it out.
  void write(StreamId stream, std::string_view bytes);
  // Behind all that was written. Without trailers the last bytes end the stream.
  void finish(StreamId stream, Headers trailers);
  void reset(StreamId stream, std::uint32_t error);
  // What of the body of this stream was not sent yet.
  std::size_t unsent(StreamId stream) const;
  // A server's: its answer goes before those of other streams, which otherwise take turns.
  void put_first(StreamId stream);

  // The other end may send as many bytes again, on this stream and on the connection; if the stream has gone, only on
  // the connection.
  void consume(StreamId stream, std::size_t bytes);

  // A server's: no new streams soon. What is open continues.
  void announce_end() { ::nghttp2_submit_shutdown_notice(session_.get()); }
  // Sends a GOAWAY that names the last stream that came. Without an error, open streams continue.
  void end(std::uint32_t error, std::string_view why);

 private:
  // The body of a stream.
  struct Body {
    std::string bytes;
    std::size_t at = 0;  // what was sent
    Headers trailers;
    bool finished = false;
    bool sleeps = false;  // the library does not ask until it is woken
    std::size_t left() const { return bytes.size() - at; }
  };
  struct Delete {
    void operator()(nghttp2_session* session) const { ::nghttp2_session_del(session); }
  };
  struct Callbacks;

  void open(Role role);
  void take_turns(StreamId stream, std::uint32_t urgency);
  ssize_t fill(StreamId stream, std::uint8_t* buffer, std::size_t size, std::uint32_t* flags);
  void wake(StreamId stream, Body& body);
  void fail(std::uint32_t error, std::string_view why);
  bool frame_came(const nghttp2_frame& frame);
  void frame_sent(const nghttp2_frame& frame);
  void headers_not_sent(StreamId stream);
  void closed(StreamId stream, std::uint32_t error);
  void header_came(std::string_view name, std::string_view value);

  const Role role_;
  const SessionTerms terms_;
  Events& events_;
  std::unique_ptr<nghttp2_session, Delete> session_;
  std::optional<HeaderBlock> block_;  // not whole yet
  std::unordered_map<StreamId, Body> bodies_;
  bool ended_ = false;
};

}  // namespace axisgate::front

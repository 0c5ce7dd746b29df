// One end of an HTTP/2 connection (RFC 9113): bytes in, bytes out. The library nghttp2 handles frames, header
// compression, flow control and the rules of the protocol. The owner decides about calls and their cost.
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

// Complete headers of a call or an answer.
struct HeaderBlock {
  StreamId stream = 0;
  Headers headers;        // headers that fit into SessionTerms::list_bytes and list_fields
  std::size_t bytes = 0;  // of all headers, as list_bytes() counts
  bool fits = true;       // all headers fit
  bool trailers = false;  // the stream has already had headers
  bool last = false;      // no data follows on this stream
};

// Limits that one end announces and enforces.
struct SessionTerms {
  std::size_t list_bytes = 0, list_fields = 0;  // of headers, or of trailers
  std::uint32_t open_streams = 0;               // that the other end may have at once; for a server only
  std::uint32_t stream_window = 0;              // bytes that the other end may send ahead on one stream
  std::int32_t connection_window = 0;           // the same for all streams together
};

// Not thread safe.
class Http2Session {
 public:
  enum class Role { server, client };

  // Events are called within feed() and take(). An event returns false after it has called end(); the rest of the feed
  // is then not read.
  class Events {
   public:
    virtual ~Events() = default;
    // Called for each frame before its payload is read, even if the library then ignores the frame.
    virtual bool frame_begun(const nghttp2_frame_hd& frame) = 0;
    // Called for a frame that breaks the rules and whose stream is therefore reset.
    virtual bool frame_refused() = 0;
    virtual bool headers_came(HeaderBlock block) = 0;
    // Delivers part of the payload of DATA. consume() allows the other end to send as much again.
    virtual bool data_came(StreamId stream, std::string_view bytes) = 0;
    // The other end sends nothing more on this stream.
    virtual bool stream_ended(StreamId stream) = 0;
    // The stream has closed; `unsent` bytes that were written to it were not sent.
    virtual void stream_closed(StreamId stream, std::uint32_t error, std::size_t unsent) = 0;
    // `bytes` of write() were put into frames.
    virtual void sent(StreamId stream, std::size_t bytes) = 0;
    // The other end takes no new streams beyond `last`.
    virtual void going_away(StreamId last, std::uint32_t error) = 0;
    // The library itself ends the connection.
    virtual void failed(std::uint32_t error, std::string_view why) = 0;
  };

  // `events` must outlive this object.
  Http2Session(Role role, const SessionTerms& terms, Events& events);
  Http2Session(const Http2Session&) = delete;
  Http2Session& operator=(const Http2Session&) = delete;

  // Returns false if the connection is over. Nothing more may then be fed.
  bool feed(std::string_view bytes);
  // Returns the next bytes to send, about `limit` at most.
  std::string take(std::size_t limit);
  bool has_more() const;
  // Reports whether neither end will send more: the other end sent a GOAWAY, and the last stream has ended.
  bool is_over() const;
  // Number of frames that wait to be taken.
  std::size_t waiting() const { return ::nghttp2_session_get_outbound_queue_size(session_.get()); }

  // Opens a stream of a client, with an odd number greater than all before. The body follows by write() and finish();
  // there is none if `last` is set.
  void request(StreamId stream, const Headers& headers, bool last);
  // Sends the head of a server's answer. `last` as above.
  void respond(StreamId stream, const Headers& headers, bool last);
  // Adds to a body. The bytes wait until the other end's windows allow them.
  void write(StreamId stream, std::string_view bytes);
  // Ends the body after all written bytes. Without trailers, the last bytes end the stream.
  void finish(StreamId stream, Headers trailers);
  void reset(StreamId stream, std::uint32_t error);
  // Returns the number of bytes of the stream's body that were not sent yet.
  std::size_t unsent(StreamId stream) const;
  // Puts a server's answer before those of other streams, which otherwise take turns.
  void put_first(StreamId stream);

  // Allows the other end to send as many bytes again, on this stream and on the connection; only on the connection if
  // the stream has closed.
  void consume(StreamId stream, std::size_t bytes);

  // Announces, as a server, that new streams will soon be refused. Open streams continue.
  void announce_end() { ::nghttp2_submit_shutdown_notice(session_.get()); }
  // Sends a GOAWAY that names the last stream received. Without an error, open streams continue.
  void end(std::uint32_t error, std::string_view why);

 private:
  // Body of a stream.
  struct Body {
    std::string bytes;
    std::size_t at = 0;  // bytes already sent
    Headers trailers;
    bool finished = false;
    bool sleeps = false;  // the library does not ask for more until wake()
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
  std::optional<HeaderBlock> block_;  // incomplete headers
  std::unordered_map<StreamId, Body> bodies_;
  bool ended_ = false;
};

}  // namespace axisgate::front

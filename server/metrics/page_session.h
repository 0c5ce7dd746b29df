// A connection to the metrics page: reads its requests, sends the answers, and ends when one of its limits passes.
// Boost.Beast speaks HTTP/1; page_session.cc alone includes it, because it takes long to compile.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "device/core/time.h"
#include "device/link/asio.h"
#include "device/link/descriptor.h"
#include "server/metrics/page_limits.h"

namespace axisgate::server {

// One text, shared by all readers.
using PageText = std::shared_ptr<const std::string>;
using TakePageText = std::function<PageText()>;

// Runs on the context's only thread. Its pending operations keep it alive.
class PageSession {
 public:
  virtual ~PageSession() = default;

  // Takes over the connection, and serves it. `limits` must outlive the session. Calls `take_text` only for an answer
  // that needs the text.
  static std::shared_ptr<PageSession> start(boost::asio::io_context& context, Descriptor connection,
                                            const PageLimits& limits, TakePageText take_text);

  // Closes the connection and discards unsent bytes.
  virtual void end() = 0;

  virtual bool is_open() const = 0;
  // Reports whether an answer is being sent.
  virtual bool is_answering() const = 0;
  virtual TimePoint since() const = 0;  // begin of the present state
};

}  // namespace axisgate::server

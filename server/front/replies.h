// Headers and trailers of calls that the front answers itself, in gRPC's protocol over HTTP/2.
#pragma once

#include "server/front/call_filter.h"
#include "server/front/headers.h"

namespace axisgate::front {

// Returns the headers before the first message of an answer.
Headers answer_head();
// Returns the trailers with the status, after the last message.
Headers trailers_of(const Reply& reply);
// Returns headers and status together, for an answer without a message.
Headers answer_without_body(const Reply& reply);

}  // namespace axisgate::front

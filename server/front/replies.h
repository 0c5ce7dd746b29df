// How a call is answered that gRPC does not see: by headers and trailers, as gRPC's protocol over HTTP/2 has them.
#pragma once

#include "server/front/desk.h"
#include "server/front/headers.h"

namespace axisgate::front {

// Before the first message of an answer.
Headers answer_head();
// The status follows the last one.
Headers trailers_of(const Reply& reply);
// Both in one, where there is no message.
Headers answer_without_body(const Reply& reply);

}  // namespace axisgate::front

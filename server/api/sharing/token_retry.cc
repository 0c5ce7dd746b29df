#include "server/api/sharing/token_retry.h"

#include "server/log.h"

namespace axisgate::api {

std::shared_ptr<TokenRetry> TokenRetry::make(server::Tokens& tokens, After after) {
  return std::shared_ptr<TokenRetry>(new TokenRetry(tokens, std::move(after)));
}

void TokenRetry::start(const Problem& why) {
  server::log::warn("{}; the revocation holds, and writing it is tried again every {} s", why.message,
                    std::chrono::duration_cast<std::chrono::seconds>(server::kTokenRetryPause).count());
  try_later();
}

void TokenRetry::try_later() {
  if (waiting_.exchange(true)) return;
  after_(server::kTokenRetryPause, [self = shared_from_this()] {
    // Reset before the attempt: a revocation that fails meanwhile schedules another one.
    self->waiting_ = false;
    const Result<bool> written = self->tokens_.write_again();
    if (!written) self->try_later();
    if (written && *written) server::log::info("the revocations of tokens that could not be written are on disk now");
  });
}

}  // namespace axisgate::api

// Revocations that could not be written to the disk are tried again until they can.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <utility>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "server/access/tokens.h"

namespace axisgate::api {

// Thread safe. The log says when it begins, and when the tokens are on disk.
class TokenRetry : public std::enable_shared_from_this<TokenRetry> {
 public:
  static constexpr Duration kPause = std::chrono::seconds(2);
  using After = std::function<void(Duration, std::function<void()>)>;  // Gateway::after()

  // `tokens` outlives the tasks that `after` receives; this need not.
  static std::shared_ptr<TokenRetry> make(server::Tokens& tokens, After after);

  // `why` is what Tokens::revoke() has answered.
  void start(const Problem& why);

 private:
  TokenRetry(server::Tokens& tokens, After after) : tokens_(tokens), after_(std::move(after)) {}
  void try_later();

  server::Tokens& tokens_;
  const After after_;
  std::atomic<bool> waiting_ = false;  // so that ten revocations are one try
};

}  // namespace axisgate::api

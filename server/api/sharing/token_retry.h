// Repeated attempts to write revocations that could not be written to the disk.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <utility>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "server/access/tokens.h"
#include "server/limits.h"

namespace axisgate::api {

// Thread safe. Logs when the attempts begin, and when the tokens are on the disk.
class TokenRetry : public std::enable_shared_from_this<TokenRetry> {
 public:
  using After = std::function<void(Duration, std::function<void()>)>;  // Gateway::after()

  // `tokens` must outlive the tasks that are passed to `after`; this object need not.
  static std::shared_ptr<TokenRetry> make(server::Tokens& tokens, After after);

  // `why` is the problem from Tokens::revoke().
  void start(const Problem& why);

 private:
  TokenRetry(server::Tokens& tokens, After after) : tokens_(tokens), after_(std::move(after)) {}
  void try_later();

  server::Tokens& tokens_;
  const After after_;
  std::atomic<bool> waiting_ = false;  // one attempt is scheduled, which serves all revocations up to then
};

}  // namespace axisgate::api

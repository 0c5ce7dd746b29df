#include "server/access/lease.h"

namespace axisgate::server {

std::string_view name(AtLoss at_loss) {
  switch (at_loss) {
    case AtLoss::finish:
      return "finish";
    case AtLoss::stop:
      return "stop";
    case AtLoss::stop_and_release:
      break;
  }
  return "stop_and_release";
}

std::string_view name(LeaseEnding::Why why) {
  using enum LeaseEnding::Why;
  switch (why) {
    case released:
      return "released";
    case expired:
      return "expired";
    case handed_over:
      return "handed_over";
    case taken_over:
      return "taken_over";
    case cut_off:
      return "cut_off";
    case token_revoked:
      return "token_revoked";
    case restarted:
      break;
  }
  return "restarted";
}

std::string text_of(const LeaseEnding& ending) {
  using enum LeaseEnding::Why;
  switch (ending.why) {
    case released:
      return "it was released";
    case expired:
      return "it was not kept alive and expired";
    case handed_over:
      return "it was handed over to " + ending.who;
    case taken_over:
      return "it was taken over by " + ending.who;
    case cut_off:
      return "its holder was cut off";
    case token_revoked:
      return "its token was revoked by " + ending.who;
    case restarted:
      break;
  }
  return "the controller may have restarted";
}

}  // namespace axisgate::server

#include "device/stage/event.h"

namespace axisgate::stage {

std::string_view name(TimeLimitPassed::Kind kind) {
  switch (kind) {
    case TimeLimitPassed::Kind::reply:
      return "reply";
    case TimeLimitPassed::Kind::probe:
      return "probe";
    case TimeLimitPassed::Kind::queue:
      break;
  }
  return "queue";
}

std::string_view name(ExchangeEnded::Outcome outcome) {
  switch (outcome) {
    case ExchangeEnded::Outcome::ok:
      return "ok";
    case ExchangeEnded::Outcome::ok_d:
      return "ok_d";
    case ExchangeEnded::Outcome::ng:
      return "ng";
    case ExchangeEnded::Outcome::ng_i:
      return "ng_i";
    case ExchangeEnded::Outcome::data:
      return "data";
    case ExchangeEnded::Outcome::timed_out:
      return "timed_out";
    case ExchangeEnded::Outcome::garbled:
      return "garbled";
    case ExchangeEnded::Outcome::link_lost:
      return "link_lost";
  }
  return "garbled";
}

}  // namespace axisgate::stage

// What one connection costs: its own budgets, and those that it shares with others of its source and of its caller.
// No threads.
#pragma once

#include <memory>
#include <string>

#include "device/core/time.h"
#include "server/front/budget.h"
#include "server/front/limits.h"

namespace axisgate::front {

class Spending {
 public:
  // `sources` outlives it. `source` is Peer::source.
  Spending(const FrontLimits& limits, Sources& sources, const std::string& source, TimePoint now);

  // False: the connection must end. What may wait is read later instead: not_before().
  bool spend(Cost cost, double tokens, TimePoint now);
  // A call was let in: Verdict::caller.
  void admit(const std::string& caller, TimePoint now);

  bool admitted() const { return admitted_; }
  // Nothing more is to be read from the client before then.
  TimePoint not_before() const { return not_before_; }

 private:
  Duration debt_of_others(Cost cost, double tokens, TimePoint now);

  Sources& sources_;
  const std::shared_ptr<Source> source_;
  std::string caller_;                        // the last one who was let in by a name
  std::shared_ptr<Source> caller_elsewhere_;  // with all connections of this caller; none without a name
  Budget own_, spared_;
  Budget stranger_;  // as long as nobody was let in
  bool admitted_ = false;
  TimePoint not_before_{};
};

}  // namespace axisgate::front

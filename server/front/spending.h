// Costs of one connection: its own budgets, and those shared with other connections of its source and of its caller. No
// threads.
#pragma once

#include <memory>
#include <string>

#include "device/core/time.h"
#include "server/front/budget.h"
#include "server/front/limits.h"

namespace axisgate::front {

class Spending {
 public:
  // `sources` must outlive this object. `source` is Peer::source.
  Spending(const FrontLimits& limits, Sources& sources, const std::string& source, TimePoint now);

  // Returns false if the connection must end. Costs that may wait delay the reading instead: not_before().
  bool spend(Cost cost, double tokens, TimePoint now);
  // Called when a call was let in; `caller` is Decision::caller.
  void admit(const std::string& caller, TimePoint now);

  bool admitted() const { return admitted_; }
  // Earliest time at which the client may be read again.
  TimePoint not_before() const { return not_before_; }

 private:
  Duration debt_of_others(Cost cost, double tokens, TimePoint now);

  Sources& sources_;
  const std::shared_ptr<Source> source_;
  std::string caller_;                        // the last admitted caller with a name
  std::shared_ptr<Source> caller_elsewhere_;  // budget over all connections of this caller; null without a name
  Budget own_, guaranteed_;
  Budget stranger_;  // until a call is let in
  bool admitted_ = false;
  TimePoint not_before_{};
};

}  // namespace axisgate::front

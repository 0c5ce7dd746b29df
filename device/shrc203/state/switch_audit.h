// Which memory switches a visit to their edit mode changes for good (manual 117) to 126)): their values before the
// first line that sets any of their item, compared with those at the end of the visit.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "device/shrc203/command/codec.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

class SwitchAudit {
 public:
  using Values = std::vector<std::string>;  // of an item's switches, from number 0 on

  // The item, 0 to 8, whose switches the line sets; nothing for any other.
  static std::optional<int> item_set_by(const Command& command);
  // The question for all switches of the item (manual 124) MS:GETK).
  static Command question_of(int item);

  bool knows(int item) const { return before_.contains(item); }
  // Nothing where the controller does not tell.
  void before(int item, std::optional<Values> values);
  void after(int item, std::optional<Values> values);
  std::vector<int> items() const;  // that have a before

  // What is to be reported; nothing where nothing has changed.
  std::optional<SwitchesChanged> result(const std::string& who) const;

 private:
  std::map<int, std::optional<Values>> before_, after_;
};

}  // namespace axisgate::shrc203

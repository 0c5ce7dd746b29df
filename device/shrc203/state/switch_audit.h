// Lasting changes of memory switches by a visit to their edit mode (manual 117) to 126)): the values before the first
// line that sets any switch of an item, compared with those at the end of the visit.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "device/shot/command/command.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

class SwitchAudit {
 public:
  using Values = std::vector<std::string>;  // values of an item's switches, from number 0 on

  // Returns the item, 0 to 8, whose switches the line sets; nullopt for any other line.
  static std::optional<int> item_set_by(const Command& command);
  // Returns the question for all switches of the item (manual 124) MS:GETK).
  static Command question_of(int item);

  bool knows(int item) const { return before_.contains(item); }
  // `values` is nullopt if the controller does not report them.
  void before(int item, std::optional<Values> values);
  void after(int item, std::optional<Values> values);
  std::vector<int> items() const;  // items passed to before()

  // Returns the changes to report; nullopt if there are none.
  std::optional<SwitchesChanged> result(const std::string& who) const;

 private:
  std::map<int, std::optional<Values>> before_, after_;
};

}  // namespace axisgate::shrc203

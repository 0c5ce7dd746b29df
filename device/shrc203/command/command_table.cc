#include "device/shrc203/command/command_table.h"

#include <utility>
#include <vector>

#include "device/shrc203/command/rows.h"

namespace axisgate::shrc203 {
namespace {

std::vector<CommandRow> all_rows() {
  std::vector<CommandRow> table;
  for (const auto part : {rows::questions(), rows::motion(), rows::arcs(), rows::settings(), rows::other_modes(),
                          rows::saved_positions()}) {
    table.insert(table.end(), part.begin(), part.end());
  }
  return table;
}

// Manual 109) P:C, 110) P:T.
const std::vector<Notice> kNotices = {{"COMP", ProgramNotice::Kind::ended}, {"TRIG", ProgramNotice::Kind::trigger}};

}  // namespace

const Model& model() {
  static const Model only("SHRC-203", kAxisCount, all_rows(), kNotices);
  return only;
}

}  // namespace axisgate::shrc203

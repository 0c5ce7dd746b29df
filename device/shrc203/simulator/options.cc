#include "device/shrc203/simulator/options.h"

#include <algorithm>
#include <array>
#include <vector>

namespace axisgate::shrc203::simulator {
namespace {

using Values = std::array<std::string_view, 3>;

struct OptionRow {
  std::string_view name;
  Values values;  // the first is the default; unused places stay empty
};

constexpr std::array kRows = {
    OptionRow{"busy_scope", {"axis", "controller"}},
    OptionRow{"prebuffer_scope", {"axis", "controller"}},
    OptionRow{"prebuffer_while_other_axis_runs", {"waits_for_go", "chains", "ng"}},
    OptionRow{"prebuffer_under_plain_move", {"chains", "waits_for_go"}},
    OptionRow{"go_with_both_buffers", {"prebuffer_replaces", "execution_first", "ng"}},
    OptionRow{"chain_step_on", {"each_axis", "all_axes_done"}},
    OptionRow{"interpolation_completion", {"each_axis_ascending", "lowest_axis"}},
    OptionRow{"completion_after_stop", {"none", "sent"}},
    OptionRow{"completion_before_settle", {"yes", "no"}},
    OptionRow{"wait_completion", {"none", "sent"}},
    OptionRow{"wait_reply_while_running", {"ok", "ok_d"}},
    OptionRow{"stop_keeps_prebuffer", {"cleared", "kept", "starts_next"}},
    OptionRow{"stop_with_unexcited_axis", {"ng_all", "stops_excited"}},
    OptionRow{"limit_error_until", {"bec", "next_start"}},
    OptionRow{"emergency_excitation", {"off", "on"}},
    OptionRow{"speed_when_unexcited", {"accepted", "ng"}},
    OptionRow{"previous_command_counts_refused", {"yes", "no"}},
    OptionRow{"late_go_order", {"reply_first", "completion_first"}},
    OptionRow{"jog_survives_gc", {"yes", "no"}},
    OptionRow{"jog_override_afterwards", {"becomes_maximum", "forgotten"}},
    OptionRow{"q_s_sign", {"plus", "bare"}},
    OptionRow{"command_error_status", {"normal_stays", "normal_clears"}},
    OptionRow{"invalid_axis_fields", {"three_fields", "left_out", "three_fields_everywhere"}},
    OptionRow{"fraction_of_pulse", {"round", "truncate", "ng"}},
};

std::span<const std::string_view> values_of(const OptionRow& row) {
  const auto end = std::find(row.values.begin(), row.values.end(), std::string_view{});
  return {row.values.begin(), end};
}

std::vector<OptionName> make_names() {
  std::vector<OptionName> names;
  for (const OptionRow& row : kRows) names.push_back({row.name, values_of(row)});
  return names;
}

}  // namespace

std::span<const OptionName> option_names() {
  static const std::vector<OptionName> names = make_names();
  return names;
}

Options::Options() : NamedOptions(option_names(), "simulated SHRC-203") {}

}  // namespace axisgate::shrc203::simulator

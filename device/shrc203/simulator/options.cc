#include "device/shrc203/simulator/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

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

std::vector<std::string_view> all_names() {
  std::vector<std::string_view> names;
  for (const OptionRow& row : kRows) names.push_back(row.name);
  return names;
}

}  // namespace

std::span<const OptionName> option_names() {
  static const std::vector<OptionName> names = make_names();
  return names;
}

Options::Options() {
  for (const OptionName& option : option_names()) chosen_.push_back(option.values.front());
}

Result<void> Options::set(std::string_view name, std::string_view value) {
  const auto names = option_names();
  const auto option = std::find_if(names.begin(), names.end(), [&](const OptionName& o) { return o.name == name; });
  if (option == names.end()) {
    return fail(Reason::invalid_request, fmt::format("The simulated SHRC-203 has no option '{}'.", name),
                fmt::format("Name one of: {}.", fmt::join(all_names(), ", ")));
  }
  const auto chosen = std::find(option->values.begin(), option->values.end(), value);
  if (chosen == option->values.end()) {
    return fail(Reason::invalid_request,
                fmt::format("The option '{}' of the simulated SHRC-203 cannot be '{}'.", name, value),
                fmt::format("Give one of: {}.", fmt::join(option->values, ", ")));
  }
  chosen_[static_cast<std::size_t>(option - names.begin())] = *chosen;
  return {};
}

std::string_view Options::get(std::string_view name) const {
  const auto names = option_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].name == name) return chosen_[i];
  }
  return {};
}

std::string Options::describe() const {
  std::string text;
  const auto names = option_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += fmt::format("{}{}={}", i == 0 ? "" : " ", names[i].name, chosen_[i]);
  }
  return text;
}

}  // namespace axisgate::shrc203::simulator

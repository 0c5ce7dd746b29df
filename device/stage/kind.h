// The interface of a kind of stage controller. The controller's folder implements it; server/kinds.cc lists all kinds.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/core/simulation.h"
#include "device/stage/command_info.h"
#include "device/stage/event.h"
#include "device/stage/position_slot.h"
#include "device/stage/profile.h"
#include "device/stage/settings.h"
#include "device/stage/stage_controller.h"
#include "device/stage/state.h"
#include "device/use/permission.h"

namespace axisgate::stage {

// Features of a stage. Its controller fails with not_allowed for each that it does not have.
enum class Capability {
  move,
  home,
  return_to_origin,
  jog,
  path,
  arc,
  scan,
  saved_positions,
  settings,
  pins,
  trigger,
  commands,
};

// A KindSetting is a configuration key of the device's table that only this kind has.
struct KindSetting {
  std::string_view key;
  std::span<const std::string_view> words;  // allowed values; empty: true or false
  std::string_view otherwise;               // default: one of the words, or "true" or "false"
};

// An AdminCommand changes a controller for all its callers. Only administrators may use it unless the configuration
// leaves it out of its list.
struct AdminCommand {
  enum class Request { none, clear_errors, reset };

  std::string_view name;            // beginning of its lines; any word for a kind without lines
  Request request = Request::none;  // request that sends the command
};

// A Kind is stateless and may be used from any thread.
class Kind {
 public:
  virtual ~Kind() = default;

  virtual std::string_view name() const = 0;  // value of `kind` in the configuration
  virtual int axis_count() const = 0;         // axes of the largest unit, 1 to kAxesMax
  virtual std::span<const KindSetting> settings() const = 0;

  // `settings` has an allowed value for each of settings(). The other arguments must outlive the controller.
  virtual std::unique_ptr<StageController> make_controller(const Profile& profile, const Words& settings,
                                                           ByteLink& link, EventSink& events,
                                                           use::Permission& permission) const = 0;

  // Checks a caller's own lines, as far as the lines alone allow. Fails with malformed_line, unknown_command,
  // incomplete_transaction or invalid_request.
  virtual Result<void> check_lines(const std::vector<std::string>& lines) const = 0;
  // Reports whether checked lines move or change something. False if one of them is a stop, which never waits.
  virtual bool changes_something(const std::vector<std::string>&) const { return false; }

  // The functions from here to read_position() are optional. By default a kind can move, home, return to the origin and
  // jog, and has none of the other features.
  virtual std::span<const Capability> capabilities() const;  // ascending
  virtual std::vector<CommandInfo> commands() const;         // in the manual's order

  virtual std::span<const AdminCommand> admin_commands() const;

  // Returns the lines of one transaction that make the setting, in order; empty if nothing has to change. Fails with
  // out_of_range or not_representable; with invalid_request if the kind has no such setting.
  virtual Result<std::vector<std::string>> lines_for(const Setting& setting, const State& state) const;

  // The lines that ask for Settings, each sent as its own transaction. read_setting() adds the answer of one line to
  // `settings`, and ignores an answer that it cannot read.
  virtual std::span<const std::string_view> setting_questions() const;
  virtual void read_setting(std::string_view question, std::string_view answer, const State& state,
                            Settings& settings) const;

  // Returns the lines for a saved position. read_position() returns the coordinates in pulses by axis from the answer
  // to PositionLines::tell; empty if the answer has none.
  virtual std::optional<PositionLines> position_lines(const PositionSlot& slot) const;
  virtual std::map<int, std::int64_t> read_position(const PositionSlot& slot, std::string_view answer,
                                                    const State& state) const;

  // Checks one option of a simulation; the error names the allowed values.
  virtual Result<void> check_option(std::string_view name, std::string_view value) const = 0;
  // Makes a simulation from checked options. `line` must outlive it.
  virtual std::unique_ptr<Simulation> make_simulation(const Words& options, ByteLink& line) const = 0;
};

}  // namespace axisgate::stage

// What a kind of stage controller brings along. A controller's folder implements it; server/kinds.cc lists all of them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/stage/command_info.h"
#include "device/stage/event.h"
#include "device/stage/permission.h"
#include "device/stage/position_slot.h"
#include "device/stage/profile.h"
#include "device/stage/settings.h"
#include "device/stage/stage_controller.h"
#include "device/stage/state.h"

namespace axisgate::stage {

// A key of the device's table in the configuration that this kind alone has.
struct KindSetting {
  std::string_view key;
  std::span<const std::string_view> words;  // what it may say; empty: true or false
  std::string_view otherwise;               // without the key: one of the words, or "true" or "false"
};

// What changes a controller for all its callers, and so is for administrators unless the configuration leaves it out.
struct AdminCommand {
  enum class Request { none, clear_errors, reset };

  std::string_view name;            // how its lines begin; of a kind without lines, any word
  Request request = Request::none;  // the one that sends it
};

// Words by key: those of KindSettings, or the options of a simulation.
using Words = std::map<std::string, std::string, std::less<>>;

// A device that exists in this process only.
class Simulation : public LineMachine {
 public:
  // What a person does and sees at the device; the answer is for people. invalid_request.
  virtual Result<std::string> operate(std::string_view command, TimePoint now) = 0;
};

// Stateless; from any thread.
class Kind {
 public:
  virtual ~Kind() = default;

  virtual std::string_view name() const = 0;  // what `kind` says in the configuration
  virtual std::span<const KindSetting> settings() const = 0;

  // `settings` holds a permitted word for each of settings(). The others outlive the controller.
  virtual std::unique_ptr<StageController> make_controller(const Profile& profile, const Words& settings,
                                                           ByteLink& link, EventSink& events,
                                                           Permission& permission) const = 0;

  // Checks a caller's own lines, as far as the lines themselves allow it: malformed_line, unknown_command,
  // incomplete_transaction, invalid_request.
  virtual Result<void> check_lines(const std::vector<std::string>& lines) const = 0;
  // Whether checked lines move or change something. Not where one of them is a stop, which waits for nothing.
  virtual bool changes_something(const std::vector<std::string>&) const { return false; }

  // From here to read_position(): what a kind need not have. Nothing, where it has none of it.
  virtual std::vector<CommandInfo> commands() const;  // in the manual's order

  virtual std::span<const AdminCommand> admin_commands() const;

  // The lines of one transaction that set it, in their order; none, where nothing is to change. out_of_range,
  // not_representable; invalid_request, where there is no such setting.
  virtual Result<std::vector<std::string>> lines_for(const Setting& setting, const State& state) const;

  // The lines that ask for Settings, each a transaction of its own; and what the answer to one adds to them. Of an
  // answer that is none nothing is taken.
  virtual std::span<const std::string_view> setting_questions() const;
  virtual void read_setting(std::string_view question, std::string_view answer, const State& state,
                            Settings& settings) const;

  // What is sent about a position that it keeps; and the coordinates in pulses, by axis, in the answer to
  // PositionLines::tell: empty where it is none.
  virtual std::optional<PositionLines> position_lines(const PositionSlot& slot) const;
  virtual std::map<int, std::int64_t> read_position(const PositionSlot& slot, std::string_view answer,
                                                    const State& state) const;

  // One option of a simulation; what is wrong with it names what may be chosen.
  virtual Result<void> check_option(std::string_view name, std::string_view value) const = 0;
  // Of checked options. `line` outlives it.
  virtual std::unique_ptr<Simulation> make_simulation(const Words& options, ByteLink& line) const = 0;
};

}  // namespace axisgate::stage

// Handshake after a connect: identity, mode and dialect, all axes stationary, and the settings.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/previous_run.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/session/settings_reader.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/state/state_store.h"
#include "device/use/permission.h"

namespace axisgate::shrc203 {

// Result of ?:MODE and ?:FMT.
enum class FrontPanelRead { fit, wrong, unreadable, format_unreadable };

class Handshake {
 public:
  Handshake(Dialogue& dialogue, Line& line, Reader& reader, SettingsReader& settings, Stops& stops,
            StopWriter& stop_writer, PreviousRun& previous_run, StateStore& store, Motions& motions,
            Registers& registers, NonHost& non_host, Permission& permission, Tasks& tasks)
      : dialogue_(dialogue),
        line_(line),
        reader_(reader),
        settings_(settings),
        stops_(stops),
        stop_writer_(stop_writer),
        previous_run_(previous_run),
        store_(store),
        motions_(motions),
        registers_(registers),
        non_host_(non_host),
        permission_(permission),
        tasks_(tasks) {}

  // Opens the line if all checks pass, and disconnects otherwise. Ends early if another connection has begun.
  Task<void> run(Identity identity, std::uint64_t connection);

 private:
  bool is_expected(const Identity& identity);
  Task<std::optional<FrontPanelRead>> read_panel(std::uint64_t connection);
  Task<bool> wait_for_host_mode(std::uint64_t connection);
  Task<bool> wait_until_all_ready(std::uint64_t connection);
  std::string_view origin_of_motion() const;
  Task<void> wait_for_others();
  Task<void> come_back();

  Dialogue& dialogue_;
  Line& line_;
  Reader& reader_;
  SettingsReader& settings_;
  Stops& stops_;
  StopWriter& stop_writer_;
  PreviousRun& previous_run_;
  StateStore& store_;
  Motions& motions_;
  Registers& registers_;
  NonHost& non_host_;
  Permission& permission_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203

// Names of saved positions, which controllers keep by number only: twenty places (manual 127) PIT:) and twenty sets of
// coordinates (manual 132) PAV:) each.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/stage/state.h"

namespace axisgate::server {

// Epochs and frame in which a coordinate is valid. None of the members has a meaning in another run of the daemon.
struct Frame {
  std::uint64_t device_epoch = 0, frame_epoch = 0;
  // Number of homings of each axis. Homing changes coordinates without raising the frame epoch.
  std::array<int, stage::kAxesMax> homings{};
  std::array<std::optional<Decimal>, stage::kAxesMax> per_pulse;

  friend bool operator==(const Frame&, const Frame&) = default;
};
Frame frame_of(const stage::State& state);

struct SavedPosition {
  std::string device, name;
  bool place = true;                          // true: PIT:; false: PAV:
  int number = 0;                             // number in the controller
  std::map<int, std::int64_t> coordinates{};  // coordinates at the time of saving, by axis, in pulses
  std::chrono::sys_seconds saved{};
  std::string who{};            // caller, as in Motion.who
  std::string serial_number{};  // serial number of the controller that keeps the position
  // Frame in which the controller was last known to keep the position at these coordinates; nullopt: not in this run of
  // the daemon.
  std::optional<Frame> frame{};
};

// Thread safe. Functions that write wait for the disk; the others never wait, even while another thread writes.
class SavedPositions {
 public:
  static constexpr int kNumbers = 20;
  static constexpr std::size_t kNameMax = 40;

  // Reads the positions of the file, which need not exist. Fails with internal if the file cannot be read or is
  // malformed; the message names the fault and its line.
  static Result<std::unique_ptr<SavedPositions>> open(std::string path);

  std::optional<SavedPosition> find(const std::string& device, const std::string& name) const;
  std::vector<SavedPosition> list(const std::string& device) const;  // ordered by name

  // Reserves a number of the given kind for a position that is being saved under the name: the name's present number,
  // or the lowest free one. The number stays reserved until its last copy is destroyed, which this object must outlive.
  // Fails with queue_full if no number is free.
  // Fails with invalid_request if the name is malformed, or, with `only_new`, if a position with this name exists or is
  // being saved.
  using Number = std::shared_ptr<const int>;
  Result<Number> take_number(const std::string& device, const std::string& name, bool place, bool only_new);

  // Keeps a position, and replaces any other with this name. Fails with internal if the file cannot be written; nothing
  // changes then.
  Result<void> keep(SavedPosition position);
  // Forgets a position. Has no effect if no position has this name. Fails with internal if the file cannot be written;
  // nothing changes then.
  Result<void> forget(const std::string& device, const std::string& name);

  // Records the frame in which the controller was seen to keep the position; nullopt: it may keep another position by
  // now. Has no effect if the name now refers to another position.
  void held_in(const SavedPosition& position, const std::optional<Frame>& frame);

 private:
  struct Taken {
    std::string device, name;
    bool place = true;
    int number = 0;
  };
  using Positions = std::map<std::pair<std::string, std::string>, SavedPosition>;  // positions by device and name

  explicit SavedPositions(std::string path) : path_(std::move(path)) {}
  Result<void> read();
  Result<void> write(const Positions& positions) const;
  bool is_free(const std::string& device, bool place, int number) const;
  void give_back(const Taken& taken);

  const std::string path_;
  std::mutex writing_;  // locked before mutex_
  mutable std::mutex mutex_;
  Positions positions_;
  std::vector<Taken> taken_;
};

// Reports whether the name has 1 to kNameMax letters, digits, '-' and '_'.
bool is_position_name(std::string_view name);

}  // namespace axisgate::server

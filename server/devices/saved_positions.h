// What positions are called that controllers keep by number only: twenty places (manual 127) PIT:) and twenty sets of
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

// Of which epoch a coordinate is, and in which frame. None of it means anything in another run of the daemon.
struct Frame {
  std::uint64_t device_epoch = 0, frame_epoch = 0;
  // Homing changes coordinates without raising the frame epoch.
  std::array<int, stage::kAxisCount> homings{};
  std::array<std::optional<Decimal>, stage::kAxisCount> per_pulse;

  friend bool operator==(const Frame&, const Frame&) = default;
};
Frame frame_of(const stage::State& state);

struct SavedPosition {
  std::string device, name;
  bool place = true;                          // PIT:, else PAV:
  int number = 0;                             // the controller's
  std::map<int, std::int64_t> coordinates{};  // when it was saved, by axis, in pulses
  std::chrono::sys_seconds saved{};
  std::string who{};            // as in Motion.who
  std::string serial_number{};  // of the controller that holds it
  // In which the controller was last known to hold it at these coordinates; nothing: not in this run of the daemon.
  std::optional<Frame> frame{};
};

// Thread safe. What writes waits for the disk; nothing else does, also while another writes.
class SavedPositions {
 public:
  static constexpr int kNumbers = 20;
  static constexpr std::size_t kNameMax = 40;

  // Those of the file, which need not be there. internal, where it cannot be read or is none: the message says what and
  // in which line.
  static Result<std::unique_ptr<SavedPositions>> open(std::string path);

  std::optional<SavedPosition> find(const std::string& device, const std::string& name) const;
  std::vector<SavedPosition> list(const std::string& device) const;  // by name

  // A number of that kind for what is being saved under the name: its own, or the lowest that no name has. Nobody else
  // gets it before the last copy has gone, which this outlives. queue_full where there is none; invalid_request for a
  // name that is none, and with `only_new` for one that is there or being saved.
  using Number = std::shared_ptr<const int>;
  Result<Number> take_number(const std::string& device, const std::string& name, bool place, bool only_new);

  // In the place of what had that name. internal, where it cannot be written: then all is as before.
  Result<void> keep(SavedPosition position);
  // Nothing where there is none of that name. internal, likewise.
  Result<void> forget(const std::string& device, const std::string& name);

  // The controller was seen to hold it in that frame; nothing: it may hold something else by now. No effect once the
  // name means another position.
  void held_in(const SavedPosition& position, const std::optional<Frame>& frame);

 private:
  struct Taken {
    std::string device, name;
    bool place = true;
    int number = 0;
  };
  using Positions = std::map<std::pair<std::string, std::string>, SavedPosition>;  // by device and name

  explicit SavedPositions(std::string path) : path_(std::move(path)) {}
  Result<void> read();
  Result<void> write(const Positions& positions) const;
  bool is_free(const std::string& device, bool place, int number) const;
  void give_back(const Taken& taken);

  const std::string path_;
  std::mutex writing_;  // taken before the other
  mutable std::mutex mutex_;
  Positions positions_;
  std::vector<Taken> taken_;
};

// 1 to kNameMax letters, digits, '-' and '_'.
bool is_position_name(std::string_view name);

}  // namespace axisgate::server

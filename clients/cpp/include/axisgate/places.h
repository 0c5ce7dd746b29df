// Saved positions of a stage.
#pragma once

#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "axisgate/results.h"

namespace axisgate {

namespace client {
class DeviceSession;
}

// Places are the saved positions of a stage, by name. All functions are thread safe.
class AXISGATE_PUBLIC Places {
 public:
  explicit Places(std::shared_ptr<client::DeviceSession> session) : session_(std::move(session)) {}

  // Saves the present position. It stays the same place when coordinates are set again.
  void save(const std::string& name) const;
  // Saves the coordinates of the present position. They stay the same when coordinates are set again.
  void save_coordinates(const std::string& name) const;
  // Moves all axes to a saved position, and waits for the outcome. `stop` cancels the move.
  MotionResult move_to(const std::string& name, std::stop_token stop = {}) const;
  void erase(const std::string& name) const;
  // Returns the saved positions, with the positions of the axes when they were saved.
  std::map<std::string, std::vector<Position>> list() const;

 private:
  std::shared_ptr<client::DeviceSession> session_;
};

}  // namespace axisgate

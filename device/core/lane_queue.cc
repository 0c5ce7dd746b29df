#include "device/core/lane_queue.h"

namespace axisgate {

tl::unexpected<Problem> lane_full(Lane lane, std::size_t waiting) {
  return fail(Reason::queue_full,
              std::to_string(waiting) + " requests already wait in the " + std::string(name(lane)) + " lane",
              "try again in 1 s, when fewer wait");
}

tl::unexpected<Problem> share_full(Lane lane, const std::string& caller, std::size_t waiting) {
  return fail(Reason::queue_full,
              caller + " has " + std::to_string(waiting) + " requests waiting in the " + std::string(name(lane)) +
                  " lane, as many as one caller may have",
              "wait for some of them, and try again in 1 s");
}

}  // namespace axisgate

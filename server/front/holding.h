// Bytes of requests that the front holds until they are whole, of all connections together.
#pragma once

#include <cstddef>
#include <utility>

namespace axisgate::front {

// Not thread safe.
class HeldBytes {
 public:
  explicit HeldBytes(std::size_t most) : most_(most) {}

  std::size_t held() const { return held_; }

 private:
  friend class Holding;

  const std::size_t most_;
  std::size_t held_ = 0;
};

// Returns how many bytes of a request are counted. The first kilobyte is not: a stop must always find room.
inline std::size_t counted(std::size_t bytes) {
  constexpr std::size_t kFree = 1024;
  return bytes > kFree ? bytes - kFree : 0;
}

// A Holding is the share of one call. It returns all of it when it is destroyed.
class Holding {
 public:
  // `all` outlives it.
  explicit Holding(HeldBytes& all) : all_(&all) {}
  Holding(Holding&& other) noexcept : all_(other.all_), bytes_(std::exchange(other.bytes_, 0)) {}
  Holding& operator=(Holding&&) = delete;
  ~Holding() { all_->held_ -= bytes_; }

  // False: there is no room for so many more.
  bool take(std::size_t bytes) {
    if (all_->held_ + bytes > all_->most_) return false;
    all_->held_ += bytes;
    bytes_ += bytes;
    return true;
  }
  void give_back() { give_back(bytes_); }
  // At most what is held.
  void give_back(std::size_t bytes) {
    const std::size_t given = bytes < bytes_ ? bytes : bytes_;
    all_->held_ -= given;
    bytes_ -= given;
  }

 private:
  HeldBytes* all_;
  std::size_t bytes_ = 0;
};

}  // namespace axisgate::front

// Bytes of incomplete requests that the front keeps, over all connections.
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

// A Holding is the share of one call. Its destructor gives all of it back.
class Holding {
 public:
  // `all` must outlive this object.
  explicit Holding(HeldBytes& all) : all_(&all) {}
  Holding(Holding&& other) noexcept : all_(other.all_), bytes_(std::exchange(other.bytes_, 0)) {}
  Holding& operator=(Holding&&) = delete;
  ~Holding() { all_->held_ -= bytes_; }

  // Returns false if there is no room for `bytes` more.
  bool take(std::size_t bytes) {
    if (all_->held_ + bytes > all_->most_) return false;
    all_->held_ += bytes;
    bytes_ += bytes;
    return true;
  }
  void give_back() { give_back(bytes_); }
  // Gives back at most the bytes of this Holding.
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

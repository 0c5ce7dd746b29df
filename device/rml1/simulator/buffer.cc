#include "device/rml1/simulator/buffer.h"

namespace axisgate::rml1::simulator {
namespace {

constexpr char kXon = 0x11, kXoff = 0x13;
constexpr std::size_t kEscapeKBytes = 3;

std::size_t bytes_of(const Buffer::Item& item) { return item.escape_k ? kEscapeKBytes : 1; }

}  // namespace

bool Buffer::put(Item item) {
  if (bytes_ + bytes_of(item) > capacity_) return false;
  bytes_ += bytes_of(item);
  items_.push_back(item);
  return true;
}

bool Buffer::put(char byte) { return put(Item{byte, false}); }
bool Buffer::put_escape_k() { return put(Item{0, true}); }

std::optional<Buffer::Item> Buffer::take() {
  if (items_.empty()) return std::nullopt;
  const Item item = items_.front();
  items_.pop_front();
  bytes_ -= bytes_of(item);
  return item;
}

void Buffer::clear() {
  items_.clear();
  bytes_ = 0;
}

std::optional<char> Handshake::update(const Buffer& buffer) {
  if (flow_ == Flow::none) return std::nullopt;
  const bool stop = buffer.size() * 4 >= buffer.capacity() * 3;
  const bool release = buffer.size() * 2 <= buffer.capacity();
  if (stopped_ ? !release : !stop) return std::nullopt;
  stopped_ = !stopped_;
  if (flow_ != Flow::xon) return std::nullopt;
  return stopped_ ? kXoff : kXon;
}

}  // namespace axisgate::rml1::simulator

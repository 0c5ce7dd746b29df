// Buffer of bytes that the mill has received and not read, and the handshake that stops its host.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "device/rml1/simulator/options.h"

namespace axisgate::rml1::simulator {

class Buffer {
 public:
  struct Item {
    char byte = 0;
    bool escape_k = false;  // an ESC.K that travels among the data (option escape_k=in-band)
  };

  explicit Buffer(std::size_t capacity) : capacity_(capacity) {}

  // Returns false if there is no room: the byte is lost (guideline 4-1, error 16).
  bool put(char byte);
  bool put_escape_k();
  std::optional<Item> take();
  void clear();

  std::size_t size() const { return bytes_; }  // bytes
  std::size_t capacity() const { return capacity_; }
  bool full() const { return bytes_ >= capacity_; }

 private:
  bool put(Item item);

  std::size_t capacity_;
  std::size_t bytes_ = 0;
  std::deque<Item> items_;
};

// Stops the host when a quarter of the buffer is free, and releases it when half is free. The margin is for bytes that
// a host still sends after it was stopped.
class Handshake {
 public:
  explicit Handshake(Flow flow) : flow_(flow) {}

  // Returns the byte to send, XOFF or XON; nullopt if there is none.
  std::optional<char> update(const Buffer& buffer);
  bool stopped() const { return stopped_; }

 private:
  Flow flow_;
  bool stopped_ = false;
};

}  // namespace axisgate::rml1::simulator

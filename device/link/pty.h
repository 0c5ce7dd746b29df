// Pseudo terminal under a chosen name, which programs open like a serial port with a device.
#pragma once

#include <string>

#include "device/core/problem.h"
#include "device/link/descriptor.h"

namespace axisgate {

// Master's end of a pseudo terminal, raw and without echo before anybody opens the other end. The destructor removes
// the symbolic link if it still leads to this terminal. Not thread safe.
class Pty {
 public:
  ~Pty();
  Pty(Pty&&) = default;
  Pty& operator=(Pty&& other) noexcept;

  int master() const { return master_.get(); }           // non-blocking; reading returns EIO while no client is there
  const std::string& device() const { return device_; }  // "/dev/pts/7"
  const std::string& link() const { return link_; }

  // Reports whether any process has the other end open.
  bool has_client() const;

  // Reports whether a client set TIOCEXCL. Only root can open the other end after that, even when the client is gone.
  bool is_reserved() const;

  // Discards bytes that were written to the master and not yet read at the other end. Bytes from the clients stay.
  void discard_unread();

  // Restores raw mode, whatever mode a client has set, and discards unread bytes, too.
  void make_raw();

 private:
  friend Result<Pty> open_pty(const std::string& link_path);
  Pty(Descriptor master, std::string device, std::string link);

  Descriptor master_;
  std::string device_;
  std::string link_;
};

// Opens a new pseudo terminal, and makes `link_path` a symbolic link to it. An existing symbolic link is replaced
// atomically. Fails with link_down if the path is something else, which stays unchanged.
Result<Pty> open_pty(const std::string& link_path);

}  // namespace axisgate

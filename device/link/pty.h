// A pseudo terminal under a name of its own: what a program opens as if a device hung on a serial port.
#pragma once

#include <string>

#include "device/core/problem.h"
#include "device/link/descriptor.h"

namespace axisgate {

// The master's end, raw and without echo before anyone opens the other end. Removes the symbolic link at its end if
// that still leads here. Not thread safe.
class Pty {
 public:
  ~Pty();
  Pty(Pty&&) = default;
  Pty& operator=(Pty&& other) noexcept;

  int master() const { return master_.get(); }           // non-blocking; reading answers EIO while nobody is there
  const std::string& device() const { return device_; }  // "/dev/pts/7"
  const std::string& link() const { return link_; }

  // Does any process have the other end open now?
  bool has_client() const;

  // Has a client reserved the other end (TIOCEXCL)? Even when it has gone, nobody but root can open it any more.
  bool is_reserved() const;

  // Drops what was written to the master and not yet read at the other end; what the clients wrote stays.
  void discard_unread();

  // Back to raw mode, whatever a client chose; drops what is unread, too.
  void make_raw();

 private:
  friend Result<Pty> open_pty(const std::string& link_path);
  Pty(Descriptor master, std::string device, std::string link);

  Descriptor master_;
  std::string device_;
  std::string link_;
};

// A new pseudo terminal, and `link_path` as a symbolic link to it. A symbolic link that exists is replaced in one
// step; anything else there is left alone and is a problem.
Result<Pty> open_pty(const std::string& link_path);

}  // namespace axisgate

// Removes from a text for outsiders what identifies people and single machines.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "server/config/config.h"

namespace axisgate::server {

// Each secret has one stand-in, the same throughout, so that a reader still sees what belongs together. Device names,
// axis names and tty names such as /dev/ttyUSB0 stay.
class Redactor {
 public:
  enum class Kind { serial_number, user, host, path };

  // The stand-in of `secret`, which from now on redact() puts in its place. What is none stays as it is: the empty
  // text, and a path to a tty without a serial number in it.
  std::string hide(Kind kind, const std::string& secret);

  // With every secret that is known replaced. In whole lines of a recording (device/stage/recording/recording.h)
  // callers and the serial number in an answer to *IDN? need not be known before, and a number is also found where it
  // came in pieces.
  std::string redact(std::string_view text);

  // With everything hidden that is a secret in it.
  Config redact(Config config);

  // "2 serial numbers, 1 user": how many of each kind were hidden.
  std::string summary() const;

 private:
  struct Secret {
    std::string text, stand_in;
    bool number = false;  // is not replaced as a part of a longer number
  };

  std::string stand_in(Kind kind, const std::string& secret);
  void learn_serial_numbers(std::string_view text, std::string_view before);
  void hide_callers(std::string& lines);

  std::vector<Secret> secrets_;  // the longest first, since one may be part of another; users are not among them
  std::map<std::string, std::string> users_;
  std::array<int, 4> counts_{};  // by Kind
};

}  // namespace axisgate::server

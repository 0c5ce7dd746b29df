// Removal of names and of single machines' identifiers from a text for outsiders.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "server/config/config.h"

namespace axisgate::server {

// Each secret has one stand-in throughout, so that a reader can still recognise related places. Device names, axis
// names and tty names such as /dev/ttyUSB0 stay.
class Redactor {
 public:
  enum class Kind { serial_number, user, host, path };

  // Returns the stand-in of `secret`, with which redact() will replace it. Returns the text itself if it is no secret:
  // an empty text, or a path to a tty without a serial number.
  std::string hide(Kind kind, const std::string& secret);

  // Replaces every known secret. In whole lines of a recording (device/stage/recording/recording.h), callers and the
  // serial number in an answer to *IDN? are found even if they are not known, and a number is found even if it came in
  // pieces.
  std::string redact(std::string_view text);

  // Hides every secret in the configuration.
  Config redact(Config config);

  // Returns the number of hidden secrets of each kind: "2 serial numbers, 1 user".
  std::string summary() const;

 private:
  struct Secret {
    std::string text, stand_in;
    bool number = false;  // is not replaced as a part of a longer number
  };

  std::string stand_in(Kind kind, const std::string& secret);
  void learn_serial_numbers(std::string_view text, std::string_view before);
  void hide_callers(std::string& lines);

  std::vector<Secret> secrets_;  // the longest first, since one secret may be part of another; without users
  std::map<std::string, std::string> users_;
  std::array<int, 4> counts_{};  // by Kind
};

}  // namespace axisgate::server

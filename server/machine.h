// Description of the machine for support; clients include this file, too.
#pragma once

#include <sys/utsname.h>

#include <fstream>
#include <string>

namespace axisgate::server {

// Returns system and kernel, without the machine's name: "Debian GNU/Linux 12 (bookworm), Linux 6.1.0-18-amd64 x86_64".
inline std::string machine_text() {
  constexpr std::string_view kKey = "PRETTY_NAME=";
  std::string text;
  std::ifstream release("/etc/os-release");
  for (std::string line; std::getline(release, line);) {
    if (!line.starts_with(kKey)) continue;
    for (const char byte : line.substr(kKey.size())) {
      if (byte != '"') text += byte;
    }
    text += ", ";
  }
  utsname system{};
  if (::uname(&system) != 0) return text + "Linux";
  return text + system.sysname + " " + system.release + " " + system.machine;
}

}  // namespace axisgate::server

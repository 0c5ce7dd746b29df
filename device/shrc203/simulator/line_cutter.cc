#include "device/shrc203/simulator/line_cutter.h"

#include <utility>

namespace axisgate::shrc203::simulator {

std::optional<LineCutter::Line> LineCutter::push(char byte) {
  if (byte != '\r' && byte != '\n') {
    line_.bad_byte = line_.bad_byte || byte == '\0' || static_cast<unsigned char>(byte) >= 0x80;
    if (line_.text.size() < kBytesMax) {
      line_.text += byte;
    } else {
      line_.overlong = true;
    }
    return std::nullopt;
  }
  Line line = std::exchange(line_, {});
  const auto first = line.text.find_first_not_of(" \t");
  if (first == std::string::npos) return std::nullopt;
  line.text = line.text.substr(first, line.text.find_last_not_of(" \t") + 1 - first);
  return line;
}

}  // namespace axisgate::shrc203::simulator

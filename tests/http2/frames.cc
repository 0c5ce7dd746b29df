#include "tests/http2/frames.h"

namespace axisgate::front {
namespace {

constexpr std::uint32_t kStreamMask = 0x7fff'ffff;
constexpr std::size_t kSettingBytes = 6, kPriorityBytes = 5;

void append_number(std::string& bytes, std::uint32_t number, int count) {
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(number >> shift & 0xff));
}

std::uint8_t byte_at(std::string_view bytes, std::size_t place) { return static_cast<std::uint8_t>(bytes[place]); }

std::size_t length_in(std::string_view header) {
  return std::size_t{byte_at(header, 0)} << 16 | std::size_t{byte_at(header, 1)} << 8 | byte_at(header, 2);
}

Frame frame_in(std::string_view raw) {
  return {static_cast<FrameType>(byte_at(raw, 3)), byte_at(raw, 4), number_at(raw, 5) & kStreamMask,
          raw.substr(kFrameHeaderBytes), raw};
}

}  // namespace

std::uint32_t number_at(std::string_view bytes, std::size_t place) {
  return std::uint32_t{byte_at(bytes, place)} << 24 | std::uint32_t{byte_at(bytes, place + 1)} << 16 |
         std::uint32_t{byte_at(bytes, place + 2)} << 8 | byte_at(bytes, place + 3);
}

bool FrameReader::feed(std::string_view bytes, const std::function<bool(const Frame&)>& on_frame) {
  // Copies bytes only if a frame arrived in several pieces.
  std::string joined;
  if (!rest_.empty()) {
    joined = std::move(rest_);
    joined.append(bytes);
    bytes = joined;
  }
  rest_.clear();
  while (bytes.size() >= kFrameHeaderBytes) {
    const std::size_t length = length_in(bytes);
    too_long_ = length > kFramePayloadMax;
    if (too_long_) return false;
    if (bytes.size() < kFrameHeaderBytes + length) break;
    const std::string_view raw = bytes.substr(0, kFrameHeaderBytes + length);
    if (!on_frame(frame_in(raw))) return false;
    bytes.remove_prefix(raw.size());
  }
  rest_ = bytes;
  return true;
}

std::string frame(FrameType type, std::uint8_t flags, std::uint32_t stream, std::string_view payload) {
  std::string bytes;
  bytes.reserve(kFrameHeaderBytes + payload.size());
  append_number(bytes, static_cast<std::uint32_t>(payload.size()), 3);
  append_number(bytes, static_cast<std::uint32_t>(type), 1);
  append_number(bytes, flags, 1);
  append_number(bytes, stream, 4);
  bytes.append(payload);
  return bytes;
}

std::string settings_frame(const std::map<std::uint16_t, std::uint32_t>& settings) {
  std::string payload;
  for (const auto& [id, value] : settings) {
    append_number(payload, id, 2);
    append_number(payload, value, 4);
  }
  return frame(FrameType::settings, 0, 0, payload);
}

std::string settings_ack() { return frame(FrameType::settings, static_cast<std::uint8_t>(FrameFlag::ack), 0, ""); }

std::string ping_ack(std::string_view payload) {
  return frame(FrameType::ping, static_cast<std::uint8_t>(FrameFlag::ack), 0, payload);
}

std::string rst_stream(std::uint32_t stream, ErrorCode code) {
  std::string payload;
  append_number(payload, static_cast<std::uint32_t>(code), 4);
  return frame(FrameType::rst_stream, 0, stream, payload);
}

std::string window_update(std::uint32_t stream, std::uint32_t bytes) {
  std::string payload;
  append_number(payload, bytes, 4);
  return frame(FrameType::window_update, 0, stream, payload);
}

std::string goaway(std::uint32_t last_stream, ErrorCode code, std::string_view why) {
  std::string payload;
  append_number(payload, last_stream, 4);
  append_number(payload, static_cast<std::uint32_t>(code), 4);
  payload.append(why);
  return frame(FrameType::goaway, 0, 0, payload);
}

std::optional<std::map<std::uint16_t, std::uint32_t>> settings_in(std::string_view payload) {
  if (payload.size() % kSettingBytes != 0) return std::nullopt;
  std::map<std::uint16_t, std::uint32_t> settings;
  for (; !payload.empty(); payload.remove_prefix(kSettingBytes)) {
    const auto id = static_cast<std::uint16_t>(byte_at(payload, 0) << 8 | byte_at(payload, 1));
    settings[id] = number_at(payload, 2);
  }
  return settings;
}

std::optional<std::string_view> content_of(const Frame& frame) {
  std::string_view content = frame.payload;
  std::size_t padding = 0;
  if (frame.has(FrameFlag::padded)) {
    if (content.empty()) return std::nullopt;
    padding = byte_at(content, 0);
    content.remove_prefix(1);
  }
  const bool priority = frame.type == FrameType::headers && frame.has(FrameFlag::priority);
  const std::size_t extra = priority ? kPriorityBytes : 0;
  if (content.size() < extra + padding) return std::nullopt;
  return content.substr(extra, content.size() - extra - padding);
}

}  // namespace axisgate::front

// HTTP/2's frames (RFC 9113, 4 and 6), for tests that write and read them by hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::front {

inline constexpr std::string_view kPreface = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";
inline constexpr std::size_t kFrameHeaderBytes = 9;
// Limits that apply without a setting (6.5.2). The front lets neither side raise the payload limit, so that it can
// store one frame.
inline constexpr std::size_t kFramePayloadMax = 16'384;
inline constexpr std::int64_t kFirstWindow = 65'535;
inline constexpr std::int64_t kWindowMax = 0x7fff'ffff;

enum class FrameType : std::uint8_t {
  data = 0,
  headers = 1,
  priority = 2,
  rst_stream = 3,
  settings = 4,
  push_promise = 5,
  ping = 6,
  goaway = 7,
  window_update = 8,
  continuation = 9,
};

enum class FrameFlag : std::uint8_t { end_stream = 0x1, ack = 0x1, end_headers = 0x4, padded = 0x8, priority = 0x20 };

enum class SettingId : std::uint16_t {
  header_table_size = 1,
  enable_push = 2,
  max_concurrent_streams = 3,
  initial_window_size = 4,
  max_frame_size = 5,
  max_header_list_size = 6,
};

// Error codes (RFC 9113, 7).
enum class ErrorCode : std::uint32_t {
  no_error = 0,
  protocol_error = 1,
  flow_control_error = 3,
  frame_size_error = 6,
  compression_error = 9,
  enhance_your_calm = 11,
};

// One whole frame. Its texts belong to the reader and are valid until the next frame.
struct Frame {
  FrameType type{};  // may be a type that is not named above
  std::uint8_t flags = 0;
  std::uint32_t stream = 0;
  std::string_view payload;
  std::string_view raw;  // including its header

  bool has(FrameFlag flag) const { return (flags & static_cast<std::uint8_t>(flag)) != 0; }
};

// A FrameReader cuts a stream of bytes into frames. Not thread safe.
class FrameReader {
 public:
  // Calls `on_frame` with each complete frame until `on_frame` returns false. Returns false if it did, or if a frame is
  // too long.
  bool feed(std::string_view bytes, const std::function<bool(const Frame&)>& on_frame);

  bool too_long() const { return too_long_; }
  bool in_frame() const { return !rest_.empty(); }  // part of a frame has been received

 private:
  std::string rest_;
  bool too_long_ = false;
};

std::string frame(FrameType type, std::uint8_t flags, std::uint32_t stream, std::string_view payload);
std::string settings_frame(const std::map<std::uint16_t, std::uint32_t>& settings);
std::string settings_ack();
std::string ping_ack(std::string_view payload);
std::string rst_stream(std::uint32_t stream, ErrorCode code);
std::string window_update(std::uint32_t stream, std::uint32_t bytes);
std::string goaway(std::uint32_t last_stream, ErrorCode code, std::string_view why);

std::uint32_t number_at(std::string_view bytes, std::size_t place);  // 32 bits, highest byte first

// Parses a SETTINGS payload. nullopt if its length is invalid.
std::optional<std::map<std::uint16_t, std::uint32_t>> settings_in(std::string_view payload);

// Returns the fragment of a HEADERS frame, or the data of a DATA frame, without padding and priority. nullopt if
// padding or priority does not fit the payload.
std::optional<std::string_view> content_of(const Frame& frame);

}  // namespace axisgate::front

// Files of other kinds, by how they begin: a mill would take them for a job with thousands of errors.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace axisgate::rml1 {

// So many bytes are enough to know each of them.
inline constexpr std::size_t kHead = 512;

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of UTF-8

// What the file is, "a PDF document"; nothing where it may be a job, or G-code (job_kind.h). `head` is its first kHead
// bytes, or all of it; the result lives as long as the program.
std::optional<std::string_view> known_file(std::string_view head);

}  // namespace axisgate::rml1

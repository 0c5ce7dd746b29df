// Recognises files of other kinds by their beginning: a mill would take them for a job with thousands of errors.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace axisgate::rml1 {

// Number of bytes that are enough to recognise each kind.
inline constexpr std::size_t kHead = 512;

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // byte order mark of UTF-8

// Returns the kind of file, such as "a PDF document"; nullopt if it may be a job, or G-code (job_kind.h). `head`: the
// first kHead bytes, or the whole file. The result lives as long as the program.
std::optional<std::string_view> known_file(std::string_view head);

}  // namespace axisgate::rml1

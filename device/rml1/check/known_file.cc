#include "device/rml1/check/known_file.h"

#include <algorithm>
#include <array>
#include <string>

#include "device/rml1/language/characters.h"

namespace axisgate::rml1 {
namespace {

using namespace std::string_view_literals;

struct Beginning {
  std::string_view bytes, name;
};

constexpr Beginning kBinary[] = {
    {"%PDF-"sv, "a PDF document"},     {"\x89PNG"sv, "a PNG picture"},     {"\xFF\xD8\xFF"sv, "a JPEG picture"},
    {"GIF8"sv, "a GIF picture"},       {"II*\0"sv, "a TIFF picture"},      {"MM\0*"sv, "a TIFF picture"},
    {"PK\x03\x04"sv, "a ZIP archive"}, {"\xFF\xFE"sv, "a text in UTF-16"}, {"\xFE\xFF"sv, "a text in UTF-16"},
};

// Compared with the text after blanks, in capitals.
constexpr Beginning kText[] = {
    {"<!DOCTYPE HTML", "an HTML page"}, {"<HTML", "an HTML page"},    {"<SVG", "an SVG picture"},
    {"<?XML", "an XML file"},           {"<", "an HTML or XML file"},
};

bool any_begins(std::string_view text, std::string_view& name, auto&& list) {
  const auto found = std::ranges::find_if(list, [text](const Beginning& one) { return text.starts_with(one.bytes); });
  if (found == std::end(list)) return false;
  name = found->name;
  return true;
}

std::string_view after_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos ? std::string_view() : text.substr(begin);
}

std::string in_capitals(std::string_view text) {
  std::string capitals(text);
  for (char& c : capitals) c = is_letter(c) ? capital(c) : c;
  return capitals;
}

// Recognises UTF-16 without a mark: every second byte is 0, because the text is ASCII.
bool is_utf_16(std::string_view head) {
  constexpr std::size_t kPairs = 8;
  if (head.size() < 2 * kPairs) return false;
  const auto alternates = [&](std::size_t zeros) {
    for (std::size_t index = 0; index < 2 * kPairs; ++index) {
      if ((head[index] == 0) != (index % 2 == zeros)) return false;
    }
    return true;
  };
  return alternates(0) || alternates(1);
}

// Recognises an extended command such as "%FSLAX24Y24*%", "%TF..." or "%MOMM*%", or a comment that ends with "*"
// (Gerber Layer Format Specification 2022.02, 3.5).
bool is_gerber(std::string_view text) {
  if (text.size() > 2 && text[0] == '%' && is_letter(text[1]) && is_letter(text[2])) {
    return text.substr(0, text.find_first_of("\r\n")).find('*') != std::string_view::npos;
  }
  return text.starts_with("G04") && text.substr(0, text.find_first_of("\r\n")).ends_with('*');
}

// Recognises "solid NAME" followed by facets.
bool is_text_stl(std::string_view capitals) {
  return capitals.starts_with("SOLID") && capitals.find("FACET") != std::string::npos;
}

// Recognises binary files, such as an STL, which has a header of 80 bytes and then numbers.
bool is_binary(std::string_view head) {
  return head.find('\0') != std::string_view::npos && std::ranges::any_of(head, has_eighth_bit);
}

}  // namespace

std::optional<std::string_view> known_file(std::string_view head) {
  std::string_view name;
  if (any_begins(head, name, kBinary)) return name;
  if (is_utf_16(head)) return "a text in UTF-16";
  if (head.starts_with("BM") && is_binary(head)) return "a BMP picture";
  if (head.starts_with(kByteOrderMark)) head.remove_prefix(kByteOrderMark.size());
  const std::string_view text = after_blanks(head);
  const std::string capitals = in_capitals(text);
  if (is_gerber(text)) return "a Gerber file";
  if (is_text_stl(capitals)) return "a model in STL";
  if (any_begins(capitals, name, kText)) return name;
  if (is_binary(head)) return "a binary file, e.g. a model in STL";
  return std::nullopt;
}

}  // namespace axisgate::rml1

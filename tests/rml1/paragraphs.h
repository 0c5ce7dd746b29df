// Text fixtures: paragraphs of lines, each a mark, a blank and the content. A line that begins with # is a comment.
#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace axisgate::rml1 {

struct Paragraph {
  std::string where;  // "mode_1.txt:12"
  std::vector<std::pair<std::string, std::string>> lines;

  std::vector<std::string> all(const std::string& mark) const;
};

inline void PrintTo(const Paragraph& paragraph, std::ostream* out) { *out << paragraph.where; }

// Reads the paragraphs of a file, or of each file of a folder, below tests/rml1.
std::vector<Paragraph> paragraphs(const std::string& path);

// Replaces the escapes \r \n \t \e \s \\ \xNN by their characters.
std::string unescaped(const std::string& text);

}  // namespace axisgate::rml1

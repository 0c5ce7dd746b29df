#include "tests/rml1/paragraphs.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/paths/paths.h"

namespace axisgate::rml1 {
namespace {

// Returns the folder. A function, not a constant, because fixtures are read before main().
std::filesystem::path folder() { return paths::in_project("tests/rml1"); }

void read(const std::filesystem::path& path, std::vector<Paragraph>& found) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot be opened: " + path.string());
  Paragraph paragraph;
  const auto end = [&] {
    if (!paragraph.lines.empty()) found.push_back(std::move(paragraph));
    paragraph = {};
  };
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty()) end();
    if (line.empty() || line[0] == '#') continue;
    if (paragraph.lines.empty()) paragraph.where = path.filename().string() + ":" + std::to_string(number);
    const auto blank = line.find(' ');
    const bool mark_alone = blank == std::string::npos;
    paragraph.lines.emplace_back(line.substr(0, blank), mark_alone ? "" : line.substr(blank + 1));
  }
  end();
}

}  // namespace

std::vector<std::string> Paragraph::all(const std::string& mark) const {
  std::vector<std::string> found;
  for (const auto& [key, text] : lines) {
    if (key == mark) found.push_back(text);
  }
  return found;
}

std::vector<Paragraph> paragraphs(const std::string& path) {
  std::vector<Paragraph> found;
  const auto whole = folder() / path;
  if (!std::filesystem::is_directory(whole)) {
    read(whole, found);
    return found;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(whole)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) read(file, found);
  return found;
}

std::string unescaped(const std::string& text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '\\') {
      plain += text[at];
      continue;
    }
    const char kind = text.at(++at);
    const std::string_view kinds = "rntes\\", meant = "\r\n\t\x1B \\";
    if (kind == 'x') {
      plain += static_cast<char>(std::stoi(text.substr(at + 1, 2), nullptr, 16));
      at += 2;
    } else if (kinds.find(kind) != std::string_view::npos) {
      plain += meant[kinds.find(kind)];
    } else {
      throw std::runtime_error("unknown escape in " + text);
    }
  }
  return plain;
}

}  // namespace axisgate::rml1

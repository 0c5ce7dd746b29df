#include "tests/conformance/transcript.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/paths/paths.h"

namespace axisgate::shrc203::conformance {
namespace {

// Error in a line of a transcript; caught by code that knows its place.
struct Mistake {
  std::string what;
};

std::string take_until(std::string_view& text, std::string_view end) {
  const auto at = text.find(end);
  std::string taken(text.substr(0, at));
  text = at == std::string_view::npos ? std::string_view() : text.substr(at + end.size());
  return taken;
}

std::pair<std::string, std::string> halves(std::string_view text, std::string_view between) {
  const auto at = text.find(between);
  if (at == 0 || at == std::string_view::npos || at + between.size() == text.size()) {
    throw Mistake{fmt::format("'{}' wants the form A{}B", text, between)};
  }
  return {std::string(text.substr(0, at)), std::string(text.substr(at + between.size()))};
}

class EntryReader {
 public:
  explicit EntryReader(const Block& block) : block_(block) {}

  int line_number() const { return block_[std::min(next_, block_.size() - 1)].number; }

  Entry read() {
    check_characters();
    read_header();
    read_conditions();
    entry_.sent = required("> ");
    read_meaning();
    entry_.reply = required("< ");
    read_fields();
    while (const auto completion = optional("after: ")) entry_.completions.push_back(*completion);
    if (next_ != block_.size()) throw Mistake{fmt::format("'{}' is unknown or out of order", block_[next_].text)};
    return std::move(entry_);
  }

 private:
  std::optional<std::string> optional(std::string_view key) {
    if (next_ == block_.size() || !block_[next_].text.starts_with(key)) return {};
    std::string value = block_[next_].text.substr(key.size());
    if (value.empty()) throw Mistake{fmt::format("nothing follows '{}'", key)};
    ++next_;
    return value;
  }

  std::string required(std::string_view key) {
    const auto value = optional(key);
    if (!value) throw Mistake{fmt::format("a line '{}...' is due here", key)};
    return *value;
  }

  void check_characters() {
    for (const Line& line : block_) {
      const bool printable = std::ranges::all_of(line.text, [](char c) { return c >= ' ' && c <= '~'; });
      if (!printable || line.text.ends_with(' ')) {
        throw Mistake{fmt::format("line {} is not printable ASCII, or ends in a blank", line.number)};
      }
    }
  }

  void read_header() {
    const std::string header = required("[");
    const char* const end = header.data() + header.size();
    const auto [digits_end, error] = std::from_chars(header.data(), end, entry_.section);
    if (error == std::errc() && header.ends_with(']')) {
      entry_.row = std::string(digits_end, end);
      if (entry_.row.size() > 2 && entry_.row.starts_with(' ')) {
        entry_.row = entry_.row.substr(1, entry_.row.size() - 2);
        return;
      }
    }
    --next_;
    throw Mistake{fmt::format("'[{}' wants the form [SECTION ROW]", header)};
  }

  void read_conditions() {
    entry_.source = required("source: ");
    entry_.offline = optional("offline: ");
    while (const auto setting = optional("device: ")) entry_.device.push_back(halves(*setting, "="));
    while (const auto exchange = optional("setup: ")) {
      const auto [line, reply] = halves(*exchange, " -> ");
      entry_.setup.push_back({line, reply});
    }
    if (const auto wait = optional("wait: ")) {
      if (*wait != "ready") throw Mistake{fmt::format("'wait: {}' is unknown; there is wait: ready", *wait)};
      entry_.wait_until_ready = true;
    }
  }

  void read_meaning() {
    if (next_ < block_.size() && block_[next_].text == "=") {
      ++next_;
      return;
    }
    const std::string words = required("= ");
    for (std::string_view rest = words; !rest.empty();) {
      entry_.meaning.push_back(halves(take_until(rest, " "), "="));
    }
  }

  // Only the fields check a reply that the simulator cannot give: otherwise R would pass as well as B.
  void read_fields() {
    const bool single_letter = entry_.reply == "R" || entry_.reply == "B";
    if (is_answer_word(entry_.reply) || (single_letter && !entry_.offline)) return;
    const std::string fields = required("fields: ");
    for (std::string_view rest = fields; !rest.empty();) entry_.fields.push_back(take_until(rest, " | "));
  }

  const Block& block_;
  std::size_t next_ = 0;
  Entry entry_;
};

void read_file(const std::filesystem::path& path, Transcripts& transcripts) {
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const std::string file = path.filename().string();
  const auto blocks = split_blocks(text);
  if (blocks.empty()) transcripts.mistakes.push_back(file + ": holds no entry, or cannot be read");
  for (const Block& block : blocks) {
    auto entry = parse_entry(file, block);
    if (entry) {
      transcripts.examples.push_back({file, block, *std::move(entry)});
    } else {
      transcripts.mistakes.push_back(entry.error());
    }
  }
}

Transcripts read_all() {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  const auto folder = paths::in_project("tests/conformance/transcripts");
  for (const auto& file : std::filesystem::directory_iterator(folder, error)) paths.push_back(file.path());
  std::ranges::sort(paths);
  Transcripts transcripts;
  if (error) transcripts.mistakes.push_back(fmt::format("{}: {}", folder.string(), error.message()));
  for (const auto& path : paths) {
    if (path.extension() == ".transcript") {
      read_file(path, transcripts);
    } else {
      transcripts.mistakes.push_back(path.filename().string() + ": not a *.transcript, so nothing would read it");
    }
  }
  return transcripts;
}

}  // namespace

bool is_answer_word(std::string_view reply) {
  constexpr std::array<std::string_view, 4> kWords{"OK", "OK_D", "NG", "NG_I"};
  return std::ranges::find(kWords, reply) != kWords.end();
}

std::vector<Block> split_blocks(std::string_view text) {
  std::vector<Block> blocks;
  Block block;
  int number = 0;
  while (!text.empty()) {
    const std::string line = take_until(text, "\n");
    ++number;
    if (!line.empty() && line.front() != '#') block.push_back({number, line});
    if ((line.empty() || text.empty()) && !block.empty()) blocks.push_back(std::exchange(block, {}));
  }
  return blocks;
}

tl::expected<Entry, std::string> parse_entry(std::string_view file, const Block& block) {
  EntryReader reader(block);
  try {
    Entry entry = reader.read();
    entry.place = fmt::format("{}:{}", file, block.front().number);
    return entry;
  } catch (const Mistake& mistake) {
    return tl::unexpected(fmt::format("{}:{}: {}", file, reader.line_number(), mistake.what));
  }
}

const Transcripts& all_transcripts() {
  static const Transcripts transcripts = read_all();
  return transcripts;
}

}  // namespace axisgate::shrc203::conformance

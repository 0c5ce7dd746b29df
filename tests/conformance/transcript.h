// Strict parser for the format of transcripts (README.md in this folder).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace axisgate::shrc203::conformance {

struct Line {
  int number;  // line number in the file, from 1
  std::string text;
};

// Lines of one entry, without comments.
using Block = std::vector<Line>;

struct Exchange {
  std::string line, reply;
};

struct Entry {
  std::string place;  // place of its first line: "moves.transcript:12"
  int section = 0;
  std::string row;
  std::string source;
  std::optional<std::string> offline;
  std::vector<std::pair<std::string, std::string>> device;
  std::vector<Exchange> setup;
  bool wait_until_ready = false;
  std::string sent;
  std::vector<std::pair<std::string, std::string>> meaning;
  std::string reply;
  std::vector<std::string> fields;
  std::vector<std::string> completions;
};

// Reports whether the reply is OK, OK_D, NG or NG_I. Each pair of these differs in more than one byte.
bool is_answer_word(std::string_view reply);

std::vector<Block> split_blocks(std::string_view text);

// Returns the entry, or an error text that begins with file and line.
tl::expected<Entry, std::string> parse_entry(std::string_view file, const Block& block);

struct Transcripts {
  struct Example {
    std::string file;
    Block block;
    Entry entry;
  };
  std::vector<Example> examples;
  std::vector<std::string> mistakes;  // error texts of files and entries that cannot be read
};

// Returns every *.transcript of the project, sorted by file name. The files are read only once.
const Transcripts& all_transcripts();

}  // namespace axisgate::shrc203::conformance
